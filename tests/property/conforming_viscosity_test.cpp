#include "support/extremes.hpp"
#include "support/factorizations.hpp"
#include "support/kernels.hpp"
#include "support/scene_run.hpp"

#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/viscosity/friction.hpp"
#include "systems/viscosity/solve_friction.hpp"

#include <catch2/catch.hpp>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

using namespace minamo;
using namespace minamo::scene_run;

// Compiled together with other tests, whose helpers have the same names.
namespace friction_test {
namespace {

/// A box of 6 cells of 0.3 m per axis, periodic along y.
template <int Dim>
Grid<Dim> box() {
  Grid<Dim> grid;
  grid.spacing = 0.3;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    grid.cells[axis] = 6;
    grid.periodic[axis] = d == 1;
    grid.low[d] = 0.1 * d;
    grid.high[d] = grid.low[d] + 6 * grid.spacing;
  }
  return grid;
}

/// A corner, the cell next to it, and one inside.
template <int Dim>
Index<Dim> cell_number(int number) {
  Index<Dim> cell;
  for (std::size_t d = 0; d < Dim; ++d) cell[d] = number == 0 ? 0 : number == 1 ? (d == 0 ? 1 : 5) : 3;
  return cell;
}

template <int Dim, int K>
Eigen::MatrixXd matrix_of(const Grid<Dim>& grid, const Splines<Dim>& splines, const Index<Dim>& cell) {
  constexpr auto n = static_cast<Eigen::Index>(cell_faces<Dim, K>);
  const FrictionMatrices<Dim> matrices(grid, splines);
  return Eigen::Map<const Eigen::MatrixXd>(matrices.of(splines, cell), n, n);
}

/// Values at the faces of a cell of an affine velocity, at their Greville points.
template <int Dim, int K, class Velocity>
Eigen::VectorXd at_faces(const CellFrame<Dim>& frame, const Velocity& velocity) {
  std::vector<double> values;
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
      Vec<Dim> x;
      for (int e = 0; e < Dim; ++e) {
        x[e] = frame.spacing * frame.template face_place<D>(e, offset[static_cast<std::size_t>(e)]);
      }
      values.push_back(velocity(x)[D]);
    });
  });
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Sum over Gauss points of 2 D(N_f):D(N_g).
template <int Dim, int K>
Eigen::MatrixXd by_quadrature(const CellFrame<Dim>& frame) {
  constexpr std::array<double, 4> at{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
  constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  constexpr auto n = static_cast<Eigen::Index>(cell_faces<Dim, K>);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t point = 0; point < power(4, Dim); ++point) {
    Vec<Dim> xi;
    double w = std::pow(frame.spacing, Dim);
    std::size_t rest = point;
    for (int d = 0; d < Dim; ++d, rest /= 4) {
      xi[d] = 0.5 + 0.5 * at[rest % 4];
      w *= 0.5 * weight[rest % 4];
    }
    const SplineWeights<Dim, K> weights(frame, xi);
    const SplineSlopes<Dim, K> slopes(frame, xi);
    std::vector<Mat<Dim>> strain;
    for_each_direction<Dim>([&](auto d) {
      constexpr int D = d();
      for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
        Mat<Dim> gradient = Mat<Dim>::Zero();
        for (int j = 0; j < Dim; ++j) {
          double product = 1;
          for (int e = 0; e < Dim; ++e) {
            const auto axis = static_cast<std::size_t>(e);
            const auto a = static_cast<std::size_t>(offset[axis]);
            if (e == j) {
              product *= e == D ? slopes.along[axis][a] : slopes.across[axis][a];
            } else {
              product *= e == D ? weights.along[axis][a] : weights.across[axis][a];
            }
          }
          gradient(D, j) = product;
        }
        strain.push_back(0.5 * (gradient + gradient.transpose()));
      });
    });
    for (Eigen::Index f = 0; f < n; ++f) {
      for (Eigen::Index g = 0; g < n; ++g) {
        sum(f, g) +=
            2 * w * strain[static_cast<std::size_t>(f)].cwiseProduct(strain[static_cast<std::size_t>(g)]).sum();
      }
    }
  }
  return sum;
}

