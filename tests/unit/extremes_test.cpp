#include "support/extremes.hpp"

#include <catch2/catch.hpp>

#include <vector>

using namespace minamo;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Extreme>
double extreme_of(const std::vector<double>& numbers) {
  Extreme extreme;
  for (const double x : numbers) extreme.add(x);
  return extreme.value();
}

}  // namespace

TEST_CASE("the largest and the smallest number are found wherever they stand", "[unit]") {
  const auto [numbers, smallest, largest] = GENERATE(table<std::vector<double>, double, double>({
      {{3}, 3, 3},
      {{1, 2, 3}, 1, 3},
      {{3, 1, 2}, 1, 3},
      {{-3, -1, -2}, -3, -1},
      {{0, infinity, 1}, 0, infinity},
      {{0, -infinity, 1}, -infinity, 1},
  }));
  CHECK(extreme_of<Smallest>(numbers) == smallest);
  CHECK(extreme_of<Largest>(numbers) == largest);
}

TEST_CASE("a NaN is not lost among other numbers, wherever it stands", "[unit]") {
  const std::vector<double> numbers = GENERATE(std::vector{not_a_number, 1.0, 2.0}, std::vector{1.0, not_a_number, 2.0},
                                               std::vector{1.0, 2.0, not_a_number}, std::vector{not_a_number},
                                               std::vector{not_a_number, infinity, -infinity});
  CHECK(std::isnan(extreme_of<Largest>(numbers)));
  CHECK(std::isnan(extreme_of<Smallest>(numbers)));
}

TEST_CASE("the extreme of no numbers keeps no limit", "[unit]") {
  CHECK_FALSE(extreme_of<Largest>({}) < infinity);
  CHECK_FALSE(extreme_of<Smallest>({}) > -infinity);
}
