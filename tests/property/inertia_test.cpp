#include "support/extremes.hpp"
#include "support/kernels.hpp"
#include "support/scenes.hpp"

#include "components/cells.hpp"
#include "components/fluid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "components/step.hpp"
#include "engine/run/clock.hpp"

using namespace minamo;
using namespace minamo::scene_run;

namespace {

/// A spinning lump of scattered particles, its side along a slip wall if `at_wall`.
template <int Dim>
Json lump(bool at_wall) {
  Json scene = Json::parse(R"json({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [10, 10]},
    "fluid": {"density": 700, "viscosity": 0.3}, "body_force": [0, -3],
    "particles": [{"shape": {"box": {"low": [0.3, 0.3], "high": [0.6, 0.5]}}, "per_cell": 2, "arrangement": "jittered",
                   "seed": 5, "velocity": ["-3*y + x*x", "3*x - y*y"]}],
    "transfer": {"scheme": "tpic"}, "integrator": {"scheme": "midpoint"}, "volume": {"scheme": "none"},
    "time": {"end": 1, "step": 0.004}})json");
  if (at_wall) scene["particles"][0]["shape"] = Json::parse(R"({"box": {"low": [0, 0.3], "high": [0.3, 0.5]}})");
  if constexpr (Dim == 3) {
    scene["dimension"] = 3;
    scene["grid"] = Json::parse(R"({"low": [0, 0, 0], "high": [1, 1, 0.8], "cells": [10, 10, 8]})");
    scene["body_force"] = Json({0, -3, 1});
    auto& particles = scene["particles"][0];
    particles["velocity"] = Json({"-3*y + x*x", "3*x - y*y", "z*x"});
    particles["shape"]["box"]["low"].push_back(0.3);
    particles["shape"]["box"]["high"].push_back(0.5);
  }
  return of_equal_order(scene);
}

/// q_p in the rows that the particles have now, from a list in the order of ids.
template <class T>
std::vector<T> in_rows(World& world, const std::vector<T>& by_id) {
  std::vector<T> rows;
  for (const std::int64_t id : world.column<particle::Id>()) rows.push_back(by_id[static_cast<std::size_t>(id)]);
  return rows;
}

/// Mean over the particles of every dual cell, weighted with mass.
template <int Dim>
std::vector<Mat<Dim>> cell_means(World& world, const std::vector<Mat<Dim>>& q_p) {
  std::vector<Mat<Dim>> means(q_p.size());
  const auto m_p = world.column<particle::Mass>();
  for (const auto& cell : world.resource<OccupiedCells<Dim>>().cells) {
    Mat<Dim> sum = Mat<Dim>::Zero();
    double mass = 0;
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      sum += m_p[p] * q_p[p];
      mass += m_p[p];
    }
    for (std::size_t p = cell.begin; p < cell.end; ++p) means[p] = sum / mass;
  }
  return means;
}

/// w_c of (E53) at a point: how full the nearest node and those next to it are, zero up to 0.3, one from 0.5 on.
template <int Dim>
double share_at(World& world, const std::vector<double>& m_i, const Vec<Dim>& y) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  double mass = 0;
  double volume = 0;
  for (std::size_t i = 0; i < m_i.size(); ++i) {
    const Index<Dim> node = grid.index(i);
    double of_node = 1;
    bool in_support = true;
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      const int last = grid.cells[axis];
      const int own = static_cast<int>(std::lround((y[d] - grid.low[d]) / grid.spacing));
      const int middle = std::clamp(own, 1, last - 1);  // three nodes at a wall, too
      in_support = in_support && std::abs(node[axis] - middle) <= 1;
      const int from_wall = std::min(node[axis], last - node[axis]);
      of_node *= grid.spacing * (from_wall == 0 ? 13.0 / 24 : from_wall == 1 ? 23.0 / 24 : 1);
    }
    mass += in_support ? m_i[i] : 0;
    volume += in_support ? of_node : 0;
  }
  return std::clamp(5 * mass / (world.resource<Fluid>().density * volume) - 1.5, 0.0, 1.0);
}

