#include "systems/bodies/warnings.hpp"

#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/vector_text.hpp"
#include "systems/bodies/bodies_part.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/bodies/geometry/outlines.hpp"
#include "systems/bodies/geometry/seed_cut.hpp"
#include "systems/bodies/geometry/surface_samples.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

namespace minamo {

namespace {

/// Gaps thinner than this many cells have no cell that is full.
constexpr double thinnest_gap = 2;

/// The narrowest place between a body and another one, or a side of the grid.
template <int Dim>
struct Narrow {
  Vec<Dim> from = Vec<Dim>::Zero();  ///< point of the surface of the body [m]
  Vec<Dim> to = Vec<Dim>::Zero();    ///< the nearest point of the other one [m]
  double width = 0;                  ///< less than zero where they overlap [m]

  Vec<Dim> at(double share) const { return from + share * (to - from); }
};

/// What a body may come near to: the distance from it, and its gradient.
template <int Dim>
struct Opposite {
  std::function<double(const Vec<Dim>&)> distance;
  std::function<Vec<Dim>(const Vec<Dim>&)> gradient;
};

template <int Dim>
Opposite<Dim> as_opposite(const Shape<Dim>& shape) {
  return {[&](const Vec<Dim>& x) { return shape.distance(x); }, [&](const Vec<Dim>& x) { return shape.gradient(x); }};
}

template <int Dim>
Opposite<Dim> as_opposite(const Grid<Dim>& grid, std::size_t side) {
  const auto axis = static_cast<Eigen::Index>(side / 2);
  const double sign = side % 2 == 0 ? 1 : -1;
  const double end = side % 2 == 0 ? grid.low[axis] : grid.high[axis];
  return {[=](const Vec<Dim>& x) { return sign * (x[axis] - end); },
          [=](const Vec<Dim>&) { return Vec<Dim>(sign * Vec<Dim>::Unit(static_cast<int>(axis))); }};
}

/// Whether a point is in the grid, or beyond one of its sides by a cell at most.
template <int Dim>
bool is_near_grid(const Grid<Dim>& grid, const Vec<Dim>& x) {
  return ((x - grid.low).array() >= -grid.spacing).all() && ((grid.high - x).array() >= -grid.spacing).all();
}

/// Samples of the surface of bodies of a scene, made once each.
template <int Dim>
class Surroundings {
 public:
  Surroundings(const BodySet<Dim>& set, const BodyOutlines<Dim>& outlines, const Grid<Dim>& grid)
      : set_(set), grid_(grid) {
    const Vec<Dim> cell = Vec<Dim>::Constant(grid.spacing);
    const Bounds<Dim> box{grid.low - cell, grid.high + cell};
    for (std::size_t b = 0; b < set.bodies.size(); ++b)
      samples_.push_back(samples_of<Dim>(*set.bodies[b].shape, outlines.bodies[b].outline, box, sample()));
  }

  /// The narrowest gap from a body to something, where the two face each other.
  std::optional<Narrow<Dim>> gap(std::size_t b, const Opposite<Dim>& opposite) const {
    constexpr double facing = -0.9;  // cosine: walls of a wedge of less than 26 degrees
    const Shape<Dim>& shape = *set_.bodies[b].shape;
    std::vector<Vec<Dim>> points;
    std::vector<Narrow<Dim>> widths;
    for (const Vec<Dim>& x : samples_[b]) {
      if (!is_near_grid<Dim>(grid_, x)) continue;
      const double width = opposite.distance(x);
      if (width > (thinnest_gap - 1e-6) * grid_.spacing || width < -grid_.spacing) continue;
      const Vec<Dim> normal = opposite.gradient(x);
      if (shape.gradient(x).dot(normal) > facing) continue;
      points.push_back(x);
      widths.push_back({x, Vec<Dim>(x - width * normal), width});
    }
    return narrowest_open(groups_of<Dim>(points, 2 * sample()), widths);
  }

  /// How deep the points of a body reach into something, if they do.
  std::optional<Narrow<Dim>> overlap(std::size_t b, const Opposite<Dim>& opposite) const {
    Narrow<Dim> deepest{Vec<Dim>::Zero(), Vec<Dim>::Zero(), -least()};
    for (const Vec<Dim>& x : samples_[b]) {
      const double width = opposite.distance(x);
      if (width < deepest.width) deepest = {x, x, width};
    }
    return deepest.width < -least() ? std::optional(deepest) : std::nullopt;
  }

