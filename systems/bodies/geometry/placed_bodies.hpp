#pragma once
/// \file
/// The distance from the bodies of a scene, wherever they are, and from what thin walls keep dry or hide.

#include "systems/bodies/body_placement.hpp"
#include "systems/bodies/geometry/static_cut.hpp"
#include "systems/bodies/geometry/thin_walls.hpp"

namespace minamo {

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
  bool any_moves() const { return !moving_.empty(); }
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

}  // namespace minamo
