#include "support/kernels.hpp"
#include "support/rotation.hpp"

#include "components/measure.hpp"
#include "systems/equal_order/volume_projection.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/measure/energy_watch.hpp"
#include "systems/measure/volume.hpp"

#include <catch2/catch.hpp>

#include <numeric>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Two particles of 1 kg and 3 kg.
void two_particles(World& world) {
  set_grid<2>(world, small_grid<2>());
  world.resize<Particles>(2);
  world.column<particle::Mass>()[0] = 1;
  world.column<particle::Mass>()[1] = 3;
  world.column<particle::Position<2>>()[0] = {2, 0};
  world.column<particle::Position<2>>()[1] = {3, -1};
  world.column<particle::Velocity<2>>()[0] = {3, 4};
  world.column<particle::Velocity<2>>()[1] = {0, -2};
  world.resource<BodyForce>().of_place_and_time = {Expression(0), Expression(-10)};
}

/// 2 x 2 particles in every cell.
void full_box(World& world, double density) {
  const Grid<2> grid = small_grid<2>();
  set_grid<2>(world, grid);
  const int across = 2 * grid.cells[0];
  world.resize<Particles>(static_cast<std::size_t>(across * 2 * grid.cells[1]));
  for (std::size_t p = 0; p < world.rows<Particles>(); ++p) {
    const auto i = static_cast<double>(p % static_cast<std::size_t>(across));
    const auto j = static_cast<double>(p / static_cast<std::size_t>(across));
    world.column<particle::Position<2>>()[p] = grid.low + grid.spacing / 4 * Vec<2>(2 * i + 1, 2 * j + 1);
    world.column<particle::Mass>()[p] = density * grid.spacing * grid.spacing / 4;
  }
  world.resource<Fluid>().density = density;
  set_volumes(world);
}

}  // namespace

TEST_CASE("energy is that of the particles, the floor of the box at zero", "[unit]") {
  World world;
  two_particles(world);
  run<MeasureEnergy<2>>(world);
  CHECK(world.resource<measure::Energy>().kinetic == 0.5 * 25 + 0.5 * 3 * 4);
  CHECK(world.resource<measure::Energy>().potential == 10 * 2 + 3 * 10 * 1);  // the floor is at y = -2
}

TEST_CASE("momentum is that of the particles, about their centre", "[unit]") {
  World world;
  two_particles(world);
  run<MeasureMomentum<2>>(world);
  CHECK(world.resource<measure::Momentum<2>>().linear == Vec<2>(3, -2));
  // Centre (2.75, -0.75): (-0.75, 0.75) x (3, 4) + 3 (0.25, -0.25) x (0, -2).
  CHECK(world.resource<measure::Momentum<2>>().angular[0] == -0.75 * 4 - 0.75 * 3 + 3 * 0.25 * -2);
}

TEST_CASE("a velocity gradient adds the spin of its support", "[unit]") {
  World world;
  two_particles(world);
  run<MeasureMomentum<2>>(world);
  const double without = world.resource<measure::Momentum<2>>().angular[0];
  // Both particles sit on inner nodes, where D = h^2/4; a rotation rate of 2 has dv/dx - du/dy = 4.
  for (Mat<2>& grad_v : world.column<particle::VelocityGradient<2>>()) grad_v << 0, -2, 2, 0;
  run<MeasureMomentum<2>>(world);
  const double spin = world.resource<measure::Momentum<2>>().angular[0] - without;
  CHECK(spin == Approx((1 + 3) * 0.25 / 4 * 4).epsilon(2e-15));  // a few roundings
}

TEMPLATE_TEST_CASE_SIG("angular momentum follows the right hand about every axis, clockwise and counter-clockwise",
                       "[unit]", ((int Dim), Dim), 2, 3) {
  const int axis = GENERATE(range(0, rotations<Dim>));
  const double rate = GENERATE(-2.0, 2.0);
  CAPTURE(axis, rate);
  World world;
  fill<Dim>(world, 200, 31);
  const RigidRotation<Dim> rotation{axis, rate};
  const auto m_p = world.column<particle::Mass>();
  const auto x_p = world.column<particle::Position<Dim>>();
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  std::copy(y_p.begin(), y_p.end(), x_p.begin());
  const Vec<Dim> centre =
      std::inner_product(m_p.begin(), m_p.end(), x_p.begin(), Vec<Dim>(Vec<Dim>::Zero()), std::plus<>(),
                         [](double m, const Vec<Dim>& x) { return Vec<Dim>(m * x); }) /
      std::accumulate(m_p.begin(), m_p.end(), 0.0);
  const auto [a, b] = turned_by<Dim>(axis);
  double of_velocities = 0;
  double of_gradients = 0;
  for (std::size_t p = 0; p < x_p.size(); ++p) {
    const Vec<Dim> r = x_p[p] - centre;
    world.column<particle::Velocity<Dim>>()[p] = rotation(r);
    world.column<particle::VelocityGradient<Dim>>()[p] = rotation.gradient();
    of_velocities += rate * m_p[p] * (r[a] * r[a] + r[b] * r[b]);
    const PlainWeights<Dim> weights(small_grid<Dim>(), x_p[p]);
    for (std::size_t i = 0; i < weights.value.size(); ++i) {
      const Vec<Dim> to_node = node_position<Dim>(small_grid<Dim>(), i) - x_p[p];
      of_gradients += rate * m_p[p] * weights.value[i] * (to_node[a] * to_node[a] + to_node[b] * to_node[b]);
    }
  }
  const auto& momentum = world.resource<measure::Momentum<Dim>>();
  make_system<MeasureMomentum<Dim>>("without").without({particle::VelocityGradient<Dim>::info.name}).run(world);
  CHECK(momentum.angular[axis] == Approx(of_velocities).epsilon(4e-15));  // 5e-16 measured
  run<MeasureMomentum<Dim>>(world);
  CHECK(momentum.angular[axis] == Approx(of_velocities + of_gradients).epsilon(4e-15));
}