/// m_I c_I of (E53) by a plain loop over particles and nodes.
template <int Dim>
std::vector<Vec<Dim>> first_moment(World& world, const std::vector<Mat<Dim>>& gradient) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const auto m_i = kernels::on_grid<Dim, node::Mass>(world);
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto m_p = world.column<particle::Mass>();
  std::vector<Vec<Dim>> sum(grid.node_count(), Vec<Dim>(Vec<Dim>::Zero()));
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    const kernels::PlainWeights<Dim> w(grid, y_p[p]);
    const double share = share_at<Dim>(world, m_i, y_p[p]);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += share * w.value[i] * m_p[p] * (gradient[p] * (grid.position(grid.index(i)) - y_p[p]));
    }
  }
  return sum;
}

/// grad f_p of (E54) by a plain loop, before the mean.
template <int Dim>
std::vector<Mat<Dim>> force_gradient(World& world) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const double dt = world.resource<Clock>().step;
  const auto y_p = world.column<particle::QuadraturePosition<Dim>>();
  const auto v_old = kernels::on_grid<Dim, node::Velocity<Dim>>(world);
  const auto v_new = kernels::on_grid<Dim, node::NewVelocity<Dim>>(world);
  const auto c_i = kernels::on_grid<Dim, node::InertiaCorrection<Dim>>(world);
  std::vector<Mat<Dim>> gradient(y_p.size(), Mat<Dim>(Mat<Dim>::Zero()));
  for (std::size_t p = 0; p < y_p.size(); ++p) {
    const kernels::PlainWeights<Dim> w(grid, y_p[p]);
    for (std::size_t i = 0; i < v_new.size(); ++i) {
      const Vec<Dim> f = (v_new[i] - v_old[i]) / dt - c_i[i];
      gradient[p] += f * w.gradient[i].transpose();
    }
  }
  return gradient;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the inertia correction is the first moment of the forces of the step before", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const bool at_wall = GENERATE(false, true);
  CAPTURE(at_wall);
  SceneRun run(lump<Dim>(at_wall));
  World& world = run.world();
  run.step(2);
  const auto before = by_id<particle::ForceGradient<Dim>>(world);
  run.step();
  const auto expected = first_moment<Dim>(world, cell_means<Dim>(world, in_rows(world, before)));
  const auto c_i = kernels::on_grid<Dim, node::InertiaCorrection<Dim>>(world);
  const auto m_i = kernels::on_grid<Dim, node::Mass>(world);
  const auto row = kernels::on_grid<Dim, node::Row>(world, -1);
  const auto fixed = kernels::on_grid<Dim, node::Constraint>(world);
  Largest worst;
  Largest largest;
  std::size_t held = 0;
  for (std::size_t i = 0; i < c_i.size(); ++i) {
    for (int d = 0; d < Dim; ++d) {
      const bool free = row[i] >= 0 && (fixed[i] >> d & 1) == 0;
      held += row[i] >= 0 && !free;
      worst.add(std::abs(m_i[i] * c_i[i][d] - (free ? expected[i][d] : 0)));
      largest.add(std::abs(expected[i][d]));
    }
  }
  CHECK((held > 0) == at_wall);
  // Moments whose coefficients cancel: 4e-15 measured.
  CHECK(worst.value() < 3e-14 * largest.value());
}

TEST_CASE("forces of a short step count in a long one only for as long as they acted", "[property]") {
  const double ratio = GENERATE(0.25, 1.0, 4.0);
  CAPTURE(ratio);
  SceneRun even(lump<2>(true));
  SceneRun uneven(lump<2>(true));
  even.step(2);
  uneven.step(2);
  uneven.world().resource<ForceStep>().seconds *= ratio;
  even.step();
  uneven.step();
  const auto c_i = even.world().column<node::InertiaCorrection<2>>();
  const auto c_uneven = uneven.world().column<node::InertiaCorrection<2>>();
  REQUIRE(c_i.size() == c_uneven.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < c_i.size(); ++i) wrong += c_uneven[i] != Vec<2>(std::min(1.0, ratio) * c_i[i]);
  CHECK(wrong == 0);  // powers of two leave nothing to round
}