template <int Dim, int K>
void check_matrices() {
  const Grid<Dim> grid = box<Dim>();
  const Splines<Dim> splines = make_splines(grid, K);
  const Index<Dim> cell = cell_number<Dim>(GENERATE(0, 1, 2));
  const CellFrame<Dim> frame(grid, splines, cell);
  const Eigen::MatrixXd matrix = matrix_of<Dim, K>(grid, splines, cell);
  // Some ten terms of size one each, with rounding of 1e-16.
  CHECK((matrix - by_quadrature<Dim, K>(frame)).norm() <= 1e-13 * matrix.norm());
  CHECK(matrix == matrix.transpose());

  const Eigen::VectorXd eigenvalues = dense::symmetric_eigenvalues(matrix);
  const double none = 1e-12 * eigenvalues.maxCoeff();
  CHECK(eigenvalues.minCoeff() >= -none);
  CHECK((eigenvalues.array() <= none).count() == Dim + rotations<Dim>);
  kernels::Random random(5);
  const Vec<Dim> v = random.vector<Dim>(-1, 1);
  const Mat<Dim> m = random.matrix<Dim>(-1, 1);
  const Mat<Dim> spin = m - m.transpose();
  const Eigen::VectorXd rigid = at_faces<Dim, K>(frame, [&](const Vec<Dim>& x) -> Vec<Dim> { return v + spin * x; });
  CHECK((matrix * rigid).norm() <= 1e-13 * matrix.norm() * rigid.norm());

  const FrictionMatrices<Dim> matrices(grid, splines);
  const Eigen::Map<const Eigen::VectorXd> bound(matrices.bounds_of(splines, cell), matrix.rows());
  const Eigen::VectorXd per_root = bound.array().rsqrt();
  const Eigen::MatrixXd scaled = per_root.asDiagonal() * matrix * per_root.asDiagonal();
  CHECK(dense::symmetric_eigenvalues(scaled).maxCoeff() <= 1 + 1e-12);
}

/// Liquid in a corner between slip and no-slip walls, scattered, a surface, and a far particle of 1/256 of a cell.
Json scattered(int dimension, int degree, double number) {
  Json scene = Json::parse(dimension == 2 ? R"json({
    "dimension": 2,
    "grid": {"low": [-1, 2], "high": [0.75, 3.5], "cells": [7, 6]},
    "walls": {"x": ["slip", "no_slip"], "y": "slip"},
    "body_force": [3, -9.81],
    "particles": [
      {"shape": {"box": {"low": [-1, 2], "high": [0.75, 2.5]}}, "per_cell": 3,
       "arrangement": "jittered", "seed": 3, "velocity": ["sin(3*x)*y", "x*x - y"]},
      {"shape": {"box": {"low": [0.11, 3.11], "high": [0.125, 3.125]}}, "per_cell": 16,
       "arrangement": "lattice", "velocity": [1, 2]}],
    "volume": {"scheme": "none"}, "solver": {"tolerance": 1e-12}, "time": {"end": 1, "step": 0.01}})json"
                                          : R"json({
    "dimension": 3,
    "grid": {"low": [-1, 2, 0], "high": [0, 3.25, 1], "cells": [4, 5, 4]},
    "walls": {"x": ["slip", "no_slip"], "y": "periodic", "z": ["no_slip", "slip"]},
    "body_force": [3, -9.81, 1],
    "particles": [
      {"shape": {"box": {"low": [-1, 2, 0], "high": [0, 2.5, 0.5]}}, "per_cell": 2,
       "arrangement": "jittered", "seed": 3, "velocity": ["sin(3*x)*y", "x*x - y", "z*x"]},
      {"shape": {"box": {"low": [-0.5, 2.76, 0.75], "high": [-0.484, 2.776, 0.766]}}, "per_cell": 16,
       "arrangement": "lattice", "velocity": [1, 2, 3]}],
    "volume": {"scheme": "none"}, "solver": {"tolerance": 1e-12}, "time": {"end": 1, "step": 0.01}})json");
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  constexpr double h = 0.25;
  scene["fluid"] = {{"density", 800}, {"viscosity", number * 800 * h * h / 0.01}};
  return scene;
}

