#include "systems/bodies/coupling/extension.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

using namespace minamo;

namespace {

/// A closed face, the last row, of two open ones at distances h and 2 h: linear through both.
FaceExtension<2> of_two_faces() {
  FaceExtension<2> extension;
  extension.targets = {{.row = 2, .direction = 0, .begin = 0, .count = 2, .own = false}};
  extension.source = {0, 1};
  extension.weight = {2, -1};
  return extension;
}

double extended(double near, double far, double beyond) {
  std::vector<Vec<2>> field{{near, 0}, {far, 0}, {0, 0}};
  of_two_faces().apply(field, beyond);
  return field[2][0];
}

}  // namespace

TEST_CASE("a closed face continues what open faces have, and not far beyond them", "[unit]") {
  CHECK(extended(3, 3, 0.5) == 3);
  CHECK(extended(3, 2.75, 0.5) == 3.25);
  CHECK(extended(3, -40, 0.5) == 3.5);
  CHECK(extended(-3, 40, 0.5) == -3.5);
  CHECK(std::isnan(extended(std::nan(""), std::nan(""), 0.5)));  // for (E58) to reject
}
