#include "systems/openings/opening_set.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <stdexcept>

namespace minamo {

void require_finite_opening(const std::string& opening, std::string_view what, double value, double time) {
  if (std::isfinite(value)) return;
  throw std::runtime_error(
      fmt::format("openings: the {} of \"{}\" is not finite at t = {:.6g} s", what, opening, time));
}

namespace {

/// Distance beyond a side, where it is one that particles can leave through; else zero. [m]
template <int Dim>
double beyond(const Grid<Dim>& grid, std::size_t side, const Vec<Dim>& x) {
  const auto axis = static_cast<Eigen::Index>(side / 2);
  const double distance = side % 2 == 0 ? grid.low[axis] - x[axis] : x[axis] - grid.high[axis];
  // Less is rounding of a particle that comes in: walls keep it, too.
  return distance > off_wall * grid.spacing ? distance : 0;
}

/// Share of a face that lies under a level along the vertical axis: of what is nearer to it than to others.
template <int Dim>
double wetted(const Grid<Dim>& grid, const Vertical& vertical, const Vec<Dim>& x, double level) {
  const auto axis = static_cast<Eigen::Index>(vertical.axis);
  const double low = std::max(x[axis] - grid.spacing / 2, grid.low[axis]);
  const double high = std::min(x[axis] + grid.spacing / 2, grid.high[axis]);
  const double under = std::clamp((level - low) / (high - low), 0.0, 1.0);
  return vertical.force > 0 ? 1 - under : under;
}

double at_time(const Expression& expression, double time) { return expression(std::array{0.0, 0.0, 0.0, time}); }

/// Coordinate of the surface outside. [m]
template <int Dim>
double level_at(const Opening<Dim>& opening, double time) {
  const double level = at_time(*opening.level, time);
  require_finite_opening(opening.name, "level", level, time);
  return level;
}

/// Shares of faces under the level of an opening that has one.
template <int Dim>
std::vector<double> wet_shares(const Opening<Dim>& opening, const OpeningSet<Dim>& set, const Grid<Dim>& grid,
                               const Side<Dim>& side, double time) {
  std::vector<double> share = opening.share;
  if (!opening.level) return share;
  const double level = level_at<Dim>(opening, time);
  for (std::size_t k = 0; k < share.size(); ++k) {
    if (share[k] > 0)
      share[k] *= wetted<Dim>(grid, *set.vertical, side.place(side.site(k, side.axis()), side.axis()), level);
  }
  return share;
}

/// Calls use(x, weight) for points whose sum is the integral over what is nearer to a face than to others, up to third
/// degree. Weights add up to 1.
template <int Dim, class Use>
void for_each_gauss_point(const Grid<Dim>& grid, std::size_t across, const Vec<Dim>& face, const Use& use) {
  constexpr double from_middle = 0.28867513459481288;  // 1/sqrt(12)
  const int points = 1 << (Dim - 1);
  for (int k = 0; k < points; ++k) {
    Vec<Dim> x = face;
    int bit = 0;
    for (std::size_t e = 0; e < Dim; ++e) {
      if (e == across) continue;
      const auto [low, high] = range_of_face<Dim>(grid, e, face);
      const double side = (k >> bit++ & 1) == 0 ? -1 : 1;
      x[static_cast<Eigen::Index>(e)] = (low + high) / 2 + side * from_middle * (high - low);
    }
    use(x, 1.0 / points);
  }
}

/// (E104)  Velocities at faces have not quite the flow of the velocity that is given; in proportion they do. Not where
/// some liquid comes in and some leaves.
template <int Dim>
void scale_to_flow(const Opening<Dim>& opening, const Grid<Dim>& grid, const Side<Dim>& side, Arguments& arguments,
                   std::vector<double>& across) {
  const std::size_t d = side.axis();
  double given = 0;
  double of_faces = 0;
  double absolute = 0;
  for (std::size_t k = 0; k < across.size(); ++k) {
    const Index<Dim> site = side.site(k, d);
    of_faces += across[k] * side.area(site);
    absolute += std::abs(across[k]) * side.area(site);
    const double share = opening.share[k] + opening.held[k];
    if (share == 0) continue;
    for_each_gauss_point<Dim>(grid, d, side.place(site, d), [&](const Vec<Dim>& x, double weight) {
      given += share * side.area(site) * weight * opening.velocity[d](arguments.at<Dim>(x));
    });
  }
  constexpr double one_way = 0.999;
  if (std::abs(of_faces) < one_way * absolute || absolute == 0 || !std::isfinite(given)) return;
  for (double& velocity : across) velocity *= given / of_faces;
}

/// [m^3/s; m^2/s in 2-D]
template <int Dim>
double inflow_rate(const Opening<Dim>& opening, double time) {
  const double rate = at_time(opening.rate, time);
  require_finite_opening(opening.name, "inflow", rate, time);
  if (rate >= 0) return rate;
  throw std::runtime_error(
      fmt::format("openings: the rate of \"{}\", what comes in, is {:.6g} at t = {:.6g} s", opening.name, rate, time));
}

}  // namespace

template <int Dim>
int OpeningSet<Dim>::at(const Grid<Dim>& grid, const Splines<Dim>& splines, std::size_t side, const Vec<Dim>& x) const {
  if (!opens(side)) return no_opening;
  const Side<Dim> of(grid, splines, side);
  const auto nearest = of.nearest(of.within(x));
  int first = of_face[side][nearest.index[0]];
  for (std::size_t k = 1; k < nearest.count; ++k)  // no_opening is less than any
    first = std::min(first, static_cast<int>(of_face[side][nearest.index[k]]));
  return first;
}

template <int Dim>
int OpeningSet<Dim>::left_through(const Grid<Dim>& grid, const Splines<Dim>& splines, const Vec<Dim>& x) const {
  const double rounding = 1e-9 * grid.spacing;
  int opening = no_opening;
  double farthest = 0;
  for (std::size_t side = 0; side < 2 * Dim; ++side) {
    const double distance = grid.periodic[side / 2] ? 0 : beyond<Dim>(grid, side, x);
    if (distance == 0 || distance < farthest - rounding) continue;
    const int through = at(grid, splines, side, x);
    // As far beyond two sides: through the first opening of the scene.
    const bool is_as_far = opening != no_opening && distance <= farthest + rounding;
    if (through == no_opening || (is_as_far && through > opening)) continue;
    opening = through;
    farthest = distance;
  }
  return opening;
}

namespace {

/// Which of two openings that a face lies in says more about it, the higher first. [1]
enum class Rank { none, along_free, across_unknown, at_rest, along_prescribed, across_prescribed };

template <int Dim>
Rank rank_of(const Opening<Dim>& opening, bool across) {
  if (opening.is_prescribed()) return across ? Rank::across_prescribed : Rank::along_prescribed;
  if (across) return Rank::across_unknown;
  return opening.has_pressure() ? Rank::at_rest : Rank::along_free;
}

}  // namespace

template <int Dim>
FaceCondition condition_at(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines,
                           const Walls<Dim>& walls, const Index<Dim>& site, std::size_t d) {
  if (!splines.has_face(site, d)) return {true};
  const unsigned bit = 1U << d;
  Rank highest = Rank::none;
  int first = no_opening;
  for (std::size_t side = 0; side < 2 * Dim; ++side) {
    const std::size_t e = side / 2;
    if (splines.axis[e].periodic()) continue;
    const Side<Dim> of(grid, splines, side);
    if (!of.holds(site, d)) continue;
    const int opening = set.opens(side) ? set.at(grid, splines, side, of.place(site, d)) : no_opening;
    if (opening == no_opening) {
      if ((walls.held[e][side % 2] & bit) != 0) return {true};
      continue;
    }
    const Rank rank = rank_of<Dim>(set.openings[static_cast<std::size_t>(opening)], e == d);
    if (rank < highest || (rank == highest && opening > first)) continue;
    highest = rank;
    first = opening;
  }
  if (highest == Rank::at_rest) return {true, no_opening};
  return {highest >= Rank::along_prescribed, first};
}

template <int Dim>
opening::SideVelocity<Dim> prescribed_velocity(const Opening<Dim>& opening, const OpeningSet<Dim>& set,
                                               const Grid<Dim>& grid, const Splines<Dim>& splines, double time) {
  const Side<Dim> side(grid, splines, opening.side);
  opening::SideVelocity<Dim> velocity;
  for (std::size_t d = 0; d < Dim; ++d) velocity.of[d].assign(side.count(d), 0);
  const std::vector<double> share = wet_shares<Dim>(opening, set, grid, side, time);
  if (opening.kind == OpeningKind::rate) {
    double area = 0;
    for (std::size_t k = 0; k < share.size(); ++k) area += share[k] * side.area(side.site(k, side.axis()));
    const double rate = inflow_rate<Dim>(opening, time);
    const double speed = area > 0 ? side.inward() * rate / area : 0;
    for (std::size_t k = 0; k < share.size(); ++k) velocity.of[side.axis()][k] = share[k] * speed;
    return velocity;
  }
  Arguments arguments({.time = time, .ode = {}, .ode_count = 0});
  const auto number = static_cast<int>(&opening - set.openings.data());
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t k = 0; k < velocity.of[d].size(); ++k) {
      const Vec<Dim> x = side.place(side.site(k, d), d);
      const double of_face = d == side.axis() ? share[k] : set.at(grid, splines, opening.side, x) == number ? 1 : 0;
      if (of_face == 0) continue;
      const double value = opening.velocity[d](arguments.at<Dim>(x));
      require_finite_opening(opening.name, "inflow", value, time);
      velocity.of[d][k] = d == side.axis() ? of_face * value : value;
    }
  }
  scale_to_flow<Dim>(opening, grid, side, arguments, velocity.of[side.axis()]);
  return velocity;
}