/// The scene, and the same with a slip length of a tenth of a cell at the low side of x.
Json any_walls(Json scene) {
  if (!GENERATE(false, true)) return scene;
  scene["walls"]["x"] = {{{"slip_length", 0.025}}, "no_slip"};
  return scene;
}

/// The matrices of a step, put together face by face, number Dim i + d.
template <int Dim>
struct Dense {
  Eigen::MatrixXd friction, divergence;
  Eigen::VectorXd mobility;

  template <int K>
  void add_friction(World& world) {
    const auto& cells = world.resource<GridCells<Dim>>().cells;
    const auto& splines = world.resource<Splines<Dim>>();
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::uint32_t* rows = world.resource<CellSites>().of(c);
      const double* matrix = world.resource<FrictionMatrices<Dim>>().of(splines, cells[c].node);
      for_each_cell_face<Dim, K>([&](std::size_t f, std::size_t kf, Eigen::Index df) {
        for_each_cell_face<Dim, K>([&](std::size_t g, std::size_t kg, Eigen::Index dg) {
          friction(Dim * rows[kf] + df, Dim * rows[kg] + dg) +=
              world.column<cell::Viscosity>()[c] * matrix[f * cell_faces<Dim, K> + g];
        });
      });
    }
  }
  explicit Dense(World& world) {
    const auto of_unknown = world.column<unknown::Staggered>();
    const auto site = world.column<staggered::Site<Dim>>();
    const auto neighbour = world.column<staggered::Neighbour<Dim>>();
    const auto m = world.column<face::Mobility<Dim>>();
    const auto n = static_cast<Eigen::Index>(Dim * site.size());
    const Incidence<Dim> incidence(world.resource<Grid<Dim>>(), world.resource<Splines<Dim>>(), site, neighbour);
    friction = Eigen::MatrixXd::Zero(n, n);
    mobility.resize(n);
    divergence = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(of_unknown.size()), n);
    with_degree(world.resource<Splines<Dim>>().degree, [&](auto degree) { add_friction<degree()>(world); });
    for (std::size_t i = 0; i < site.size(); ++i) {
      for (int d = 0; d < Dim; ++d) mobility[static_cast<Eigen::Index>(Dim * i) + d] = m[i][d];
    }
    for (std::size_t l = 0; l < of_unknown.size(); ++l) {
      const std::size_t i = of_unknown[l];
      for (std::size_t d = 0; d < Dim; ++d) {
        const auto row = static_cast<Eigen::Index>(l);
        divergence(row, static_cast<Eigen::Index>(Dim * i + d)) -= incidence.per_width(i, d);
        divergence(row, static_cast<Eigen::Index>(Dim * incidence.above(i, d) + d)) += incidence.per_width(i, d);
      }
    }
  }
};

template <class C>
Eigen::VectorXd values(World& world) {
  const auto column = world.column<C>();
  constexpr auto dim = C::value_type::RowsAtCompileTime;
  Eigen::VectorXd all(static_cast<Eigen::Index>(dim * column.size()));
  for (std::size_t i = 0; i < column.size(); ++i) all.segment<dim>(static_cast<Eigen::Index>(dim * i)) = column[i];
  return all;
}