TEST_CASE("the largest speed is that of the fastest particle", "[unit]") {
  World world;
  two_particles(world);
  run<MeasureMaxSpeed<2>>(world);
  CHECK(world.resource<measure::MaxSpeed>().value == 5);
}

TEST_CASE("overlap is what particles have beyond the volume of their nodes", "[unit]") {
  const double times = GENERATE(1.0, 2.0);
  CAPTURE(times);
  World world;
  full_box(world, 700);
  for (double& V : world.column<particle::Volume>()) V *= times;
  run<GatherNodeVolume<2>>(world);
  run<FindAdvectedCapacity<2>>(world);
  run<MeasureOverlap<2>>(world);
  // Per direction a lattice of 2 particles gives the nodes 17/32, 31/32, 1, ... of h; the integrals of their weights
  // are 13/24, 23/24, 1, ... of h.
  const auto axis = [](int node, int last, double wall, double second) {
    const int from_wall = std::min(node, last - node);
    return from_wall == 0 ? wall : from_wall == 1 ? second : 1;
  };
  double excess = 0;
  for (int i = 0; i <= 7; ++i) {
    for (int j = 0; j <= 5; ++j) {
      const double got = times * axis(i, 7, 17. / 32, 31. / 32) * axis(j, 5, 17. / 32, 31. / 32);
      excess += std::max(0.0, got - axis(i, 7, 13. / 24, 23. / 24) * axis(j, 5, 13. / 24, 23. / 24));
    }
  }
  // Volumes of 35 cells, a few roundings each.
  CHECK(std::abs(world.resource<measure::Overlap>().value - excess / (35 * times)) < 1e-15);
}

TEST_CASE("a rise of energy is what came after the lowest, over what there was to exchange", "[unit]") {
  EnergyWatch watch;
  watch.start(0, 60);
  watch.see(1, 58, 20, 38);
  watch.see(2, 60, 15, 45);  // 2 more
  watch.see(3, 40, 10, 30);
  watch.see(4, 41, 11, 30);
  CHECK(watch.rise == 2);
  CHECK(watch.time == 2);
  CHECK(watch.share(0) == Approx(2.0 / 30).epsilon(1e-15));  // U has gone from 60 to 30
}

TEST_CASE("rounding at rest is no rise of energy", "[unit]") {
  EnergyWatch watch;
  watch.start(0, 500);
  watch.see(1, 1e-13 + 500, 1e-13, 500);
  CHECK(watch.share(0.1) < 1e-11);
  EnergyWatch weightless;
  weightless.start(0, 0);
  CHECK(weightless.share(0) == 0);
  weightless.see(1, 1e-25, 1e-25, 0);
  CHECK(weightless.share(1e-9) < 1e-15);
}

TEST_CASE("a rise of energy is judged by what was exchanged, with bodies and openings, too", "[unit]") {
  EnergyWatch watch;
  watch.start(1, 0);
  watch.see(1, 1.5, 1, 0, {.exchanged = 40, .unresolved = 0});
  CHECK(watch.share(0) == Approx(0.5 / 40).epsilon(1e-15));
}

TEST_CASE("what the grid cannot tell of a surface is no rise of energy, what is more is one", "[unit]") {
  EnergyWatch watch;
  watch.start(0, 10);
  watch.see(1, 10.2, 0, 10.2, {.exchanged = 0, .unresolved = 0.3});
  CHECK(watch.share(0) == 0);
  watch.see(2, 10.5, 0.1, 10.4, {.exchanged = 0, .unresolved = 0.3});
  CHECK(watch.share(0) == Approx(0.2 / 0.4).epsilon(1e-13));
}
