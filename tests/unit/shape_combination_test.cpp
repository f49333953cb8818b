#include "support/shape_checks.hpp"

#include "systems/shapes/combination.hpp"
#include "systems/shapes/level_set.hpp"
#include "systems/shapes/polygon.hpp"
#include "systems/shapes/primitives.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace minamo;
using namespace minamo::shape_checks;

namespace {

using Shapes = std::vector<SharedShape<2>>;

const SharedShape<2> square = std::make_shared<shapes::Box<2>>(Vec<2>(0, 0), Vec<2>(2, 2));
const SharedShape<2> disc = std::make_shared<shapes::Ball<2>>(Vec<2>(2, 1), 0.5);
const SharedShape<2> bar = std::make_shared<shapes::Box<2>>(Vec<2>(1, 0.5), Vec<2>(4, 1.5));
const Bounds<2> around_all{Vec<2>(-1, -1), Vec<2>(5, 3)};

/// Where two shapes have distances or gradients that differ.
double difference_of(const Shape<2>& a, const Shape<2>& b) {
  std::mt19937_64 random(5);
  Largest largest;
  for (int k = 0; k < 500; ++k) {
    const Vec<2> x = random_point<2>(around_all, random);
    largest.add(std::abs(a.distance(x) - b.distance(x)));
    largest.add((a.gradient(x) - b.gradient(x)).norm());
    largest.add(a.contains(x) != b.contains(x));
  }
  return largest.value();
}

SharedShape<2> invert(const SharedShape<2>& shape) { return std::make_shared<shapes::Complement<2>>(shape); }

}  // namespace

TEST_CASE("shapes combine as sets do", "[unit]") {
  const shapes::Union<2> both({square, disc});
  const shapes::Intersection<2> common({square, disc});
  CHECK(difference_of(shapes::Union<2>({square, square}), *square) == 0);
  CHECK(difference_of(shapes::Complement<2>(invert(square)), *square) == 0);
  CHECK(difference_of(shapes::Complement<2>(std::make_shared<shapes::Union<2>>(Shapes{square, disc})),
                      shapes::Intersection<2>({invert(square), invert(disc)})) == 0);
  CHECK(difference_of(*shapes::difference<2>({square, disc}), shapes::Intersection<2>({square, invert(disc)})) == 0);
  const double half_disc = std::acos(-1) * 0.125;
  CHECK(measure<2>(both, around_all, 600) == Approx(4 + half_disc).epsilon(0.005));
  CHECK(measure<2>(common, around_all, 600) == Approx(half_disc).epsilon(0.01));
  CHECK(measure<2>(*shapes::difference<2>({square, disc}), around_all, 600) == Approx(4 - half_disc).epsilon(0.005));
}

TEST_CASE("a union is Euclidean outside, an intersection inside, and both are bounds elsewhere", "[unit]") {
  const SharedShape<2> both = std::make_shared<shapes::Union<2>>(Shapes{square, bar});
  const SharedShape<2> common = std::make_shared<shapes::Intersection<2>>(Shapes{square, bar});
  const shapes::Box<2> same_as_common({1, 0.5}, {2, 1.5});
  const auto surface = surface_points<2>(*both, around_all, 4000);
  std::mt19937_64 random(6);
  Largest too_large;
  Largest not_euclidean;
  for (int k = 0; k < 500; ++k) {
    const Vec<2> x = random_point<2>(around_all, random);
    const double d = both->distance(x);
    Smallest brute;
    for (const Vec<2>& s : surface) brute.add((x - s).norm());
    too_large.add(std::abs(d) - brute.value());
    if (d > 0) not_euclidean.add(brute.value() - d);
    too_large.add(std::abs(common->distance(x)) - std::abs(same_as_common.distance(x)));
    if (common->distance(x) < 0) not_euclidean.add(std::abs(common->distance(x) - same_as_common.distance(x)));
  }
  CHECK(too_large.value() < 1e-12);
  CHECK(not_euclidean.value() < 0.01);  // the spacing of the points on the surface
}

TEST_CASE("bounds combine", "[unit]") {
  CHECK(shapes::Union<2>({square, bar}).bounds().high == Vec<2>(4, 2));
  CHECK(shapes::Intersection<2>({square, bar}).bounds().low == Vec<2>(1, 0.5));
  CHECK(shapes::Intersection<2>({square, bar}).bounds().high == Vec<2>(2, 1.5));
  CHECK(shapes::difference<2>({square, bar})->bounds().high == Vec<2>(2, 2));
  CHECK_FALSE(shapes::Complement<2>(square).bounds().finite());
}

TEST_CASE("combined plane shapes have convex parts", "[unit]") {
  const SharedShape<2> ground = std::make_shared<shapes::HalfSpace<2>>(Vec<2>(0, 0.3), Vec<2>(0.1, 1));
  const SharedShape<2> arrow =
      std::make_shared<shapes::Polygon>(std::vector<Vec<2>>{{0, 0}, {3, 0}, {3, 2}, {1.5, 0.5}, {0.2, 1.8}});
  check_parts<2>(shapes::Union<2>({square, bar, ground}), around_all);
  check_parts<2>(shapes::Intersection<2>({arrow, bar}), around_all);
  check_parts<2>(*shapes::difference<2>({square, arrow, bar}), around_all);
  check_parts<2>(*invert(arrow), around_all);
  CHECK_FALSE(shapes::Union<2>({square, disc}).convex_parts());
  const auto parts = shapes::difference<2>({square, bar})->convex_parts();
  REQUIRE(parts);
  std::set<int> faces;
  for (const auto& part : *parts) {
    for (const auto& facet : part) faces.insert(facet.face);
  }
  CHECK(faces == std::set<int>{-1, 0, 1, 2, 3, 4, 5, 6, 7});
}

TEST_CASE("an expression is taken for the distance", "[unit]") {
  const ExpressionScope scope{{"x", "y", "z", "t"}, {{"R", 0.5}}};
  const Instant later{.time = 2, .ode = {}, .ode_count = 0};
  const shapes::LevelSet<2> wave(Expression("y - R*t", scope), later);
  CHECK(wave.distance({7, 3}) == 2);
  CHECK(wave.contains({7, 1}));
  CHECK((wave.gradient({7, 3}) - Vec<2>(0, 1)).norm() < 1e-9);
  CHECK_FALSE(wave.bounds().finite());
  const shapes::LevelSet<2> root(Expression("sqrt(x) - 1", scope), later);
  CHECK(root.contains({0.5, 0}));
  CHECK_FALSE(root.contains({-0.5, 0}));
}