template <int Dim>
void check_balances(int degree) {
  const double number = GENERATE(0.1, 10.0, 1e3);
  CAPTURE(Dim, degree, number);
  SceneRun run(any_walls(scattered(Dim, degree, number)));
  run.step(2);
  World& world = run.world();
  const Dense<Dim> dense(world);
  const double tau = 0.005;
  const auto n = dense.friction.rows();
  const auto rows = dense.divergence.rows();
  // Faces that walls hold: v = 0.
  const Eigen::VectorXd is_free = (dense.mobility.array() > 0).template cast<double>();
  Eigen::MatrixXd a = is_free.asDiagonal() * dense.friction * is_free.asDiagonal();
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  const Eigen::VectorXd start = values<face::Predictor<Dim>>(world) + values<face::Damping<Dim>>(world);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double mass = is_free[i] > 0 ? 1 / (tau * dense.mobility[i]) : 0;
    a(i, i) += is_free[i] > 0 ? mass : 1;
    f[i] = mass * start[i];
  }
  const Eigen::MatrixXd b = dense.divergence * is_free.asDiagonal();
  // Scaled, so that all rows are of one size.
  const Eigen::VectorXd per_root = a.diagonal().array().rsqrt();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + rows, n + rows);
  whole.topLeftCorner(n, n) = per_root.asDiagonal() * a * per_root.asDiagonal();
  Eigen::MatrixXd coupling = b * per_root.asDiagonal();
  const Eigen::VectorXd per_length = coupling.rowwise().norm().array().inverse();
  coupling = per_length.asDiagonal() * coupling;
  whole.bottomLeftCorner(rows, n) = coupling;
  whole.topRightCorner(n, rows) = -coupling.transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n + rows);
  right.head(n) = per_root.cwiseProduct(f);
  const Eigen::VectorXd x = dense::solve(whole, right);
  const Eigen::VectorXd v = per_root.cwiseProduct(x.head(n));
  const Eigen::VectorXd computed = values<face::BalanceVelocity<Dim>>(world);
  const double largest = v.cwiseAbs().maxCoeff();
  CHECK((computed - v).cwiseAbs().maxCoeff() <= 1e-9 * largest);
  CHECK((b * computed).cwiseAbs().maxCoeff() <= 1e-9 * largest / 0.25);
  double off = 0;
  double size = 0;
  for (std::size_t l = 0; l < world.rows<Unknowns>(); ++l) {
    const auto row = static_cast<Eigen::Index>(l);
    const double lambda = per_length[row] * x[n + row];
    off = largest_of(off, std::abs(world.column<multiplier::Force>()[world.column<unknown::Staggered>()[l]] - lambda));
    size = largest_of(size, std::abs(lambda));
  }
  CHECK(off <= 1e-8 * size);
  CHECK(world.resource<SolveReport>().residual <= 1e-12);
  CHECK(world.resource<SolveReport>().iterations > 0);
}

/// Friction at the start of a step of a world that has made one.
template <int Dim>
void check_rubbing(int degree) {
  const double number = GENERATE(1e-6, 1e-2, 1.0, 1e3);
  CAPTURE(Dim, degree, number);
  SceneRun run(any_walls(scattered(Dim, degree, 1e-6)));
  run.step(2);
  World& world = run.world();
  world.resource<Fluid>().viscosity *= number / 1e-6;
  const auto predictor = world.column<face::Predictor<Dim>>();
  const auto v_f = world.column<face::Velocity<Dim>>();
  std::copy(v_f.begin(), v_f.end(), predictor.begin());
  kernels::run<FindCellViscosity<Dim>>(world);
  kernels::run<RubFaces<Dim>>(world);
  const Dense<Dim> dense(world);  // with theta_c in the viscosities
  const double tau = 0.005;
  const Eigen::VectorXd v = values<face::Velocity<Dim>>(world);
  const Eigen::VectorXd change = tau * dense.mobility.cwiseProduct(dense.friction * v);
  const Eigen::VectorXd computed = v - values<face::Predictor<Dim>>(world);
  CHECK((computed - change).norm() <= 1e-12 * (change.norm() + 1e-3 * v.norm()));
  const Eigen::VectorXd root = dense.mobility.cwiseSqrt();
  const Eigen::MatrixXd scaled = 2 * tau * root.asDiagonal() * dense.friction * root.asDiagonal();
  const Eigen::VectorXd eigenvalues = dense::symmetric_eigenvalues(scaled);
  CHECK(eigenvalues.minCoeff() >= -1e-12);
  CHECK(eigenvalues.maxCoeff() <= 1 + 1e-12);
}

