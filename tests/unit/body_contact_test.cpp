/// \file
/// Where bodies may touch: between the points that stand for their surfaces, too.

#include "systems/bodies/particles/contact.hpp"
#include "systems/shapes/primitives.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

using namespace minamo;

namespace {

BodyScene<2> disc(const Vec<2>& middle, double radius, int points) {
  BodyScene<2> body;
  body.shape = std::make_shared<shapes::Ball<2>>(middle, radius);
  body.pivot = middle;
  for (int k = 0; k < points; ++k) {
    const double angle = 6.283185307179586 * (k + 0.5) / points;
    body.surface.push_back(middle + radius * Vec<2>(std::cos(angle), std::sin(angle)));
  }
  return body;
}

}  // namespace

TEST_CASE("the gap of two discs is that between them, whichever of them has the points", "[unit]") {
  // On the line between them lies no point of either.
  const bool free_one_has_points = GENERATE(true, false);
  CAPTURE(free_one_has_points);
  BodySet<2> set;
  set.bodies = {disc({0, 0}, 1, free_one_has_points ? 16 : 0), disc({2.1, 0}, 1, free_one_has_points ? 0 : 16)};
  Free<2> free;
  free.mass = 1;
  set.bodies[0].motion = free;
  const std::vector<Vec<2>> position{{0, 0}, {2.1, 0}};
  const std::vector<Mat<2>> rotation(2, Mat<2>::Identity());
  const std::vector<Vec<2>> velocity(2, Vec<2>::Zero());
  const std::vector<Vec<1>> spin(2, Vec<1>::Zero());
  const std::vector<double> reach(2, 0.2);
  Grid<2> grid;
  grid.low = {-10, -10};
  grid.high = {10, 10};
  grid.spacing = 0.5;
  const auto contacts = find_contacts<2>(grid, set, FreeMotions<2>(set), {position, rotation, velocity, spin}, reach);
  REQUIRE(!contacts.empty());
  const auto closest =
      std::min_element(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) { return a.gap < b.gap; });
  CHECK(closest->gap == Approx(0.1).epsilon(1e-3));  // 0.15 at the nearest point
  CHECK(closest->gradient[0] == Approx(-1).epsilon(1e-2));
}
