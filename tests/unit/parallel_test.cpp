#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/cut.hpp"

#include <catch2/catch.hpp>

#include <atomic>
#include <vector>

using namespace minamo;

TEST_CASE("a loop over costly rows meets every row once", "[unit]") {
  const std::size_t rows = GENERATE(0U, 1U, 16U, 17U, 1000U, 4097U, 300'000U);
  CAPTURE(rows);
  std::vector<std::atomic<int>> met(rows);
  for_each_costly_row(rows, [&](std::size_t row) { ++met[row]; });
  CHECK(std::all_of(met.begin(), met.end(), [](const auto& count) { return count == 1; }));
}

TEST_CASE("a cut that many ask for is the same for all of them", "[unit][threads]") {
  constexpr std::size_t sites = 5;
  FoundCuts<2> found(sites);
  std::vector<std::uint8_t> is_right(100'000);
  std::atomic<std::size_t> finds{0};
  for_each_costly_row(is_right.size(), [&](std::size_t k) {
    const std::size_t site = k % sites;
    const auto number = static_cast<double>(site);
    const SiteCut<2> cut = found(site, [&] {
      ++finds;
      return SiteCut<2>{Vec<2>::Constant(number), -number};
    });
    is_right[k] = cut.open == Vec<2>::Constant(number) && cut.share == -number ? 1 : 0;
  });
  CHECK(std::all_of(is_right.begin(), is_right.end(), [](std::uint8_t is) { return is != 0; }));
  // Threads that ask at the same time each find it.
  CHECK(finds >= sites);
  CHECK(finds < is_right.size() / 100);
}