TEMPLATE_TEST_CASE_SIG("the force gradient is that of force over lumped mass", "[property]", ((int Dim), Dim), 2, 3) {
  const bool at_wall = GENERATE(false, true);
  CAPTURE(at_wall);
  SceneRun run(lump<Dim>(at_wall));
  World& world = run.world();
  run.step(2);
  const auto expected = cell_means<Dim>(world, force_gradient<Dim>(world));
  const auto got = world.template column<particle::ForceGradient<Dim>>();
  Largest worst;
  Largest largest;
  for (std::size_t p = 0; p < got.size(); ++p) {
    worst.add((got[p] - expected[p]).norm());
    largest.add(expected[p].norm());
  }
  // Sums of 27 differences of velocities over a step: 1.2e-15 measured.
  CHECK(worst.value() < 1e-14 * largest.value());
}

TEMPLATE_TEST_CASE_SIG("the inertia correction keeps momentum", "[property]", ((int Dim), Dim), 2, 3) {
  // A lattice has no ballistic nodes in 2-D.
  Json scene = lump<Dim>(false);
  scene["particles"][0].erase("arrangement");
  scene["particles"][0].erase("seed");
  SceneRun run(scene);
  run.step();
  const auto c_i = run.world().template column<node::InertiaCorrection<Dim>>();
  const auto m_i = run.world().template column<node::Mass>();
  const auto row = run.world().template column<node::Row>();
  Vec<Dim> sum = Vec<Dim>::Zero();
  double size = 0;
  bool light = false;
  for (std::size_t i = 0; i < c_i.size(); ++i) {
    light = light || (m_i[i] > 0 && row[i] < 0);
    sum += m_i[i] * c_i[i];
    size += m_i[i] * c_i[i].norm();
  }
  REQUIRE(size > 0);
  // Ballistic nodes, below 1e-4 of the mean mass, have no correction; their share of the sum is left.
  CHECK(sum.norm() < (light ? 1e-4 : 1e-14) * size);
}

TEST_CASE("the force gradient of a lone particle does not feed on itself", "[property]") {
  SceneRun run(with(lump<2>(false), {R"(/particles/0/shape={"box": {"low": [0.3, 0.3], "high": [0.4, 0.4]}})",
                                     "/particles/0/per_cell=1", R"(/particles/0/velocity=["-3*y", "3*x"])"}));
  run.start();
  const auto gradient = run.world().column<particle::ForceGradient<2>>();
  REQUIRE(gradient.size() == 1);
  gradient[0] << 1, 2, 3, -1;
  run.step();
  // Only gravity acts on it: what is left of 4 is what the solver leaves of it, 4e-11. With c in (E54) all would stay.
  CHECK(gradient[0].norm() < 3e-10);
}

TEST_CASE("velocity gradients do not grow in spray", "[property][long]") {
  // The front meets the far wall at 0.3 s and sprays up to 0.5 s.
  SceneRun run(with(scene_of_file("paper/dam_break_tpic.json"),
                    {"/grid/cells=[80, 80]", "/time/step=4e-3", R"(/integrator={"scheme": "midpoint"})",
                     R"(/volume={"scheme": "projection"})", R"(/transfer={"scheme": "tpic"})"}));
  const double h = run.world().resource<Grid<2>>().spacing;
  Largest largest;
  for (int k = 0; k < 125; ++k) {
    run.step();
    for (const Mat<2>& gradient : run.world().column<particle::VelocityGradient<2>>()) {
      largest.add(h * gradient.norm());
    }
  }
  // 4.5 m/s were measured, about the speed of the front. Corrected wherever there is mass, a node moves by 137
  // cells at 0.41 s, which is no step to be accepted.
  CHECK(largest.value() < 9);
}