  /// Whether all of the surface of a body lies in something, or on its surface.
  bool lies_in(std::size_t b, const Opposite<Dim>& opposite) const {
    const auto is_in = [&](const Vec<Dim>& x) { return opposite.distance(x) <= least(); };
    return !samples_[b].empty() && std::all_of(samples_[b].begin(), samples_[b].end(), is_in);
  }

 private:
  double sample() const { return 0.5 * grid_.spacing; }
  /// Widths below are none.
  double least() const { return 1e-3 * grid_.spacing; }

  /// Of gaps that are open all along: where one closes, walls meet at an angle or bodies touch, which is no mistake.
  /// Beyond the sides of the grid it matters only whether they close.
  std::optional<Narrow<Dim>> narrowest_open(const std::vector<std::size_t>& group,
                                            const std::vector<Narrow<Dim>>& widths) const {
    std::map<std::size_t, Narrow<Dim>> narrowest;
    for (std::size_t k = 0; k < group.size(); ++k) {
      if (widths[k].width > least() && is_outside(widths[k].from)) continue;
      const auto [found, is_new] = narrowest.try_emplace(group[k], widths[k]);
      if (!is_new && widths[k].width < found->second.width) found->second = widths[k];
    }
    std::optional<Narrow<Dim>> best;
    for (const auto& [number, narrow] : narrowest) {
      if (narrow.width <= least() || is_filled(narrow)) continue;
      if (!best || narrow.width < best->width) best = narrow;
    }
    return best;
  }

  /// Whether there is something else between the two.
  bool is_filled(const Narrow<Dim>& narrow) const {
    return std::any_of(shares_looked_at.begin(), shares_looked_at.end(),
                       [&](double share) { return is_no_place(narrow.at(share)); });
  }
  static constexpr std::array shares_looked_at{0.05, 0.25, 0.5, 0.75, 0.95};

  bool is_outside(const Vec<Dim>& x) const {
    return (x.array() < grid_.low.array()).any() || (x.array() > grid_.high.array()).any();
  }

  bool is_no_place(const Vec<Dim>& x) const {
    return is_outside(x) || std::any_of(set_.bodies.begin(), set_.bodies.end(),
                                        [&](const auto& body) { return body.shape->distance(x) < 0; });
  }

  const BodySet<Dim>& set_;
  const Grid<Dim>& grid_;
  std::vector<std::vector<Vec<Dim>>> samples_;
};

template <int Dim>
std::optional<Narrow<Dim>> narrower(std::optional<Narrow<Dim>> a, std::optional<Narrow<Dim>> b) {
  if (!a || !b) return a ? a : b;
  return a->width <= b->width ? a : b;
}

std::string name_of_side(std::size_t side) {
  return fmt::format("the {} side of {}", side % 2 == 0 ? "low" : "high", "xyz"[side / 2]);
}

template <int Dim>
class BodyWarnings {
 public:
  BodyWarnings(const BodySet<Dim>& set, const BodyOutlines<Dim>& outlines, const Grid<Dim>& grid)
      : set_(set), grid_(grid), around_(set, outlines, grid) {}

  std::vector<std::string> all() {
    for (std::size_t a = 0; a < set_.bodies.size(); ++a) {
      for (std::size_t side = 0; side < 2 * static_cast<std::size_t>(Dim); ++side) {
        if (!grid_.periodic[side / 2]) look_at_side(a, side);
      }
      for (std::size_t b = a + 1; b < set_.bodies.size(); ++b) look_at_pair(a, b);
    }
    return std::move(found_);
  }

 private:
  std::string quoted(std::size_t b) const { return '"' + set_.bodies[b].name + '"'; }

  void look_at_side(std::size_t a, std::size_t side) {
    const auto opposite = as_opposite<Dim>(grid_, side);
    note_gap(around_.gap(a, opposite), quoted(a), name_of_side(side));
    if (set_.bodies[a].free()) note_overlap(around_.overlap(a, opposite), a, name_of_side(side));
  }

