#include "systems/bodies/particles/watch_bodies.hpp"

#include "components/vector_text.hpp"
#include "engine/schedule/parallel.hpp"
#include "systems/grid/lattice.hpp"
#include "systems/ranks/gathered.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

namespace {

/// In units of h; particles keep a tenth of it off bodies.
constexpr double depth_to_tell = 0.01;

/// The body at rest or the moving one that a point lies in, and how far it is from it.
template <int Dim>
typename PlacedBodies<Dim>::Nearest body_at(const Grid<Dim>& grid, const StaticCut<Dim>& at_rest,
                                            const PlacedBodies<Dim>& bodies, const Vec<Dim>& x) {
  typename PlacedBodies<Dim>::Nearest nearest;
  if (at_rest.clearance_of(grid, cell_of<Dim>(grid, x)) <= 0) nearest = bodies.nearest(x, false);
  if (!bodies.may_be_near(x, 0)) return nearest;
  const auto moving = bodies.nearest(x, true);
  return moving.distance < nearest.distance ? moving : nearest;
}

struct Trapped {
  std::size_t count = 0;
  std::size_t first = 0;  ///< row of the first of them
};

}  // namespace

template <int Dim>
void WatchBodies<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<BodySet<Dim>> set,
                                  Read<StaticCut<Dim>> at_rest, Read<body::Position<Dim>> c_b,
                                  Read<body::Rotation<Dim>> R_b, Read<particle::Position<Dim>> x_p,
                                  Optional<Read<Ranks>> ranks, Update<Warnings> warnings) const {
  if (warnings->has("particles in bodies")) return;
  const PlacedBodies<Dim> bodies(*set, c_b.span(), R_b.span());
  const auto of_particle = [&](std::size_t p) -> Trapped {
    const bool is_in = body_at<Dim>(*grid, *at_rest, bodies, x_p[p]).distance < -depth_to_tell * grid->spacing;
    return {is_in ? std::size_t{1} : 0, p};
  };
  const Trapped trapped = reduce_rows(x_p.size(), Trapped{}, of_particle, [](const Trapped& a, const Trapped& b) {
    return Trapped{a.count + b.count, a.count > 0 ? a.first : b.first};
  });
  const auto own = static_cast<std::int64_t>(trapped.count);
  const std::int64_t all = ranks ? (*ranks)->sum(own) : own;
  if (all == 0) return;
  std::optional<Vec<Dim>> first;
  if (own > 0) first = x_p[trapped.first];
  if (ranks) first = of_lowest_rank(*ranks->all, first);
  const Vec<Dim>& x = *first;
  const auto body = body_at<Dim>(*grid, *at_rest, bodies, x);
  warnings->add("particles in bodies",
                fmt::format("{} particles lie in bodies at t = {:.6g} s, one of them {:.3g} m deep in \"{}\" at {}; a "
                            "shorter step or more cells may keep them out",
                            all, clock->end_of_step, -body.distance,
                            set->bodies[static_cast<std::size_t>(body.body)].name, place_text<Dim>(x)));
}

template struct WatchBodies<2>;
template struct WatchBodies<3>;

}  // namespace minamo