template <int Dim>
double largest_prescribed_speed(const OpeningSet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines,
                                double time) {
  double largest = 0;
  for (const Opening<Dim>& opening : set.openings) {
    if (!opening.is_prescribed()) continue;
    const auto velocity = prescribed_velocity<Dim>(opening, set, grid, splines, time);
    Vec<Dim> most = Vec<Dim>::Zero();
    for (std::size_t d = 0; d < Dim; ++d) {
      for (const double v : velocity.of[d])
        most[static_cast<Eigen::Index>(d)] = std::max(most[static_cast<Eigen::Index>(d)], std::abs(v));
    }
    largest = std::max(largest, most.norm());
  }
  return largest;
}

template <int Dim>
double pressure_outside(const Opening<Dim>& opening, const OpeningSet<Dim>& set, double density, const Vec<Dim>& x,
                        double time) {
  if (opening.kind == OpeningKind::level) {
    const double depth = x[static_cast<Eigen::Index>(set.vertical->axis)] - level_at<Dim>(opening, time);
    return density * std::max(0.0, set.vertical->force * depth);
  }
  if (opening.kind != OpeningKind::pressure) return 0;
  return opening.pressure(Arguments({.time = time, .ode = {}, .ode_count = 0}).at<Dim>(x));
}

template struct OpeningSet<2>;
template struct OpeningSet<3>;
template FaceCondition condition_at<2>(const OpeningSet<2>&, const Grid<2>&, const Splines<2>&, const Walls<2>&,
                                       const Index<2>&, std::size_t);
template FaceCondition condition_at<3>(const OpeningSet<3>&, const Grid<3>&, const Splines<3>&, const Walls<3>&,
                                       const Index<3>&, std::size_t);
template opening::SideVelocity<2> prescribed_velocity<2>(const Opening<2>&, const OpeningSet<2>&, const Grid<2>&,
                                                         const Splines<2>&, double);
template opening::SideVelocity<3> prescribed_velocity<3>(const Opening<3>&, const OpeningSet<3>&, const Grid<3>&,
                                                         const Splines<3>&, double);
template double largest_prescribed_speed<2>(const OpeningSet<2>&, const Grid<2>&, const Splines<2>&, double);
template double largest_prescribed_speed<3>(const OpeningSet<3>&, const Grid<3>&, const Splines<3>&, double);
template double pressure_outside<2>(const Opening<2>&, const OpeningSet<2>&, double, const Vec<2>&, double);
template double pressure_outside<3>(const Opening<3>&, const OpeningSet<3>&, double, const Vec<3>&, double);

}  // namespace minamo
