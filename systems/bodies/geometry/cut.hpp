#pragma once
/// \file
/// (E85) What bodies leave open of the staggered grid: of every face a share of the plane between its two multipliers,
/// of every multiplier a share of its volume.

#include "components/grid.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/thin_walls.hpp"
#include "systems/grid/mac_grid.hpp"
#include "systems/grid/sites_around.hpp"

namespace minamo {

/// Faces less open than this are closed.
inline constexpr double least_open = 1e-3;
/// Less open ones are slivers: what flows through them weighs little and may be fast. Particles do not see them (E87),
/// and gaps near moving bodies made of nothing else are closed. Rounding says nothing of one that is 0.2 open.
inline constexpr double sliver = 0.2 - 1e-9;

/// Place of an index among `count` per direction, x fastest, and the index at a place.
template <int Dim>
std::size_t row_in(const Index<Dim>& count, const Index<Dim>& index) {
  std::size_t row = 0;
  for (std::size_t d = Dim; d-- > 0;)
    row = row * static_cast<std::size_t>(count[d]) + static_cast<std::size_t>(index[d]);
  return row;
}
/// How many places there are.
template <int Dim>
std::size_t rows_in(const Index<Dim>& count) {
  std::size_t rows = 1;
  for (const int along : count) rows *= static_cast<std::size_t>(along);
  return rows;
}
template <int Dim>
Index<Dim> index_in(const Index<Dim>& count, std::size_t row) {
  Index<Dim> index;
  for (std::size_t d = 0; d < Dim; ++d) {
    index[d] = static_cast<int>(row % static_cast<std::size_t>(count[d]));
    row /= static_cast<std::size_t>(count[d]);
  }
  return index;
}

template <int Dim>
Vec<Dim> middle_of_cell(const Grid<Dim>& grid, const Index<Dim>& cell) {
  return grid.position(cell) + Vec<Dim>::Constant(0.5 * grid.spacing);
}

/// Where faces and multipliers are: between the Greville points of neighbouring faces lies a multiplier.
template <int Dim>
class SitePlaces {
 public:
  SitePlaces(const Grid<Dim>& grid, const Splines<Dim>& splines) : grid_(grid), splines_(splines) {}

  /// Greville point of the spline i of degree K along an axis. [m]
  double along(std::size_t d, int i) const;
  /// The box between the faces of a site: from its own to those of the sites above. [m]
  Bounds<Dim> box(const Index<Dim>& site) const;
  /// Middle of a face of direction d.
  Vec<Dim> face(const Index<Dim>& site, std::size_t d) const;
  /// Half of the diagonal of what the splines of a multiplier cover. [m]
  double reach() const;
  const Grid<Dim>& grid() const { return grid_; }
  const Splines<Dim>& splines() const { return splines_; }

 private:
  const Grid<Dim>& grid_;
  const Splines<Dim>& splines_;
};

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

template <int Dim>
struct SiteCut {
  Vec<Dim> open = Vec<Dim>::Ones();  ///< of its faces [1]
  double share = 1;                  ///< of the volume of its multiplier, weighted with its spline [1]
};

/// The cut of a site by a region, of which `distance` is the signed distance, negative inside.
/// \param bounded  whether one distance tells of a neighbourhood (Shape::is_bounded_by_distance())
template <int Dim, class Distance>
SiteCut<Dim> cut_site(const SitePlaces<Dim>& places, const Index<Dim>& site, bool bounded, const Distance& distance);

/// The cut of all sites of the grid by the bodies at rest.
template <int Dim>
struct StaticCut {
  Index<Dim> sites{};             ///< per direction
  std::vector<SiteCut<Dim>> of;   ///< of all sites, x fastest; empty without bodies at rest
  std::vector<double> clearance;  ///< within this of any point of a cell of the grid, x fastest, is no body [m]
  static constexpr ComponentInfo info{"bodies.static_cut", "a_f", "1", Lifetime::constant};

  const SiteCut<Dim>& at(const Index<Dim>& site) const { return of[row_in<Dim>(sites, site)]; }
  double clearance_of(const Grid<Dim>& grid, const Index<Dim>& cell) const {
    return of.empty() ? std::numeric_limits<double>::infinity() : clearance[row_in<Dim>(grid.cells, cell)];
  }
};

template <int Dim>
StaticCut<Dim> cut_by_bodies_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines);

