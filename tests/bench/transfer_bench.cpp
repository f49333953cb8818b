// Cost of the transfers per particle and step, on one thread: `build/test/minamo_bench "[transfer]"`.

#include "support/kernels.hpp"
#include "systems/transfer/mass.hpp"
#include "systems/transfer/tpic.hpp"

#include <catch2/catch.hpp>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

using namespace minamo;

namespace {

/// A full box of particles at random places, `per_cell` in every cell on average, with a velocity gradient.
template <int Dim>
std::size_t fill(World& world, int cells, std::size_t per_cell) {
  Grid<Dim>& grid = world.resource<Grid<Dim>>();
  grid.spacing = 1.0 / cells;
  grid.cells.fill(cells);
  grid.low = Vec<Dim>::Zero();
  grid.high = Vec<Dim>::Ones();
  const std::size_t count = per_cell * power(static_cast<std::size_t>(cells), Dim);
  world.resize<Particles>(count);
  kernels::Random random(1);
  for (Vec<Dim>& y : world.column<particle::Configuration<Dim>>()) y = random.vector<Dim>(0, 1);
  for (Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) v = random.vector<Dim>(-1, 1);
  for (Mat<Dim>& gradient : world.column<particle::VelocityGradient<Dim>>()) gradient = random.matrix<Dim>(-1, 1);
  for (double& m : world.column<particle::Mass>()) m = 1;
  kernels::run<Bin<Dim>>(world);
  kernels::run<NumberNodes<Dim>>(world);
  return count;
}

/// Median over runs of what one particle costs. [us]
double microseconds(std::size_t particles, const std::function<void()>& body) {
  std::vector<double> times;
  for (int k = 0; k < 21; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    body();
    times.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  std::nth_element(times.begin(), times.begin() + 10, times.end());
  return times[10] / static_cast<double>(particles);
}

template <int Dim>
void print_costs(int cells, std::size_t per_cell) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  World world;
  const std::size_t count = fill<Dim>(world, cells, per_cell);
  const double p2g = microseconds(count, [&] {
    kernels::run<P2GMass<Dim>>(world);
    kernels::run<P2GVelocityTpic<Dim>>(world);
  });
  const double g2p = microseconds(count, [&] { kernels::run<G2PVelocityTpic<Dim>>(world); });
  std::printf("%d-D, %zu particles per cell, %zu particles: P2G %.4f us, G2P %.4f us per particle and step\n", Dim,
              per_cell, count, p2g, g2p);
  CHECK(p2g > 0);
  CHECK(g2p > 0);
}

}  // namespace

TEST_CASE("TPIC transfers in two dimensions", "[!benchmark][transfer]") { print_costs<2>(100, 16); }

TEST_CASE("TPIC transfers in three dimensions", "[!benchmark][transfer]") { print_costs<3>(30, 8); }
