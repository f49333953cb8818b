#include "support/extremes.hpp"
#include "support/outlines.hpp"
#include "support/solids.hpp"

#include "systems/shapes/combination.hpp"
#include "systems/shapes/ellipsoid.hpp"
#include "systems/shapes/mesh.hpp"
#include "systems/shapes/outline.hpp"
#include "systems/shapes/polygon.hpp"
#include "systems/shapes/primitives.hpp"
#include "systems/shapes/rotation.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <numbers>

using namespace minamo;
using std::numbers::pi;

namespace {

template <int Dim>
double farthest_from_surface(const Outline<Dim>& outline, const Shape<Dim>& shape) {
  double farthest = 0;
  for (const auto& x : outline.point) farthest = largest_of(farthest, std::abs(shape.distance(x)));
  return farthest;
}

template <int Dim>
Bounds<Dim> box_of_one() {
  return {Vec<Dim>::Zero(), Vec<Dim>::Ones()};
}

template <int Dim, class S, class... Arguments>
SharedShape<Dim> shape_of_parts(Arguments&&... arguments) {
  return std::make_shared<S>(std::forward<Arguments>(arguments)...);
}

const std::vector<Vec<2>> notched_arrow{{0, 0}, {3, 0}, {3, 2}, {1.5, 0.5}, {0.2, 1.8}};

}  // namespace

TEST_CASE("outlines of boxes, polygons and meshes are exact, closed and turned outward", "[unit]") {
  const auto box = outline_of<2>(shapes::Box<2>({0.1, 0.2}, {0.4, 0.3}, rotation(0.5)), box_of_one<2>(), 0.1);
  CHECK(is_closed(box));
  CHECK(box.point.size() == 4);
  CHECK(enclosed(box) == Approx(0.03));
  auto corners = notched_arrow;
  if (GENERATE(false, true)) std::reverse(corners.begin(), corners.end());
  const auto polygon = outline_of<2>(shapes::Polygon(corners), box_of_one<2>(), 0.1);
  CHECK(is_closed(polygon));
  CHECK(enclosed(polygon) == Approx(0.5 * (6 - 1.5 + 2.6)));
  const shapes::Box<3> block({0, 0, 1}, {1, 2, 4}, rotation(0.5, Vec<3>(1, 2, 3)));
  const auto of_block = outline_of<3>(block, box_of_one<3>(), 0.1);
  CHECK(is_closed(of_block));
  CHECK(enclosed(of_block) == Approx(6));
  CHECK(farthest_from_surface<3>(of_block, block) < 1e-14);
  const shapes::Mesh mesh(shapes::close_surface(solids::ball(2), 0.5, {1, 0, 0}));
  const auto of_mesh = outline_of<3>(mesh, box_of_one<3>(), 0.1);
  CHECK(is_closed(of_mesh));
  CHECK(enclosed(of_mesh) == Approx(mesh.surface().volume));
}

TEST_CASE("sampled outlines are closed, turned outward, and have their points on the surface", "[unit]") {
  const shapes::Ball<2> disc({0.5, 0.4}, 0.2);
  const auto of_disc = outline_of<2>(disc, box_of_one<2>(), 0.05);
  CHECK(is_closed(of_disc));
  // A chord of length c cuts c^3/(12 r) off: 128 samples across, 6.5e-5 of the area.
  CHECK(enclosed(of_disc) == Approx(pi * 0.04).epsilon(2e-4));
  CHECK(farthest_from_surface<2>(of_disc, disc) < 1e-10);
  const shapes::Ball<3> ball({0.5, 0.4, 0.3}, 0.2);
  const auto of_ball = outline_of<3>(ball, box_of_one<3>(), 0.05);
  CHECK(is_closed(of_ball));
  CHECK(enclosed(of_ball) == Approx(4 * pi / 3 * 0.008).epsilon(5e-3));
  CHECK(farthest_from_surface<3>(of_ball, ball) < 1e-10);
  const shapes::Ellipsoid<3> ellipsoid({0, 0, 0}, {0.4, 0.2, 0.1}, rotation(1, Vec<3>(1, 1, 0)));
  const auto of_ellipsoid = outline_of<3>(ellipsoid, box_of_one<3>(), 0.05);
  CHECK(is_closed(of_ellipsoid));
  CHECK(enclosed(of_ellipsoid) == Approx(4 * pi / 3 * 0.008).epsilon(2e-2));
  const shapes::Cylinder cylinder({0, 0, 0}, {0, 0, 1}, 0.3);
  const auto of_cylinder = outline_of<3>(cylinder, box_of_one<3>(), 0.02);
  CHECK(is_closed(of_cylinder));
  CHECK(enclosed(of_cylinder) == Approx(pi * 0.09).epsilon(1e-2));
}

