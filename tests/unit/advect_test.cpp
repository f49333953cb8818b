#include "support/extremes.hpp"
#include "support/kernels.hpp"

#include "components/step.hpp"
#include "systems/transfer/advect.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Random particles and a displacement of all nodes.
void displace(World& world, const Vec<2>& u) {
  fill<2>(world, 300, 41);
  const auto y_p = world.column<particle::QuadraturePosition<2>>();
  std::copy(y_p.begin(), y_p.end(), world.column<particle::Position<2>>().begin());
  for (Vec<2>& u_i : world.column<node::Displacement<2>>()) u_i = u;
  run<Advect<2>>(world);
}

}  // namespace

TEST_CASE("particles move with the displacement of the nodes", "[unit]") {
  World world;
  const Vec<2> u(0.01, -0.02);
  displace(world, u);
  const Grid<2> grid = small_grid<2>();
  const auto y_p = world.column<particle::QuadraturePosition<2>>();
  const auto x_p = world.column<particle::Position<2>>();
  Largest worst;
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const Vec<2> free = y_p[p] + u;
    const bool stays = (free.array() > grid.low.array()).all() && (free.array() < grid.high.array()).all();
    if (stays) worst.add((x_p[p] - free).norm());
  }
  CHECK(worst.value() < 1e-15);  // a rounding of coordinates of size 5
}

TEST_CASE("a particle that would leave the box is clamped to just inside the wall", "[unit]") {
  World world;
  displace(world, {0.4, 0});
  const Grid<2> grid = small_grid<2>();
  const auto y_p = world.column<particle::QuadraturePosition<2>>();
  const auto x_p = world.column<particle::Position<2>>();
  std::size_t wrong = 0;
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    if (y_p[p][0] + 0.4 <= grid.high[0]) continue;
    wrong += !(x_p[p][0] < grid.high[0] && x_p[p][0] > grid.high[0] - 1e-5 * grid.spacing);
  }
  CHECK(wrong == 0);
}

TEST_CASE("particles that are clamped are counted", "[unit]") {
  World world;
  displace(world, {0.4, -0.3});
  const Grid<2> grid = small_grid<2>();
  std::int64_t expected = 0;
  for (const Vec<2>& y : world.column<particle::QuadraturePosition<2>>()) {
    expected += y[0] + 0.4 > grid.high[0] || y[1] - 0.3 < grid.low[1];
  }
  CHECK(expected > 0);
  CHECK(world.resource<Clamped>().count == expected);
}