/// (E136) What is dry behind the thin walls of bodies, and what wet walls hide of each other's sides. Only where a body
/// has a thin wall.
template <int Dim>
struct DrySides {
  using View = typename ThinWalls<Dim>::View;
  /// What a body hides from sites.
  struct Views {
    std::vector<std::int32_t> of_site;  ///< place in `list`, or -1; empty where no wall is wet on both sides
    std::vector<View> list;
  };
  std::vector<std::optional<ThinWalls<Dim>>> of_body;
  std::vector<Views> views;  ///< by body
  /// By site, 1 where a wall ends next to it, so that a way leads around over sites next to it: it is hidden from
  /// nobody.
  std::vector<std::uint8_t> is_at_end;
  Index<Dim> sites{};                 ///< per direction
  std::vector<SiteCut<Dim>> at_rest;  ///< as StaticCut::of, by bodies with what is dry behind them
  static constexpr ComponentInfo info{"bodies.dry_sides", "", "", Lifetime::cache};

  /// Whether any wall hides anything that is wet.
  bool hides_any() const {
    return std::any_of(views.begin(), views.end(), [](const Views& of) { return !of.list.empty(); });
  }
  /// What body b hides from a site; null: nothing.
  const View* view(std::size_t b, const Index<Dim>& site) const {
    if (b >= views.size() || views[b].of_site.empty()) return nullptr;
    const std::int32_t at = views[b].of_site[row_in<Dim>(sites, site)];
    return at < 0 ? nullptr : &views[b].list[static_cast<std::size_t>(at)];
  }
  /// Whether anything may be hidden from a site.
  bool has_view(const Index<Dim>& site) const {
    for (std::size_t b = 0; b < views.size(); ++b) {
      if (view(b, site) != nullptr) return true;
    }
    return false;
  }
  /// Whether a wall lies between two sites: they are on its two sides.
  bool parts(const Index<Dim>& one, const Index<Dim>& other) const {
    for (std::size_t b = 0; b < views.size(); ++b) {
      const View* of_one = view(b, one);
      const View* of_other = view(b, other);
      if (of_one == nullptr || of_other == nullptr) continue;
      if (of_body[b]->parts(*of_one, *of_other)) return true;
    }
    return false;
  }
};

/// The bodies of a scene at some place each.
template <int Dim>
class PlacedBodies {
 public:
  /// \param dry  what of the surroundings of bodies counts as part of them; null: nothing
  PlacedBodies(const BodySet<Dim>& set, std::span<const Vec<Dim>> position, std::span<const Mat<Dim>> rotation,
               const DrySides<Dim>* dry = nullptr);
  explicit PlacedBodies(const BodyPlacement<Dim>& placement, const DrySides<Dim>* dry = nullptr)
      : PlacedBodies(*placement.set, placement.c_b.span(), placement.R_b.span(), dry) {}
  static PlacedBodies at_start(const BodySet<Dim>& set);

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  ///< [m]
    int body = -1;
  };
  /// Of the bodies at rest, or of the moving ones.
  /// \param from  a site: what thin walls hide from it counts as part of them; null: nothing
  Nearest nearest(const Vec<Dim>& x, bool moving, const Index<Dim>* from = nullptr) const;
  double distance(const Vec<Dim>& x, bool moving, const Index<Dim>* from = nullptr) const {
    return nearest(x, moving, from).distance;
  }
  double distance(const Vec<Dim>& x) const { return distance_from(nullptr, x); }
  double distance_from(const Index<Dim>* from, const Vec<Dim>& x) const {
    return std::min(distance(x, false, from), distance(x, true, from));
  }
  /// Whether a moving body may be within a distance of a point.
  bool may_be_near(const Vec<Dim>& x, double reach) const;
  bool bounded() const { return bounded_; }
  const Placement<Dim>& placement(std::size_t b) const { return placement_[b]; }
  const DrySides<Dim>* dry() const { return dry_; }

 private:
  const BodySet<Dim>& set_;
  const DrySides<Dim>* dry_;
  std::vector<Placement<Dim>> placement_;
  std::vector<std::size_t> moving_;
  std::vector<std::size_t> resting_;
  std::vector<Bounds<Dim>> moving_bounds_;
  bool bounded_ = true;
};

/// What all bodies leave open of sites, whether particles touch them or not.
template <int Dim>
class SiteCuts {
 public:
  SiteCuts(const Grid<Dim>& grid, const Splines<Dim>& splines, const StaticCut<Dim>& at_rest,
           const PlacedBodies<Dim>& bodies)
      : places_(grid, splines), at_rest_(at_rest), bodies_(bodies) {}

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
};

template <int Dim>
template <class ShareOf>
double SiteCuts<Dim>::open_volume(const Index<Dim>& site, std::size_t d, const ShareOf& share) const {
  const auto below = site_beside(places_.splines(), site, 2 * d);
  if (!below) return share(site);
  if (site[d] >= places_.splines().axis[d].multipliers()) return share(*below);
  return 0.5 * (share(site) + share(*below));
}

/// (E85) of the sites of a step.
template <int Dim>
struct CutFaces {
  static constexpr std::string_view doc = "(E85) what bodies leave open of faces and multipliers";
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
