#include "support/scene_run.hpp"

#include "components/friction.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"
#include "systems/viscosity/friction_operator.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;
using namespace minamo::scene_run;

// Compiled together with other tests, whose helpers have the same names.
namespace slip_length_test {
namespace {

/// A box with a slip length at the low side of x and the high side of y; cells of 0.3 m.
template <int Dim>
Grid<Dim> box() {
  Grid<Dim> grid;
  grid.spacing = 0.3;
  for (int d = 0; d < Dim; ++d) {
    grid.cells[static_cast<std::size_t>(d)] = 6;
    grid.high[d] = 6 * grid.spacing;
  }
  return grid;
}
template <int Dim>
Walls<Dim> rough() {
  Walls<Dim> walls;
  walls.per_slip_length[0] = {4, 0};
  walls.per_slip_length[1] = {0, 7};
  return walls;
}

/// Integral of N_f N_g/b over one side of a cell by three Gauss points per axis, exact for these degrees.
template <int Dim, int K>
Eigen::MatrixXd by_quadrature(const CellFrame<Dim>& frame, std::size_t axis, std::size_t end, double per_length) {
  constexpr std::array<double, 4> at{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  constexpr auto n = static_cast<Eigen::Index>(cell_faces<Dim, K>);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t point = 0; point < power(4, Dim - 1); ++point) {
    Vec<Dim> xi;
    double w = per_length * std::pow(frame.spacing, Dim - 1);
    std::size_t rest = point;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (d == axis) {
        xi[static_cast<Eigen::Index>(d)] = static_cast<double>(end);
        continue;
      }
      xi[static_cast<Eigen::Index>(d)] = 0.5 + 0.5 * at[rest % 4];
      w *= 0.5 * weight[rest % 4];
      rest /= 4;
    }
    const SplineWeights<Dim, K> weights(frame, xi);
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, Dim);
    Eigen::Index f = 0;
    for_each_direction<Dim>([&](auto d) {
      constexpr int D = d();
      for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
        values(f++, D) = D == static_cast<int>(axis) ? 0 : weights.template face<D>(offset);
      });
    });
    sum += w * values * values.transpose();
  }
  return sum;
}

template <int Dim, int K>
void check_matrices() {
  const Grid<Dim> grid = box<Dim>();
  const Splines<Dim> splines = make_splines(grid, K);
  const Walls<Dim> walls = rough<Dim>();
  const FrictionMatrices<Dim> smooth(grid, splines);
  const FrictionMatrices<Dim> with_walls(grid, splines, walls);
  constexpr auto n = static_cast<Eigen::Index>(cell_faces<Dim, K>);
  const int x = GENERATE(0, 1, 5);
  const int y = GENERATE(0, 4, 5);
  CAPTURE(Dim, K, x, y);
  Index<Dim> cell{};
  cell[0] = x;
  cell[1] = y;
  const CellFrame<Dim> frame(grid, splines, cell);
  Eigen::MatrixXd expected = Eigen::Map<const Eigen::MatrixXd>(smooth.of(splines, cell), n, n);
  if (x == 0) expected += by_quadrature<Dim, K>(frame, 0, 0, walls.per_slip_length[0][0]);
  if (y == 5) expected += by_quadrature<Dim, K>(frame, 1, 1, walls.per_slip_length[1][1]);
  const Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(with_walls.of(splines, cell), n, n);
  CHECK((matrix - expected).norm() <= 1e-13 * expected.norm());
  CHECK(matrix == matrix.transpose());
  const Eigen::Map<const Eigen::VectorXd> bound(with_walls.bounds_of(splines, cell), n);
  CHECK((bound - matrix.cwiseAbs().rowwise().sum()).norm() <= 1e-13 * bound.norm());
}

/// A channel full of liquid, periodic along its walls.
Json channel(int dimension, int degree, double viscosity, const Json& low, const Json& high) {
  Json scene = Json::parse(dimension == 2 ? R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [6, 6]},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 1]}}, "per_cell": 2,
                   "velocity": ["1 + 0.3*y*y", 0]}],
    "volume": {"scheme": "none"}, "time": {"end": 1, "step": 0.01}})json"
                                          : R"json({
    "dimension": 3, "grid": {"low": [0, 0, 0], "high": [1, 1, 1], "cells": [5, 5, 5]},
    "particles": [{"shape": {"box": {"low": [0, 0, 0], "high": [1, 1, 1]}}, "per_cell": 2,
                   "velocity": ["1 + 0.3*y*y", 0, "0.5 - 0.2*y"]}],
    "volume": {"scheme": "none"}, "time": {"end": 1, "step": 0.01}})json");
  scene["walls"] = {{"x", "periodic"}, {"y", {low, high}}};
  if (dimension == 3) scene["walls"]["z"] = "periodic";
  scene["fluid"] = {{"density", 1000}, {"viscosity", viscosity}};
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  scene["solver"] = {{"tolerance", 1e-12}};
  scene["transfer"] = {{"scheme", "tpic"}, {"inertia", "lumped"}};
  scene["integrator"] = {{"scheme", "midpoint"}};
  return scene;
}

/// v . K v of the velocity in the balances, with friction matrices of one's choice.
template <int Dim>
double dissipation(World& world, const FrictionMatrices<Dim>& matrices) {
  const auto v_f = world.column<face::BalanceVelocity<Dim>>();
  std::vector<Vec<Dim>> force(v_f.size(), Vec<Dim>::Zero());
  apply_friction<Dim>({world.resource<Splines<Dim>>(), matrices, world.resource<GridCells<Dim>>(),
                       world.resource<CellSites>(), world.column<cell::Viscosity>()},
                      v_f.front().data(), force.front().data());
  double sum = 0;
  for (std::size_t i = 0; i < v_f.size(); ++i) sum += v_f[i].dot(force[i]);
  return sum;
}

