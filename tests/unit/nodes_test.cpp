#include "support/kernels.hpp"

#include "systems/grid/activate.hpp"
#include "systems/grid/constraint.hpp"
#include "systems/grid/walls.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Rows that Activate gives to nodes of these masses.
std::vector<std::int32_t> rows_of(const std::vector<double>& masses, World& world) {
  world.resize<Nodes>(masses.size());
  std::copy(masses.begin(), masses.end(), world.column<node::Mass>().begin());
  run<Activate<2>>(world);
  const auto row = world.column<node::Row>();
  return {row.begin(), row.end()};
}

}  // namespace

TEST_CASE("nodes with more than 1e-4 of the mean mass of nodes with mass are active", "[unit]") {
  World world;
  // The mean over the four nodes with mass is 1 up to 1e-4.
  CHECK(rows_of({2, 0, 0.9e-4, 2, 1.1e-4, 0}, world) == std::vector<std::int32_t>{0, -1, -1, 1, 2, -1});
}

TEST_CASE("a node with hardly any mass is active next to a node of a wall that has some", "[unit]") {
  World world;
  set_grid<2>(world, small_grid<2>());
  const Grid<2>& grid = world.resource<Grid<2>>();
  std::vector<double> masses(grid.node_count(), 0);
  const auto at = [&](int i, int j) { return grid.row({i, j}); };
  for (const std::size_t heavy : {at(3, 0), at(0, 0), at(3, 3)}) masses[heavy] = 1;
  for (const std::size_t light : {at(3, 1), at(1, 1), at(4, 3), at(6, 3)}) masses[light] = 1e-12;
  const auto row = rows_of(masses, world);
  CHECK(row[at(3, 1)] >= 0);   // next to the floor
  CHECK(row[at(1, 1)] >= 0);   // in a corner
  CHECK(row[at(4, 3)] == -1);  // inside, where ballistic nodes are at the edge of a support
  CHECK(row[at(6, 3)] == -1);  // at a wall that is dry
}

TEST_CASE("a row of the matrix knows its node", "[unit]") {
  World world;
  rows_of({0, 1, 0, 1}, world);
  const auto node = world.column<matrix::Node>();
  CHECK(std::vector<std::uint32_t>(node.begin(), node.end()) == std::vector<std::uint32_t>{1, 3});
}

TEST_CASE("without mass no node is active", "[unit]") {
  World world;
  rows_of({0, 0}, world);
  CHECK(world.rows<ActiveNodes>() == 0);
}

TEST_CASE("a wall at rest holds the components that it fixes and no other", "[unit]") {
  World world;
  world.resize<Nodes>(4);
  const auto fixed = world.column<node::Constraint>();
  const auto v_i = world.column<node::Velocity<2>>();
  for (std::size_t i = 0; i < 4; ++i) {
    fixed[i] = static_cast<std::uint8_t>(i);
    v_i[i] = {1, 2};
  }
  run<ApplyWallCondition<2>>(world);
  CHECK(v_i[0] == Vec<2>(1, 2));
  CHECK(v_i[1] == Vec<2>(0, 2));
  CHECK(v_i[2] == Vec<2>(1, 0));
  CHECK(v_i[3] == Vec<2>(0, 0));
}

TEST_CASE("a wall that moves gives the held components its velocity and leaves the others alone", "[unit]") {
  World world;
  world.resize<Nodes>(4);
  const auto constraint = world.column<node::Constraint>();
  const auto v_i = world.column<node::Velocity<2>>();
  for (std::size_t i = 0; i < 4; ++i) {
    constraint[i] = static_cast<std::uint8_t>(i);
    v_i[i] = {1, 2};
    world.column<node::ConstraintVelocity<2>>()[i] = {0.3, -5};
  }
  run<ApplyWallCondition<2>>(world);
  CHECK(v_i[0] == Vec<2>(1, 2));
  CHECK(v_i[1] == Vec<2>(0.3, 2));
  CHECK(v_i[2] == Vec<2>(1, -5));
  CHECK(v_i[3] == Vec<2>(0.3, -5));
}

TEST_CASE("an oblique wall holds along its own axes", "[unit]") {
  const double angle = 0.4;
  const Vec<2> n(std::cos(angle), std::sin(angle));
  const Vec<2> t(-n[1], n[0]);
  Mat<2> axes;
  axes << n.transpose(), t.transpose();
  const std::vector<std::uint8_t> mask{0b01, 0b10, 0b11, 0};
  const std::vector<Mat<2>> frame(4, axes);
  const std::vector<Vec<2>> wall(4, Vec<2>(0.3, -5));
  const Vec<2> v(1, 2);
  const Constraints<2> constraints{mask, frame, wall};
  std::vector<Vec<2>> held(4, v);
  for (std::size_t i = 0; i < 4; ++i) hold<2>(constraints, i, held[i]);
  // Numbers of size 5, some roundings each.
  CHECK((held[0] - (n.dot(wall[0]) * n + t.dot(v) * t)).norm() < 1e-14);
  CHECK((held[1] - (n.dot(v) * n + t.dot(wall[0]) * t)).norm() < 1e-14);
  CHECK((held[2] - wall[0]).norm() < 1e-14);
  CHECK(held[3] == v);
  Vec<2> force = v;
  hold_at_rest<2>(constraints, 0, force);
  CHECK((force - t.dot(v) * t).norm() < 1e-15);
}

TEST_CASE("a displacement is held so that the velocity is the wall's", "[unit]") {
  const std::vector<std::uint8_t> mask{0b10};
  const std::vector<Vec<2>> wall{{0.3, -5}};
  const Vec<2> predicted(7, 1);
  Vec<2> u(1, 2);
  hold_displacement<2>({mask, {}, wall}, 0, 4, predicted, u);
  CHECK(u == Vec<2>(1, (-5. - 1) / 4));
  hold_displacement<2>({mask}, 0, 4, predicted, u);
  CHECK(u == Vec<2>(1, 0));
}

TEST_CASE("a wall holds the acceleration as it holds the velocity", "[unit]") {
  World world;
  world.resize<Nodes>(1);
  world.column<node::Constraint>()[0] = 0b101;
  world.column<node::Acceleration<3>>()[0] = {1, 2, 3};
  run<ApplyWallConditionAcceleration<3>>(world);
  CHECK(world.column<node::Acceleration<3>>()[0] == Vec<3>(0, 2, 0));
}
