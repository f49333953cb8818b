#pragma once
/// \file
/// (E135) The sides of a wall: parts of what bodies leave open around a multiplier between which no open face leads.

#include "components/liquid.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/bodies/geometry/outlines.hpp"

namespace minamo {

/// Whether a wall of the bodies is so thin that both of its sides lie within reach of a multiplier.
template <int Dim>
bool parts_liquid(const BodySet<Dim>& set, const BodyOutlines<Dim>& outlines, const Grid<Dim>& grid);

/// What bodies leave open of sites, (E85): of rows what was found for the step, of others what is found now.
template <int Dim>
struct OpenSites {
  const Splines<Dim>& splines;
  const StaggeredIndex<Dim>& rows;
  std::span<const double> open;         ///< of multipliers, by row
  std::span<const Vec<Dim>> open_face;  ///< by row
  const SiteCuts<Dim>& cuts;

  /// Of a multiplier.
  double share(const Index<Dim>& site, typename SiteRows<Dim>::Finder& find) const {
    const auto row = find(site);
    return row ? open[*row] : cuts.at(site).share;
  }
};

/// The sides around a multiplier; slivers lead to none. What has no open face within reach is closed: a splinter of a
/// cell, or a site from
/// which all ways lead farther.
template <int Dim>
SidesAround<Dim> find_sides(const OpenSites<Dim>& open, const Index<Dim>& site);

/// The sides around a face of direction d: of the faces up to two steps away along every axis.
template <int Dim>
class SidesAroundFace {
 public:
  SidesAroundFace(const OpenSites<Dim>& open, const Index<Dim>& site, std::size_t d);

  bool is_parted() const { return count_ > 1; }
  /// 1 + number of the side of an open face of the same direction. \param steps  to it, two at most along every axis
  std::uint8_t at(const Index<Dim>& steps) const;

 private:
  static constexpr int across = SidesAround<Dim>::across + 1;
  std::size_t d_;
  std::array<std::uint8_t, power(across, Dim)> label_{};
  std::uint8_t count_ = 0;
};

}  // namespace minamo
