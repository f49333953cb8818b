#include "support/extremes.hpp"
#include "support/folder.hpp"
#include "support/shape_checks.hpp"
#include "support/solids.hpp"

#include "systems/shapes/combination.hpp"
#include "systems/shapes/grid_distance.hpp"
#include "systems/shapes/mesh.hpp"
#include "systems/shapes/primitives.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace minamo;
using namespace minamo::shape_checks;
using shapes::Triangles;

namespace {

shapes::Mesh mesh_of(const Triangles& triangles) {
  return shapes::Mesh(shapes::close_surface(triangles, 1, Vec<3>::Zero()));
}

/// What is said of triangles that bound no solid.
std::string problem_of(const Triangles& triangles) {
  try {
    shapes::close_surface(triangles, 1, Vec<3>::Zero());
  } catch (const shapes::MeshError& error) {
    return std::string(error.what()) + ": " + error.got;
  }
  return "none";
}

/// What is said of a file with this content.
std::string problem_of(const std::string& name, const std::string& content) {
  const Folder folder;
  std::ofstream(folder / name, std::ios::binary) << content;
  try {
    shapes::read_mesh(folder / name);
  } catch (const shapes::MeshError& error) {
    return std::string(error.what()) + ": " + error.got;
  }
  return "none";
}

double farthest_apart(const Shape<3>& a, const Shape<3>& b, const Bounds<3>& where) {
  std::mt19937_64 random(7);
  Largest largest;
  for (int k = 0; k < 2000; ++k) {
    const Vec<3> x = random_point<3>(where, random);
    largest.add(std::abs(a.distance(x) - b.distance(x)));
  }
  return largest.value();
}

double distance_to_segment(const Vec<3>& a, const Vec<3>& b, const Vec<3>& x) {
  const double part = std::clamp((b - a).dot(x - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - part * (b - a)).norm();
}

double distance_to_triangle(const std::array<Vec<3>, 3>& corner, const Vec<3>& x) {
  const Vec<3> normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  bool is_above = true;
  Smallest to_edges;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec<3>&from = corner[k], &to = corner[(k + 1) % 3];
    is_above = is_above && (to - from).cross(x - from).dot(normal) >= 0;
    to_edges.add(distance_to_segment(from, to, x));
  }
  return is_above ? std::abs(normal.dot(x - corner[0])) / normal.norm() : to_edges.value();
}

}  // namespace

TEST_CASE("a mesh of a box is the box", "[unit]") {
  const shapes::Box<3> box({0, 1, 2}, {2, 4, 3});
  const shapes::Mesh mesh = mesh_of(solids::box({0, 1, 2}, {2, 4, 3}));
  CHECK(mesh.surface().volume == Approx(6));
  CHECK(mesh.surface().edge_normal.size() == 18);
  CHECK(mesh.bounds().low == Vec<3>(0, 1, 2));
  CHECK(mesh.bounds().high == Vec<3>(2, 4, 3));
  CHECK(farthest_apart(mesh, box, around<3>(box.bounds())) < 1e-14);
  check_euclidean<3>(mesh, around<3>(box.bounds()));
  // On the surface, at a corner, an edge and a face.
  CHECK((mesh.gradient({0, 1, 2}) - Vec<3>(-1, -1, -1).normalized()).norm() < 1e-14);
  CHECK((mesh.gradient({1, 1, 2}) - Vec<3>(0, -1, -1).normalized()).norm() < 1e-14);
  CHECK(mesh.gradient({1, 1, 2.3}) == Vec<3>(0, -1, 0));
}

TEST_CASE("every kind of file holds the same solid", "[unit]") {
  const Folder folder;
  const Triangles box = solids::box({0, 1, 2}, {2, 4, 3.5});
  solids::write_binary_stl(folder / "binary.stl", box);
  solids::write_text_stl(folder / "text.STL", box);
  solids::write_obj(folder / "box.obj", box);
  std::ofstream(folder / "quads.obj")
      << "v 0 1 2\nv 2 1 2\nv 0 4 2\nv 2 4 2\nv 0 1 3.5\nv 2 1 3.5\nv 0 4 3.5\nv 2 4 3.5"
         "\nf 1 3 4 2\nf 5 6 8 7\nf -8 2/7 6/1/2 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6 # last";
  const shapes::Box<3> moved({1, 12, 26}, {21, 42, 41});
  for (const std::string name : {"binary.stl", "text.STL", "box.obj", "quads.obj"}) {
    CAPTURE(name);
    const shapes::Mesh mesh(shapes::close_surface(shapes::read_mesh(folder / name), 10, {1, 2, 6}));
    CHECK(mesh.surface().corner.size() == 8);
    CHECK(farthest_apart(mesh, moved, around<3>(moved.bounds())) < 1e-12);
  }
}