  void look_at_pair(std::size_t a, std::size_t b) {
    const auto of_a = as_opposite<Dim>(*set_.bodies[a].shape);
    const auto of_b = as_opposite<Dim>(*set_.bodies[b].shape);
    const bool is_b_in_a = around_.lies_in(b, of_a);
    if (is_b_in_a || around_.lies_in(a, of_b)) {
      found_.push_back(
          fmt::format("body {} lies in the place of {}", quoted(is_b_in_a ? b : a), quoted(is_b_in_a ? a : b)));
      return;
    }
    note_gap(narrower<Dim>(around_.gap(a, of_b), around_.gap(b, of_a)), quoted(a), quoted(b));
    const bool is_b_the_free_one = !set_.bodies[a].free() && set_.bodies[b].free();
    const std::size_t first = is_b_the_free_one ? b : a;
    note_overlap(narrower<Dim>(around_.overlap(a, of_b), around_.overlap(b, of_a)), first,
                 quoted(is_b_the_free_one ? a : b));
  }

  void note_gap(const std::optional<Narrow<Dim>>& gap, const std::string& a, const std::string& b) {
    if (!gap) return;
    found_.push_back(
        fmt::format("a gap of {:.3g} m between body {} and {} at {}, thinner than two cells, {:.3g} m: the "
                    "grid hardly lets liquid through",
                    gap->width, a, b, place_text<Dim>(gap->at(0.5)), thinnest_gap * grid_.spacing));
  }

  void note_overlap(const std::optional<Narrow<Dim>>& overlap, std::size_t a, const std::string& b) {
    if (!overlap) return;
    found_.push_back(fmt::format("{}body {} overlaps {} by {:.3g} m at the start, at {}",
                                 set_.bodies[a].free() ? "free " : "", quoted(a), b, -overlap->width,
                                 place_text<Dim>(overlap->from)));
  }

  const BodySet<Dim>& set_;
  const Grid<Dim>& grid_;
  Surroundings<Dim> around_;
  std::vector<std::string> found_;
};

/// Less of the liquid than this is rounding.
constexpr double least_cut = 1e-9;

/// Thinner than so many cells a wall between waters is not seen where it meets another one: of pools on different
/// levels, at nine angles and offsets, three leak at 0.1 h or less, none at 0.15 h. [h]
constexpr double thinnest_between_waters = 0.15;

/// Of the thinnest walls that part liquid from liquid at the start. \param dry  which the run has for itself
template <int Dim>
std::vector<std::string> warnings_of_thin_walls(const BodySet<Dim>& set, const Grid<Dim>& grid, DrySides<Dim> dry,
                                                std::span<const Vec<Dim>> x_p) {
  std::vector<std::string> found;
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    auto& walls = dry.of_body[b];
    const Shape<Dim>& shape = *set.bodies[b].shape;
    if (!walls) continue;
    for (const Vec<Dim>& x : x_p) walls->light(shape, x);
    walls->find_dry();
    const auto wet = walls->wet_on_both_sides(shape, thinnest_between_waters * grid.spacing);
    if (!wet) continue;
    found.push_back(
        fmt::format("body \"{}\" is {:.2g} cells thick and wet on both sides at {}: liquid on different levels may get "
                    "through where it meets another wall; thicker than {:.3g} m, or cells of {:.3g} m",
                    set.bodies[b].name, wet->thickness / grid.spacing, place_text<Dim>(wet->middle),
                    thinnest_between_waters * grid.spacing, wet->thickness / thinnest_between_waters));
  }
  return found;
}

std::vector<std::string> warning_of_cut(const LiquidCut& cut, int dimension) {
  if (cut.volume <= least_cut * cut.of) return {};
  return {fmt::format("bodies take the place of {:.4g} m^{} of the liquid, {:.3g} %, which is cut away", cut.volume,
                      dimension, 100 * cut.volume / cut.of)};
}

}  // namespace

std::vector<std::string> warnings_of_bodies(const Scene& scene, World& world) {
  if (!scene.facts.find<BodiesOfScene>()) return {};
  return with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    auto found = BodyWarnings<Dim>(world.resource<BodySet<Dim>>(), world.resource<BodyOutlines<Dim>>(),
                                   world.resource<Grid<Dim>>())
                     .all();
    const auto of_cut = warning_of_cut(world.resource<LiquidCut>(), Dim);
    found.insert(found.end(), of_cut.begin(), of_cut.end());
    if (!world.has<DrySides<Dim>>()) return found;
    const auto of_thin =
        warnings_of_thin_walls<Dim>(world.resource<BodySet<Dim>>(), world.resource<Grid<Dim>>(),
                                    world.resource<DrySides<Dim>>(), world.template column<particle::Position<Dim>>());
    found.insert(found.end(), of_thin.begin(), of_thin.end());
    return found;
  });
}

}  // namespace minamo
