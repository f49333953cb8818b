#include "support/shape_checks.hpp"

#include "systems/shapes/polygon.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace minamo;
using namespace minamo::shape_checks;

namespace {

/// An arrow with a notch, and corners on a line.
const std::vector<Vec<2>> arrow{{0, 0}, {2, 0}, {3, 0}, {3, 2}, {1.5, 0.5}, {0.2, 1.8}};

std::vector<Vec<2>> reversed(std::vector<Vec<2>> corners) {
  std::reverse(corners.begin(), corners.end());
  return corners;
}

std::string problem_of(const std::vector<Vec<2>>& corners) {
  const auto problem = shapes::what_is_wrong(corners);
  return problem ? problem->what + ": " + problem->where : "none";
}

}  // namespace

TEST_CASE("a polygon is as far as its nearest side or corner, in either direction", "[unit]") {
  for (const auto& corners : {arrow, reversed(arrow)}) {
    REQUIRE(problem_of(corners) == "none");
    const shapes::Polygon polygon(corners);
    check_euclidean<2>(polygon, around<2>(polygon.bounds()));
    check_bounds<2>(polygon, 0.02);
    check_parts<2>(polygon, around<2>(polygon.bounds()));
    // (0,0) (3,0) (3,2) (1.5,0.5) (0.2,1.8): shoelace
    CHECK(measure<2>(polygon, polygon.bounds(), 500) == Approx(0.5 * (6 - 1.5 + 2.6)).epsilon(0.01));
  }
}

TEST_CASE("the facets of a polygon carry the numbers of its sides as given", "[unit]") {
  for (const auto& corners : {arrow, reversed(arrow)}) {
    const auto parts = shapes::Polygon(corners).convex_parts();
    REQUIRE(parts);
    std::multiset<int> faces;
    for (const auto& part : *parts) {
      for (const Facet<2>& facet : part) {
        if (facet.face == Facet<2>::inner) continue;
        faces.insert(facet.face);
        const auto side = static_cast<std::size_t>(facet.face);
        CHECK(facet.normal.dot(corners[side]) == Approx(facet.offset).margin(1e-14));
        CHECK(facet.normal.dot(corners[(side + 1) % corners.size()]) == Approx(facet.offset).margin(1e-14));
      }
    }
    CHECK(faces == std::multiset<int>{0, 1, 2, 3, 4, 5});
  }
}

TEST_CASE("polygons that are none are told why", "[unit]") {
  CHECK(problem_of({{0, 0}, {1, 0}}) == "too few corners: 2 corners");
  CHECK(problem_of({{0, 0}, {1, 0}, {1, 0}, {0, 1}}) == "a corner given twice: corners 1 and 2 at [1, 0] m");
  CHECK(problem_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}) ==
        "the polygon meets itself: the side from corner 0 at [0, 0] m and the one from corner 2 at [1, 0] m");
  CHECK(problem_of({{0, 0}, {1, 0}, {2, 0}}).starts_with("the polygon meets itself"));
  CHECK(problem_of({{0, 0}, {2, 0}, {1, 0}, {1, 1}}).starts_with("the polygon meets itself"));
  // A corner on a side.
  CHECK(problem_of({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}).starts_with("the polygon meets itself"));
}
