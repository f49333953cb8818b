#include "support/extremes.hpp"
#include "support/folder.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <regex>
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

TEST_CASE("a NaN is not lost on the way from a value so far", "[unit]") {
  const double x = GENERATE(0.0, 2.0, infinity, -infinity);
  CHECK(largest_of(1, x) == std::max(1.0, x));
  CHECK(smallest_of(1, x) == std::min(1.0, x));
  CHECK(std::isnan(largest_of(x, not_a_number)));
  CHECK(std::isnan(largest_of(not_a_number, x)));
  CHECK(std::isnan(smallest_of(x, not_a_number)));
  CHECK(std::isnan(smallest_of(not_a_number, x)));
}

TEST_CASE("no test sums up errors by what loses a NaN", "[unit]") {
  // Whole numbers have their type next to std::max.
  const std::regex loses(R"((\w+) = std::(max|min)\(\1,)");
  for (const auto& at : std::filesystem::recursive_directory_iterator(MINAMO_SOURCE_DIR "/tests")) {
    const std::string path = at.path();
    if (!path.ends_with("_test.cpp") && !path.ends_with(".hpp")) continue;
    CAPTURE(path);
    CHECK_FALSE(std::regex_search(text_of(path), loses));
  }
}

TEST_CASE("the extreme of no numbers keeps no limit", "[unit]") {
  CHECK_FALSE(extreme_of<Largest>({}) < infinity);
  CHECK_FALSE(extreme_of<Smallest>({}) > -infinity);
}