double kinetic(World& world, int dimension) {
  const auto m_p = world.column<particle::Mass>();
  return dimension == 2 ? kinetic_energy<2>(m_p, world.column<particle::Velocity<2>>())
                        : kinetic_energy<3>(m_p, world.column<particle::Velocity<3>>());
}

/// A ball, or disc, in free flight that turns.
template <int Dim>
Json spinning(double number) {
  Json scene = Json::parse(Dim == 2 ? R"json({
    "dimension": 2, "grid": {"low": [-1, -1], "high": [1, 1], "cells": [16, 16]},
    "particles": [{"shape": {"ball": {"center": [0.03, 0.05], "radius": 0.5}}, "per_cell": 3,
                   "velocity": ["0.3 - 2*(y - 0.05)", "0.1 + 2*(x - 0.03)"]}],
    "volume": {"scheme": "none"}, "transfer": {"scheme": "apic"}, "time": {"end": 1, "step": 1e-3}})json"
                                    : R"json({
    "dimension": 3, "grid": {"low": [-1, -1, -1], "high": [1, 1, 1], "cells": [10, 10, 10]},
    "particles": [{"shape": {"ball": {"center": [0.03, 0.05, 0], "radius": 0.5}}, "per_cell": 2,
                   "velocity": ["0.3 - 2*(y - 0.05)", "0.1 + 2*(x - 0.03)", 0.2]}],
    "volume": {"scheme": "none"}, "transfer": {"scheme": "apic"}, "time": {"end": 1, "step": 1e-3}})json");
  const double h = Dim == 2 ? 0.125 : 0.2;
  scene["discretization"] = {{"scheme", "conforming"}};
  scene["quadrature"] = {{"scheme", "particles"}};  // mixed, momentum is that of full cells
  scene["solver"] = {{"tolerance", 1e-12}};
  scene["fluid"] = {{"density", 1000}, {"viscosity", number * 1000 * h * h / 1e-3}};
  return scene;
}

template <int Dim>
Vec<Dim> momentum(World& world) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t p = 0; p < world.rows<Particles>(); ++p) {
    sum += world.column<particle::Mass>()[p] * world.column<particle::Velocity<Dim>>()[p];
  }
  return sum;
}

template <int Dim>
double spin(World& world) {
  double sum = 0;
  for (std::size_t p = 0; p < world.rows<Particles>(); ++p) {
    const auto& x = world.column<particle::Position<Dim>>()[p];
    const auto& v = world.column<particle::Velocity<Dim>>()[p];
    sum += world.column<particle::Mass>()[p] * (x[0] * v[1] - x[1] * v[0]);
  }
  return sum;
}

template <int Dim>
void check_free_flight() {
  const double number = GENERATE(1e-3, 10.0, 1e3);
  CAPTURE(Dim, number);
  SceneRun with_friction(spinning<Dim>(number));
  SceneRun without(spinning<Dim>(0));
  with_friction.start();
  const Vec<Dim> before = momentum<Dim>(with_friction.world());
  with_friction.step(20);
  without.step(20);
  CHECK((momentum<Dim>(with_friction.world()) - before).norm() <= 1e-9 * before.norm());
  // The mixed mass and advection change the spin more than friction does.
  CHECK(spin<Dim>(with_friction.world()) == Approx(spin<Dim>(without.world())).epsilon(1e-3));
}

