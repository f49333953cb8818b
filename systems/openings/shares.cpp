#include "systems/openings/shares.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

namespace minamo {

namespace {

/// Parts of a face along an axis whose middles are tried.
template <int Dim>
constexpr int parts = Dim == 2 ? 32 : 8;

/// How far next to a middle it is tried, on both sides, as a share of a part: of edges that lie on middles either side
/// of the box has the half, whatever rounding says.
constexpr double aside = 1e-6;

/// Shares of a face that `where` and bodies leave.
struct Tried {
  double where = 0;
  double open = 0;
};

template <int Dim>
Tried try_face(const Vec<Dim>& x, std::size_t axis, const std::optional<Expression>& where, const Sides<Dim>& sides) {
  const Grid<Dim>& grid = sides.grid;
  Tried tried;
  Arguments arguments({.time = 0, .ode = {}, .ode_count = 0});
  Vec<Dim> low = x;
  Vec<Dim> width = Vec<Dim>::Zero();
  for (std::size_t e = 0; e < Dim; ++e) {
    if (e == axis) continue;
    const auto d = static_cast<Eigen::Index>(e);
    const FaceRange range = range_of_face<Dim>(grid, e, x);
    low[d] = range.low;
    width[d] = range.high - range.low;
  }
  const auto is_in_body = [&](const Vec<Dim>& at) {
    if (sides.bodies == nullptr) return false;
    return std::any_of(sides.bodies->bodies.begin(), sides.bodies->bodies.end(),
                       [&](const auto& body) { return !body.moves() && body.shape->distance(at) < 0; });
  };
  Index<Dim> tries{};
  double count = 0;
  for (;;) {
    Vec<Dim> at = low;
    for (std::size_t e = 0; e < Dim; ++e) {
      const auto d = static_cast<Eigen::Index>(e);
      if (e == axis) continue;
      const double place = 0.5 + (tries[e] % 2 == 0 ? -aside : aside);
      at[d] += width[d] * (tries[e] / 2 + place) / parts<Dim>;
      const double length = grid.high[d] - grid.low[d];
      if (grid.periodic[e]) at[d] -= length * std::floor((at[d] - grid.low[d]) / length);
    }
    ++count;
    if (!where || (*where)(arguments.at<Dim>(at)) != 0) {
      ++tried.where;
      if (!is_in_body(at)) ++tried.open;
    }
    std::size_t e = 0;
    while (e < Dim && (e == axis || ++tries[e] == 2 * parts<Dim>)) tries[e++] = 0;
    if (e == Dim) break;
  }
  return {tried.where / count, tried.open / count};
}

/// Whether a wall next to an opening holds a face across it, as no-slip walls do.
template <int Dim>
bool is_held_next_to(const Sides<Dim>& sides, const OpeningSet<Dim>& set, std::size_t own, const Index<Dim>& site,
                     std::size_t d) {
  for (std::size_t side = 0; side < 2 * Dim; ++side) {
    const std::size_t e = side / 2;
    if (side == own || e == d || sides.splines.axis[e].periodic()) continue;
    const bool may_open = std::any_of(set.openings.begin(), set.openings.end(),
                                      [&](const Opening<Dim>& other) { return other.side == side; });
    if (!may_open && Side<Dim>(sides.grid, sides.splines, side).holds(site, d) &&
        (sides.walls.held[e][side % 2] >> d & 1) != 0)
      return true;
  }
  return false;
}

}  // namespace

template <int Dim>
void find_shares(OpeningSet<Dim>& set, const std::vector<std::optional<Expression>>& where, const Sides<Dim>& sides,
                 SeedProblems& problems) {
  constexpr double least_of_outflow = 0.5;
  for (std::size_t o = 0; o < set.openings.size(); ++o) {
    Opening<Dim>& opening = set.openings[o];
    const Side<Dim> side(sides.grid, sides.splines, opening.side);
    const std::size_t axis = side.axis();
    const std::string pointer = fmt::format("/openings/{}", o);
    auto& of_face = set.of_face[opening.side];
    of_face.resize(side.count(axis), static_cast<std::int16_t>(no_opening));
    opening.share.assign(side.count(axis), 0);
    opening.held.assign(side.count(axis), 0);
    double tried = 0;
    double open = 0;
    int twin = no_opening;
    for (std::size_t k = 0; k < opening.share.size(); ++k) {
      const Index<Dim> site = side.site(k, axis);
      const Tried face = try_face<Dim>(side.place(site, axis), axis, where[o], sides);
      tried += face.where;
      double share = face.open;
      if (!opening.is_prescribed()) share = share >= least_of_outflow ? 1 : 0;
      open += share;
      if (share == 0) continue;
      if (is_held_next_to<Dim>(sides, set, opening.side, site, axis)) {
        opening.held[k] = share;
        continue;
      }
      if (of_face[k] != no_opening) twin = of_face[k];
      opening.share[k] = share;
      of_face[k] = static_cast<std::int16_t>(o);
    }
    if (tried == 0) {
      problems.note(pointer + "/where", "meets no face of the side", "true on some of the side",
                    "false everywhere on it");
    } else if (open == 0) {
      problems.note(pointer, opening.is_inflow() ? "an inlet inside a body" : "an outlet inside a body",
                    "an opening that bodies leave free", "all of it lies in bodies, or is narrower than half a cell");
    } else if (twin != no_opening) {
      problems.note(pointer + "/where", "two openings on one face", "a cell between openings, or more",
                    fmt::format("faces that belong to \"{}\", too", set.openings[static_cast<std::size_t>(twin)].name));
    }
  }
}

template void find_shares<2>(OpeningSet<2>&, const std::vector<std::optional<Expression>>&, const Sides<2>&,
                             SeedProblems&);
template void find_shares<3>(OpeningSet<3>&, const std::vector<std::optional<Expression>>&, const Sides<3>&,
                             SeedProblems&);

}  // namespace minamo