TEST_CASE("outlines of combinations in 2-D have their corners, and only these where sides are straight", "[unit]") {
  const auto along = shape_of_parts<2, shapes::Box<2>>(Vec<2>(-0.3, -0.03), Vec<2>(0.3, 0.03));
  const auto upright = shape_of_parts<2, shapes::Box<2>>(Vec<2>(-0.03, -0.3), Vec<2>(0.03, 0.3));
  const auto cross = outline_of<2>(shapes::Union<2>({along, upright}), box_of_one<2>(), 0.01);
  CHECK(is_closed(cross));
  CHECK(cross.point.size() == 12);
  CHECK(enclosed(cross) == Approx(2 * 0.6 * 0.06 - 0.06 * 0.06).epsilon(1e-6));
  // A ring: the loop inside turns the other way.
  const auto hole = shape_of_parts<2, shapes::Ball<2>>(Vec<2>(0, 0), 0.02);
  const auto ring = outline_of<2>(*shapes::difference<2>({along, hole}), box_of_one<2>(), 0.01);
  CHECK(is_closed(ring));
  // The hole has 8 samples across.
  CHECK(enclosed(ring) == Approx(0.6 * 0.06 - pi * 4e-4).epsilon(1e-3));
}

TEST_CASE("shapes without bounds are cut off at the box", "[unit]") {
  const shapes::HalfSpace<2> slope({0.5, 0.5}, {-1, 2});
  const auto of_slope = outline_of<2>(slope, box_of_one<2>(), 0.02);
  CHECK(is_closed(of_slope));
  CHECK(of_slope.point.size() == 4);
  CHECK(enclosed(of_slope) == Approx(0.5).epsilon(1e-6));
  const shapes::Complement<2> tank(
      shape_of_parts<2, shapes::Box<2>>(Vec<2>(0.25, 0.25), Vec<2>(0.75, 0.75), rotation(0.4)));
  const auto of_tank = outline_of<2>(tank, box_of_one<2>(), 0.02);
  CHECK(is_closed(of_tank));
  CHECK(of_tank.point.size() == 8);
  CHECK(enclosed(of_tank) == Approx(0.75).epsilon(1e-6));
  const auto floor = outline_of<3>(shapes::HalfSpace<3>({0, 0, 0.25}, {0, 0.3, 1}), box_of_one<3>(), 0.03);
  CHECK(is_closed(floor));
  CHECK(enclosed(floor) == Approx(0.25 * 0.25 / (2 * 0.3)).epsilon(1e-2));
}

TEST_CASE("the memory of an outline is estimated, not too low", "[unit]") {
  const shapes::Ball<3> ball({0.5, 0.4, 0.3}, 0.2);
  const auto outline = outline_of<3>(ball, box_of_one<3>(), 0.01);
  const auto numbers = static_cast<double>(3 * (outline.point.size() + outline.element.size()));
  const double estimate = outline_bytes<3>(ball, box_of_one<3>(), 0.01) / 8;
  CHECK(estimate > numbers);
  CHECK(estimate < 3 * numbers);
}