template <int Dim>
void set_random_velocities(World& world) {
  kernels::Random random(7);
  for (auto& v_p : world.column<particle::Velocity<Dim>>()) v_p = random.vector<Dim>(-0.1, 0.1);
  for (auto& gradient : world.column<particle::VelocityGradient<Dim>>()) gradient.setZero();
}

/// Before the step, but for what damping takes and what the corrected inertia does, and after it.
template <int Dim>
std::pair<double, double> energies_of_faces(World& world) {
  double before = 0;
  double now = 0;
  for (std::size_t i = 0; i < world.rows<Staggered>(); ++i) {
    const Vec<Dim> m = world.column<face::Mobility<Dim>>()[i].unaryExpr([](double a) { return a > 0 ? 1 / a : 0; });
    const Vec<Dim> old = world.column<face::Velocity<Dim>>()[i] + world.column<face::Damping<Dim>>()[i];
    const Vec<Dim> work =
        world.column<face::InertiaCorrection<Dim>>()[i].cwiseProduct(world.column<face::BalanceVelocity<Dim>>()[i]);
    before += m.dot(0.5 * old.cwiseAbs2() + world.resource<Clock>().step * work);
    now += 0.5 * m.dot(world.column<face::NewVelocity<Dim>>()[i].cwiseAbs2());
  }
  return {before, now};
}

Json without_force(int dimension, int degree, double number) {
  Json scene = scattered(dimension, degree, number);
  scene["body_force"] = std::vector<double>(static_cast<std::size_t>(dimension), 0.0);
  scene["solver"]["tolerance"] = 1e-8;
  scene["particles"][0].erase("velocity");  // or the accelerations at the start would be those of other velocities
  return scene;
}