TEST_CASE("a mesh of a ball comes near to the ball with the square of its edges", "[unit]") {
  const shapes::Ball<3> ball({0, 0, 0}, 1);
  const Bounds<3> where{Vec<3>(-1.5, -1.5, -1.5), Vec<3>(1.5, 1.5, 1.5)};
  const double coarse = farthest_apart(mesh_of(solids::ball(2)), ball, where);
  const double fine = farthest_apart(mesh_of(solids::ball(4)), ball, where);
  CHECK(coarse < 0.04);
  CHECK(fine < coarse / 12);  // 16
  check_euclidean<3>(mesh_of(solids::ball(2)), where);
}

TEST_CASE("the nearest triangle is that of all, near a mesh and far from it", "[unit]") {
  Triangles shell = solids::ball(2);
  const std::size_t outer = shell.triangle.size();
  for (std::size_t k = shell.corner.size(); k-- > 0;) shell.corner.push_back(0.9 * shell.corner[k]);
  const std::size_t last = shell.corner.size() - 1;
  for (std::size_t t = 0; t < outer; ++t) {
    const auto [a, b, c] = shell.triangle[t];
    shell.triangle.push_back({static_cast<std::uint32_t>(last - a), static_cast<std::uint32_t>(last - c),
                              static_cast<std::uint32_t>(last - b)});
  }
  const shapes::Mesh mesh = mesh_of(shell);
  std::mt19937_64 random(3);
  for (int k = 0; k < 300; ++k) {
    const Vec<3> x = random_point<3>({Vec<3>(-2, -2, -2), Vec<3>(2, 2, 2)}, random);
    Smallest nearest;
    for (const auto& [a, b, c] : shell.triangle)
      nearest.add(distance_to_triangle({shell.corner[a], shell.corner[b], shell.corner[c]}, x));
    CHECK(std::abs(mesh.distance(x)) == Approx(nearest.value()).epsilon(0).margin(1e-14));
  }
}

TEST_CASE("a solid may be hollow, and may turn inward as a whole", "[unit]") {
  Triangles shell = solids::box({0, 0, 0}, {4, 4, 4});
  const Triangles inner = solids::box({1, 1, 1}, {2, 2, 3});
  for (const Vec<3>& x : inner.corner) shell.corner.push_back(x);
  for (const auto& [a, b, c] : inner.triangle) shell.triangle.push_back({a + 8, c + 8, b + 8});
  Triangles turned = shell;
  for (auto& corners : turned.triangle) std::swap(corners[0], corners[1]);
  const auto expected = shapes::difference<3>({std::make_shared<shapes::Box<3>>(Vec<3>(0, 0, 0), Vec<3>(4, 4, 4)),
                                               std::make_shared<shapes::Box<3>>(Vec<3>(1, 1, 1), Vec<3>(2, 2, 3))});
  const Bounds<3> where = around<3>(expected->bounds());
  CHECK(mesh_of(shell).surface().volume == Approx(62));
  CHECK(farthest_apart(mesh_of(shell), mesh_of(turned), where) == 0);
  CHECK(measure<3>(mesh_of(turned), where, 40) == measure<3>(*expected, where, 40));
}

TEST_CASE("triangles that bound no solid are told why", "[unit]") {
  const Triangles box = solids::box({0, 0, 0}, {1, 1, 1});
  Triangles open = box;
  open.triangle.pop_back();
  CHECK(problem_of(open) ==
        "the surface is not closed: one triangle at 3 edges, the first from [1, 0, 1] to [1, 1, 1] m");
  Triangles crowded = box;
  crowded.triangle.push_back({0, 3, 7});
  crowded.triangle.push_back({0, 7, 3});
  CHECK_THAT(problem_of(crowded), Catch::StartsWith("the surface is not simple: more than two at "));
  Triangles twisted = box;
  std::swap(twisted.triangle[0][0], twisted.triangle[0][1]);
  CHECK(problem_of(twisted) ==
        "triangles that turn against their neighbours: 3 edges, the first from [0, 0, 0] to [0, 1, 0] m");
  const Triangles flat = solids::box({0, 0, 0}, {1, 1, 1e-13});
  CHECK(problem_of(flat) == "no volume: 12 triangles around 1e-13 m^3");
  CHECK(problem_of(solids::box({1, 1, 1}, {1, 1, 1})) == "no volume: 12 triangles without area");
  // Corners may be there several times, and triangles without area between them.
  Triangles doubled = box;
  doubled.corner.push_back(box.corner[7]);
  doubled.triangle[3][1] = 8;
  doubled.triangle.push_back({7, 8, 0});
  CHECK(problem_of(doubled) == "none");
}

