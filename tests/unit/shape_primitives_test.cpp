#include "support/shape_checks.hpp"

#include "systems/shapes/ellipsoid.hpp"
#include "systems/shapes/placement.hpp"
#include "systems/shapes/primitives.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace minamo;
using namespace minamo::shape_checks;

namespace {

const Mat<2> turned_2d = rotation(0.4);
const Mat<3> turned_3d = rotation(0.7, {1, 2, -1});

/// The shape is as far from everywhere as it should be, has the measure, and lies in its bounds.
template <int Dim>
void check(const Shape<Dim>& shape, double expected) {
  const auto box = shape.bounds();
  check_euclidean<Dim>(shape, around<Dim>(box));
  check_bounds<Dim>(shape, Dim == 2 ? 0.02 : 0.1);
  CHECK(measure<Dim>(shape, box, Dim == 2 ? 400 : 80) == Approx(expected).epsilon(0.01));
}

}  // namespace

TEST_CASE("a box is as far as its nearest face, edge or corner", "[unit][long]") {
  check<2>(shapes::Box<2>({-1, 0.5}, {0.5, 1.5}), 1.5);
  check<2>(shapes::Box<2>({-1, 0.5}, {0.5, 1.5}, turned_2d), 1.5);
  check<3>(shapes::Box<3>({-1, 0.5, 0}, {0.5, 1.5, 2}), 3);
  check<3>(shapes::Box<3>({-1, 0.5, 0}, {0.5, 1.5, 2}, turned_3d), 3);
  check_parts<2>(shapes::Box<2>({-1, 0.5}, {0.5, 1.5}, turned_2d), {Vec<2>(-2, 0), Vec<2>(1, 2)});
  check_parts<3>(shapes::Box<3>({-1, 0.5, 0}, {0.5, 1.5, 2}, turned_3d), {Vec<3>(-2, 0, -1), Vec<3>(1, 2, 3)});
}

TEST_CASE("a point on a face of a box is inside, to the bit", "[unit]") {
  const shapes::Box<2> box({0.1, 0.2}, {0.3, 0.7});
  CHECK(box.contains({0.1, 0.7}));
  CHECK(box.contains({0.3, 0.2}));
  CHECK_FALSE(box.contains({std::nextafter(0.1, 0), 0.5}));
  CHECK_FALSE(box.contains({0.2, std::nextafter(0.7, 1)}));
}

TEST_CASE("a ball is as far as its centre less the radius", "[unit]") {
  check<2>(shapes::Ball<2>({0.5, -1}, 0.7), std::numbers::pi * 0.49);
  check<3>(shapes::Ball<3>({0.5, -1, 2}, 0.7), 4 * std::numbers::pi / 3 * 0.343);
  CHECK(shapes::Ball<2>({0.5, -1}, 0.7).gradient({0.5, -1}).norm() == 1);
}

TEST_CASE("an ellipsoid is as far as its nearest point", "[unit][long]") {
  check<2>(shapes::Ellipsoid<2>({0.5, -1}, {2, 0.3}), std::numbers::pi * 0.6);
  check<2>(shapes::Ellipsoid<2>({0.5, -1}, {0.3, 2}, turned_2d), std::numbers::pi * 0.6);
  check<3>(shapes::Ellipsoid<3>({0.5, -1, 2}, {1, 0.3, 0.6}, turned_3d), 4 * std::numbers::pi / 3 * 0.18);
  check<3>(shapes::Ellipsoid<3>({0.5, -1, 2}, {0.5, 1, 0.5}), 4 * std::numbers::pi / 3 * 0.25);
}