/// Kinetic energy of the faces by the mass of the balances.
template <int Dim, class Velocity>
double energy(World& world) {
  double sum = 0;
  for (std::size_t i = 0; i < world.rows<Staggered>(); ++i) {
    const Vec<Dim> m = world.column<face::Mobility<Dim>>()[i].unaryExpr(
        [](double per_mass) { return per_mass > 0 ? 1 / per_mass : 0; });
    sum += 0.5 * m.dot(world.column<Velocity>()[i].cwiseAbs2());
  }
  return sum;
}

template <int Dim>
void check_energy(int degree) {
  const double viscosity = GENERATE(30.0, 3e3);
  CAPTURE(Dim, degree, viscosity);
  SceneRun run(channel(Dim, degree, viscosity, {{"slip_length", 0.05}}, {{"slip_length", 0.2}}));
  run.step(1);
  World& world = run.world();
  const auto& grid = world.resource<Grid<Dim>>();
  const auto& splines = world.resource<Splines<Dim>>();
  const double all = dissipation<Dim>(world, world.resource<FrictionMatrices<Dim>>());
  const double inside = dissipation<Dim>(world, FrictionMatrices<Dim>(grid, splines));
  // What the walls take is mu v^2/b over walls of 1 m^(d-1), along which the flow is the same everywhere.
  double at_walls = 0;
  for (std::size_t i = 0; i < world.rows<Staggered>(); ++i) {
    const auto& site = world.column<staggered::Site<Dim>>()[i];
    if (site[0] != 0 || site[Dim - 1] != 0) {
      if (Dim == 3 || site[0] != 0) continue;
    }
    const Vec<Dim> v = world.column<face::BalanceVelocity<Dim>>()[i];
    const double square = v.squaredNorm() - v[1] * v[1];
    if (site[1] == 0) at_walls += viscosity * square / 0.05;
    if (site[1] == splines.axis[1].multipliers() - 1) at_walls += viscosity * square / 0.2;
  }
  CHECK(all - inside == Approx(at_walls).epsilon(1e-9));
  const double lost = energy<Dim, face::Velocity<Dim>>(world) - energy<Dim, face::NewVelocity<Dim>>(world);
  CHECK(lost == Approx(all * world.resource<Clock>().step).epsilon(1e-9));
  CHECK(at_walls > 0.1 * all);
}

/// Momentum along the wall after five steps from a velocity that vanishes at the floor.
double momentum_over(const Json& floor, const std::string& integrator) {
  Json scene = channel(2, 2, 100, floor, "slip");
  scene["particles"][0]["velocity"] = {"y - 0.5*y*y", 0};
  scene["integrator"] = {{"scheme", integrator}};
  SceneRun run(scene);
  run.step(5);
  double sum = 0;
  for (const Vec<2>& v : run.world().column<particle::Velocity<2>>()) sum += v[0];
  return sum;
}

bool has(const Json& scene, const std::string& system) {
  const auto names = step_names(scene);
  return std::find(names.begin(), names.end(), system) != names.end();
}

}  // namespace

TEST_CASE("the friction of a cell at a wall has that of the wall, as by quadrature", "[property]") {
  SECTION("in 2-D, degree 2") { check_matrices<2, 2>(); }
  SECTION("in 2-D, degree 3") { check_matrices<2, 3>(); }
  SECTION("in 3-D, degree 2") { check_matrices<3, 2>(); }
}

TEST_CASE("a step loses the energy that viscosity and walls take", "[property]") {
  SECTION("in 2-D, degree 2") { check_energy<2>(2); }
  SECTION("in 2-D, degree 3") { check_energy<2>(3); }
  SECTION("in 3-D, degree 2") { check_energy<3>(2); }
}

TEST_CASE("short slip lengths tend to no-slip walls, long ones to slip walls", "[property]") {
  const auto off = [](double length, const Json& from, const std::string& integrator) {
    return momentum_over({{"slip_length", length}}, integrator) / momentum_over(from, integrator) - 1;
  };
  CHECK(off(1e-4, "no_slip", "newmark") == Approx(3.6e-5).epsilon(0.1));
  CHECK(off(1e-6, "no_slip", "newmark") == Approx(3.7e-7).epsilon(0.1));
  // The midpoint rule turns what the transfer brings to the wall around in every step: 6.5e-4.
  CHECK(std::abs(off(1e-6, "no_slip", "midpoint")) < 1e-3);
  for (const std::string integrator : {"newmark", "midpoint"}) {
    CHECK(std::abs(off(1e6, "slip", integrator)) < 1e-6);
    CHECK(off(1e6, "slip", integrator) == Approx(off(1e4, "slip", integrator) / 100).epsilon(0.1));
  }
}

TEST_CASE("a wall with a short slip length has friction in the balances", "[property]") {
  const auto of_length = [](double length) { return channel(2, 2, 0.1, {{"slip_length", length}}, "slip"); };
  CHECK(has(of_length(1), "rub_faces"));
  CHECK(has(of_length(1e-3), "rub_faces"));
  CHECK_FALSE(has(of_length(1e-5), "rub_faces"));
  CHECK(has(of_length(1e-5), "solve_friction"));
}

}  // namespace slip_length_test