TEST_CASE("files that are no mesh are told why", "[unit]") {
  const Folder folder;
  solids::write_binary_stl(folder / "box.stl", solids::box({0, 0, 0}, {1, 1, 1}));
  std::ifstream file(folder / "box.stl", std::ios::binary);
  const std::string binary((std::istreambuf_iterator<char>(file)), {});
  CHECK(problem_of("a.stl", binary) == "none");
  CHECK(problem_of("a.stl", binary + "more") == "none");
  CHECK(problem_of("a.stl", binary.substr(0, 500)) == "the file is cut off: 500 bytes");
  CHECK(problem_of("a.stl", binary.substr(0, 50)) == "the file is cut off: 50 bytes");
  CHECK(problem_of("a.stl", "") == "the file is cut off: 0 bytes");
  std::string nan = binary;
  nan.replace(84 + 12, 4, "\xff\xff\xff\xff");
  CHECK(problem_of("a.stl", nan) == "a corner that is not finite: [nan, 0, 0] of triangle 0");
  CHECK_THAT(problem_of("a.stl", binary.substr(0, 80) + std::string(4, '\0')), Catch::StartsWith("no triangles: "));
  CHECK_THAT(problem_of("a.stl", "solid of nothing\nendsolid"), Catch::StartsWith("no triangles: "));
  CHECK(problem_of("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                            "endfacet\nfacet") == "the file is cut off: 1 triangles in 9 lines");
  CHECK(problem_of("a.stl", "solid\nvertex 0 0 nought") == "not a number: \"nought\" in line 2");
  CHECK(problem_of("a.stl", "solid\nvertex 0 0 inf") == "a corner that is not finite: [0, 0, inf] of line 2");
  CHECK(problem_of("a.stl", "solid\nvertex 0 0 0\nendfacet") ==
        "not an STL file: a facet with another number of corners ends in line 3");
  CHECK(problem_of("a.obj", "v 0 0 0\nf 1 2 3\n") == "a corner that does not exist: \"2\" in line 2");
  CHECK(problem_of("a.obj", "v 0 0 0\nf 1 1\n") == "not an OBJ file: 2 in line 2");
  CHECK(problem_of("a.obj", "v 0 0\n") == "not a number: \"v 0 0\" in line 1");
  CHECK(problem_of("a.ply", "ply") == "unknown format: ");
  CHECK_THROWS_WITH(shapes::read_mesh(folder / "bax.stl"), "no such file");
  CHECK_THROWS_WITH(shapes::read_mesh("/proc/self.stl"), "no such file");
}

TEST_CASE("a distance on a grid is that of the shape near its surface, and has its sign elsewhere", "[unit]") {
  Grid<3> grid;
  grid.low = {-1.6, -1.6, -1.6};
  grid.spacing = 0.1;
  grid.cells = {32, 33, 34};
  const shapes::Ball<3> ball({0.05, 0, 0}, 1);
  const double band = 0.3;
  const GridDistance<3> everywhere(ball, grid);
  const GridDistance<3> banded(ball, grid, band);
  std::size_t wrong = 0;
  for (std::size_t row = 0; row < everywhere.values().size(); ++row) {
    const double exact = everywhere.values()[row];
    const double value = banded.values()[row];
    wrong += exact != ball.distance(Vec<3>(-1.6 + 0.1 * static_cast<double>(row % 33),
                                           -1.6 + 0.1 * static_cast<double>(row / 33 % 34),
                                           -1.6 + 0.1 * static_cast<double>(row / 33 / 34)));
    wrong += std::abs(exact) <= band ? value != exact
                                     : std::signbit(value) != std::signbit(exact) || std::abs(value) < band ||
                                           std::abs(value) > std::abs(exact) + 1e-12;
  }
  CHECK(wrong == 0);
  std::mt19937_64 random(8);
  Largest error;
  Largest gradient_error;
  for (int k = 0; k < 2000; ++k) {
    const Vec<3> x = random_point<3>({Vec<3>(-1.6, -1.6, -1.6), Vec<3>(1.6, 1.6, 1.6)}, random);
    const double exact = ball.distance(x);
    if (std::abs(exact) > 0.1) continue;
    error.add(std::abs(banded.distance(x) - exact));
    gradient_error.add((banded.gradient(x) - ball.gradient(x)).norm());
  }
  CHECK(error.value() < 0.01 / 8 * 2 / 0.8);  // h^2/8 times the curvatures, a little inside of the ball
  CHECK(gradient_error.value() < 0.1);        // first order
  CHECK(banded.distance({3.6, 0, 0}) > 2);
}

TEST_CASE("a distance on a grid is exact for a plane", "[unit]") {
  Grid<2> grid;
  grid.spacing = 0.25;
  grid.cells = {10, 6};
  const shapes::HalfSpace<2> plane({1, 1}, {1, 2});
  const GridDistance<2> flat(plane, grid);
  std::mt19937_64 random(9);
  for (int k = 0; k < 100; ++k) {
    const Vec<2> x = random_point<2>({Vec<2>(0, 0), Vec<2>(2.5, 1.5)}, random);
    CHECK(flat.distance(x) == Approx(plane.distance(x)).margin(1e-14));
    CHECK((flat.gradient(x) - plane.gradient({0, 0})).norm() < 1e-13);
  }
}
