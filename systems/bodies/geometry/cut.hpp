#pragma once
/// \file
/// (E85) What bodies leave open of the staggered grid: of every face a share of the plane between its two multipliers,
/// of every multiplier a share of its volume.

#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/placed_bodies.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/grid/sites_around.hpp"

#include <atomic>
#include <memory>

namespace minamo {

/// Faces less open than this are slivers: what flows through them weighs little and may be fast. Particles do not see
/// them (E87), and gaps near moving bodies made of nothing else are closed. Rounding says nothing of one that is 0.2
/// open.
inline constexpr double sliver = 0.2 - 1e-9;

/// (E85)  What moving bodies push through faces, with velocities of one's choice.
template <int Dim>
struct MovingWalls {
  const SitePlaces<Dim>& places;
  std::span<const Index<Dim>> site;
  std::span<const typename face::Closed<Dim>::value_type> closed;
  std::span<const typename face::Closer<Dim>::value_type> closer;
  std::span<const Vec<Dim>> position;
  std::span<const Vec<Dim>> velocity;
  std::span<const Vec<rotations<Dim>>> spin;

  /// c_fb w_b . e_f of the face of direction d of a row. [m/s]
  double flux(std::size_t f, std::size_t d) const {
    if (closer[f][d][1] < 0) return 0;
    const auto b = static_cast<std::size_t>(closer[f][d][1]);
    const Vec<Dim> r = places.face(site[f], d) - position[b];
    return closed[f][d][1] * rigid_velocity(velocity[b], spin[b], r)[static_cast<Eigen::Index>(d)];
  }
};

/// Cuts by moving bodies that were found before: several sites around ask for each. From any thread.
template <int Dim>
class FoundCuts {
 public:
  explicit FoundCuts(std::size_t sites) : state_(sites), cut_(std::make_unique_for_overwrite<Cut[]>(sites)) {}

  /// \param find  find(): what is asked for, if nobody has before
  template <class Find>
  SiteCut<Dim> operator()(std::size_t site, const Find& find) {
    std::atomic<State>& state = state_[site];
    if (state.load(std::memory_order_acquire) == State::known) return {cut_[site].open, cut_[site].share};
    const SiteCut<Dim> cut = find();
    State expected = State::unknown;
    if (state.compare_exchange_strong(expected, State::written, std::memory_order_relaxed)) {
      cut_[site] = {cut.open, cut.share};
      state.store(State::known, std::memory_order_release);
    }
    return cut;
  }

 private:
  enum class State : std::uint8_t { unknown, written, known };
  /// As SiteCut, but memory that nobody has written to costs nothing.
  struct Cut {
    Vec<Dim> open;
    double share;
  };
  std::vector<std::atomic<State>> state_;
  std::unique_ptr<Cut[]> cut_;
};

/// What all bodies leave open of sites, whether particles touch them or not.
template <int Dim>
class SiteCuts {
 public:
  SiteCuts(const Grid<Dim>& grid, const Splines<Dim>& splines, const StaticCut<Dim>& at_rest,
           const PlacedBodies<Dim>& bodies)
      : places_(grid, splines),
        at_rest_(at_rest),
        bodies_(bodies),
        sites_(splines.sites()),
        found_(bodies.any_moves() ? rows_in<Dim>(sites_) : 0) {}
  SiteCuts(const MacGrid<Dim>& mac, const StaticCut<Dim>& at_rest, const PlacedBodies<Dim>& bodies)
      : SiteCuts(*mac.grid, *mac.splines, at_rest, bodies) {}

  SiteCut<Dim> by_resting(const Index<Dim>& site) const {
    if (at_rest_.of.empty()) return {};
    return bodies_.dry() != nullptr ? bodies_.dry()->at_rest[row_in<Dim>(at_rest_.sites, site)] : at_rest_.at(site);
  }
  /// The same, found anew.
  SiteCut<Dim> cut_by_resting(const Index<Dim>& site) const;
  SiteCut<Dim> at(const Index<Dim>& site) const;
  /// Integral of N_l of a site over what of the open volume lies below a plane, over that of N_l.
  /// \param psi  signed distance of the middle of the multiplier from the plane, in units of h
  /// \param normal  into the liquid
  double open_below(const Index<Dim>& site, double psi, const Vec<Dim>& normal) const;
  /// Open share of the volume between the middles of the two multipliers of a face; at a wall there is one.
  /// \param share  of a multiplier, by its site
  template <class ShareOf>
  double open_volume(const Index<Dim>& site, std::size_t d, const ShareOf& share) const;
  /// Open share of a multiplier as another site sees it.
  double share_from(const Index<Dim>& from, const Index<Dim>& site) const;
  /// The same as a side of a wall sees it, the mean from those of its multipliers that are nearest; 0 if it has none.
  double share_from(std::span<const HiddenSites::Sight> side, std::span<const Index<Dim>> site_of_row,
                    const Index<Dim>& site) const;
  /// The same as a multiplier sees it, that of a hidden site as its side does.
  double share_from_row(const HiddenSites* hidden, std::span<const Index<Dim>> site_of_row, std::size_t row,
                        const Index<Dim>& site) const;
  const SitePlaces<Dim>& places() const { return places_; }

 private:
  /// No face leads through a wall that hides one of its multipliers from the other.
  /// \param distance  distance(x, from) from bodies, as a site sees them
  template <class Distance>
  SiteCut<Dim> cut_from(const Index<Dim>& site, const Distance& distance) const;
  void close_hidden(const Index<Dim>& site, SiteCut<Dim>& cut) const;

  SitePlaces<Dim> places_;
  const StaticCut<Dim>& at_rest_;
  const PlacedBodies<Dim>& bodies_;
  Index<Dim> sites_;
  mutable FoundCuts<Dim> found_;
};

template <int Dim>
template <class ShareOf>
double SiteCuts<Dim>::open_volume(const Index<Dim>& site, std::size_t d, const ShareOf& share) const {
  const auto below = adjacent_site(places_.splines(), site, 2 * d);
  if (!below) return share(site);
  if (site[d] >= places_.splines().axis[d].multipliers()) return share(*below);
  return 0.5 * (share(site) + share(*below));
}

/// (E85) of the sites of a step.
template <int Dim>
struct CutFaces {
  static constexpr Doc doc = "(E85) what bodies leave open of faces and multipliers";
  void operator()(Uses<MacGrid<Dim>> mac, Uses<BodyPlacement<Dim>> placement, Read<StaticCut<Dim>> at_rest,
                  Optional<Read<DrySides<Dim>>> dry, Optional<Read<HiddenSites>> hidden,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::Velocity<Dim>> V_old, Read<body::Spin<Dim>> omega_old,
                  Read<body::MeanSpin<Dim>> omega_b, Write<face::Open<Dim>> open,
                  Write<face::OpenVolume<Dim>> open_volume, Write<face::WallFlux<Dim>> flux,
                  Write<face::OldWallFlux<Dim>> old_flux, Write<face::Closed<Dim>> closed,
                  Write<face::Closer<Dim>> closer, Write<multiplier::OpenShare> share,
                  Update<multiplier::Capacity> capacity) const;
};

}  // namespace minamo