std::map<std::string, std::vector<std::byte>> after(const Json& scene, int steps, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  return arena.execute([&] {
    SceneRun run(scene);
    run.step(steps);
    return state(run.world());
  });
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

TEST_CASE("friction of a cell is that of quadrature and takes rigid motions alone to zero", "[property]") {
  SECTION("in 2-D, degree 2") { check_matrices<2, 2>(); }
  SECTION("in 2-D, degree 3") { check_matrices<2, 3>(); }
  SECTION("in 3-D, degree 2") { check_matrices<3, 2>(); }
}

TEST_CASE("the balances with friction are solved as a dense solver does", "[property]") {
  SECTION("in 2-D, degree 2") { check_balances<2>(2); }
  SECTION("in 2-D, degree 3") { check_balances<2>(3); }
  SECTION("in 3-D, degree 2") { check_balances<3>(2); }
}

TEST_CASE("friction at the start of the step is m^-1 K v and takes no more than there is", "[property]") {
  SECTION("in 2-D, degree 2") { check_rubbing<2>(2); }
  SECTION("in 2-D, degree 3") { check_rubbing<2>(3); }
  SECTION("in 3-D, degree 2") { check_rubbing<3>(2); }
}

TEST_CASE("friction leaves a body in free flight its momentum and its spin", "[property]") {
  SECTION("in 2-D") { check_free_flight<2>(); }
  SECTION("in 3-D") { check_free_flight<3>(); }
}

TEST_CASE("friction in the balances lets energy of the faces never rise, whatever the viscosity", "[property]") {
  const auto [dimension, degree] = GENERATE(table<int, int>({{2, 2}, {2, 3}, {3, 2}}));
  const double number = GENERATE(2e-2, 1.0, 30.0, 1e3);
  CAPTURE(dimension, degree, number);
  SceneRun run(any_walls(without_force(dimension, degree, number)));
  run.start();
  dimension == 2 ? set_random_velocities<2>(run.world()) : set_random_velocities<3>(run.world());
  for (int step = 0; step < 20; ++step) {
    run.step();
    CAPTURE(step);
    const auto [before, now] = dimension == 2 ? energies_of_faces<2>(run.world()) : energies_of_faces<3>(run.world());
    CHECK(now <= before * (1 + 1e-7));
    CHECK(run.world().resource<SolveReport>().residual <= 1e-8);
  }
}

TEST_CASE("friction adds no energy, whatever the viscosity", "[property][long]") {
  const auto [dimension, degree] = GENERATE(table<int, int>({{2, 2}, {2, 3}, {3, 2}}));
  const std::string integrator = GENERATE("midpoint", "newmark");
  const Json walls = any_walls(without_force(dimension, degree, 0))["walls"];
  CAPTURE(dimension, degree, integrator, walls);
  const auto largest = [&, dimension = dimension, degree = degree](double number) {
    Json scene = without_force(dimension, degree, number);
    scene["integrator"] = {{"scheme", integrator}};
    scene["walls"] = walls;
    SceneRun run(scene);
    run.start();
    dimension == 2 ? set_random_velocities<2>(run.world()) : set_random_velocities<3>(run.world());
    double most = kinetic(run.world(), dimension);
    for (int step = 0; step < 20; ++step) {
      run.step();
      most = largest_of(most, kinetic(run.world(), dimension));
    }
    return most;
  };
  const double without = largest(0);
  const double number = GENERATE(1e-6, 1e-4, 9e-3, 2e-2, 1.0, 1e3);
  CAPTURE(number);
  CHECK(largest(number) <= without);
}

TEST_CASE("liquids that flow easily are rubbed, thick ones have friction in the balances", "[property]") {
  const auto names = [](double number) { return step_names(scattered(2, 2, number)); };
  CHECK_FALSE(has(names(0), "find_cell_viscosity"));
  CHECK_FALSE(has(names(0), "rub_faces"));
  CHECK_FALSE(has(names(0), "solve_friction"));
  CHECK(has(names(1e-3), "rub_faces"));
  CHECK_FALSE(has(names(1e-3), "solve_friction"));
  CHECK_FALSE(has(names(0.1), "rub_faces"));
  CHECK(has(names(0.1), "solve_friction"));
}

TEST_CASE("friction is the same to the last bit on one thread and on three", "[property]") {
  const int dimension = GENERATE(2, 3);
  const double number = GENERATE(1e-3, 10.0);
  CAPTURE(dimension, number);
  const Json scene = any_walls(scattered(dimension, 2, number));
  CHECK(after(scene, 4, 1) == after(scene, 4, 3));
}

TEST_CASE("a shear wave decays with exp(-nu k^2 t)", "[verification][long]") {
  // With degree 3 transfers damp more, in every step: 0.09 of the rate at 0.01.
  const auto [degree, number] = GENERATE(table<int, double>({{2, 0.01}, {2, 0.3}, {2, 3}, {3, 0.3}, {3, 3}}));
  CAPTURE(number, degree);
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [0.25, 1], "cells": [8, 32]},
    "walls": {"x": "periodic", "y": "periodic"}, "fluid": {"density": 1000, "viscosity": 1000},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.25, 1]}}, "per_cell": 3,
                   "velocity": ["0.1*sin(2*pi*y)", 0]}],
    "volume": {"scheme": "none"}, "time": {"end": 1}})json");
  const double step = number / 1024;
  scene["time"]["step"] = step;
  scene["discretization"] = {{"scheme", "conforming"}, {"degree", degree}};
  scene["transfer"] = {{"scheme", "apic"}};
  SceneRun run(scene);
  run.start();
  const double before = kinetic(run.world(), 2);
  const int steps = std::max(1, static_cast<int>(0.01 / step));
  run.step(steps);
  const double k = 2 * std::acos(-1.0);
  const double rate = std::log(before / kinetic(run.world(), 2)) / (2 * k * k * steps * step);
  CHECK(rate == Approx(1).epsilon(0.02));
}

}  // namespace friction_test