TEST_CASE("on the axes of an ellipsoid the distance is known", "[unit]") {
  const shapes::Ellipsoid<2> ellipse({0, 0}, {2, 1});
  CHECK(ellipse.distance({0, 0}) == Approx(-1));
  CHECK(ellipse.distance({3, 0}) == Approx(1));
  CHECK(ellipse.distance({0, -3}) == Approx(2));
  CHECK(ellipse.distance({2, 0}) == 0);
  // Inside of the centre of curvature of the far end, 2 - 1/2, the nearest point leaves the axis.
  CHECK(ellipse.distance({1.8, 0}) == Approx(-0.2));
  CHECK(ellipse.distance({1.2, 0}) == Approx(-std::sqrt(1 - 1.44 / 3)));
  CHECK(ellipse.distance({1.2, 1e-14}) == Approx(-std::sqrt(1 - 1.44 / 3)));
  const shapes::Ellipsoid<3> round({0, 0, 0}, {1, 1, 1});
  CHECK(round.distance({0, 0, 0}) == Approx(-1));
  CHECK(round.gradient({0, 0, 0}).norm() == Approx(1));
  CHECK(round.distance({1, 2, 2}) == Approx(2));
}

TEST_CASE("a capsule is as far as its segment less the radius", "[unit]") {
  check<2>(shapes::Capsule<2>({0, 0}, {1, 0.5}, 0.2), 0.4 * std::sqrt(1.25) + std::numbers::pi * 0.04);
  check<3>(shapes::Capsule<3>({0, 0, 1}, {1, 0.5, 0}, 0.2),
           std::numbers::pi * 0.04 * 1.5 + 4 * std::numbers::pi / 3 * 0.008);
  CHECK(shapes::Capsule<3>({0, 0, 0}, {1, 0, 0}, 0.2).gradient({0.5, 0, 0}).norm() == Approx(1));
}

TEST_CASE("a cylinder is as far as its side, its end or its rim", "[unit]") {
  check<3>(shapes::Cylinder({0, 0, 1}, {1, 0.5, 0}, 0.4), std::numbers::pi * 0.16 * 1.5);
  check<3>(shapes::Cylinder({0, 0, 0}, {0, 0, 0.1}, 0.4), std::numbers::pi * 0.016);
}

TEST_CASE("a half space lies where its normal leaves", "[unit]") {
  const shapes::HalfSpace<2> ground({0, 1}, {0, 5});
  CHECK(ground.distance({7, 3}) == 2);
  CHECK(ground.distance({7, -3}) == -4);
  CHECK(ground.gradient({7, 3}) == Vec<2>(0, 1));
  CHECK_FALSE(ground.bounds().finite());
  check_parts<2>(ground, {Vec<2>(-2, -2), Vec<2>(2, 2)});
}

TEST_CASE("a placed shape is as far as the shape from the point in its own place", "[unit]") {
  const shapes::Box<3> box({0, 0, 0}, {1, 2, 3});
  const Placement<3> placement{{0.5, 1, 1.5}, {5, 6, 7}, turned_3d};
  const shapes::Box<3> there({4.5, 5, 5.5}, {5.5, 7, 8.5}, turned_3d);
  const auto bounds = placement.bounds(box.bounds());
  CHECK((bounds.low - there.bounds().low).norm() < 1e-14);
  CHECK((bounds.high - there.bounds().high).norm() < 1e-14);
  std::mt19937_64 random(4);
  Largest worst;
  for (int k = 0; k < 100; ++k) {
    const Vec<3> x = random_point<3>(around<3>(bounds), random);
    worst.add(std::abs(placement.distance(box, x) - there.distance(x)));
    worst.add((placement.gradient(box, x) - there.gradient(x)).norm());
    worst.add((placement.to_world(placement.to_body(x)) - x).norm());
  }
  CHECK(worst.value() < 1e-13);
  const auto parts = box.convex_parts();
  const auto parts_there = there.convex_parts();
  REQUIRE(parts);
  REQUIRE(parts_there);
  for (std::size_t k = 0; k < 6; ++k) {
    const Facet<3> moved = placement.to_world((*parts)[0][k]);
    CHECK((moved.normal - (*parts_there)[0][k].normal).norm() < 1e-14);
    CHECK(moved.offset == Approx((*parts_there)[0][k].offset));
  }
}

TEST_CASE("without a formula the gradient comes from differences", "[unit]") {
  const shapes::Ellipsoid<3> ellipsoid({0.5, -1, 2}, {1, 0.3, 0.6}, turned_3d);
  const Vec<3> x(1.5, -0.7, 2.2);
  CHECK((ellipsoid.gradient(x) - ellipsoid.Shape<3>::gradient(x)).norm() < 1e-8);
}
