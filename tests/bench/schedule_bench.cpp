#include "engine/schedule/schedule.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <vector>

using namespace minamo;

namespace {

constexpr std::array<std::string_view, 9> names{"r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8"};

const ComponentInfo any_state{"", "", "1", Lifetime::state};

System empty(std::vector<Access> access) {
  return {"empty", std::move(access), [](World&) {}, [](World&) {}};
}

Access access_to(std::size_t resource, Mode mode) { return {mode, names[resource], {}, &any_state}; }

/// Nobody waits.
std::vector<System> independent() { return std::vector<System>(25, empty({})); }

/// Everybody waits for the one before.
std::vector<System> chain() { return std::vector<System>(25, empty({access_to(0, Mode::update)})); }

/// Three at a time, each waiting for all three of the layer before.
std::vector<System> layers() {
  std::vector<System> systems;
  for (std::size_t place = 0; place < 25; ++place) {
    const std::size_t layer = place / 3 % 2 * 3;
    std::vector<Access> access = {access_to(layer + place % 3, Mode::write)};
    for (std::size_t k = 0; k < 3; ++k) access.push_back(access_to(3 - layer + k, Mode::read));
    systems.push_back(empty(std::move(access)));
  }
  return systems;
}

}  // namespace

TEST_CASE("a graph of 25 empty systems runs in less than 20 us", "[!benchmark]") {
  World world;
  Schedule all_at_once(independent(), world);
  Schedule one_by_one(chain(), world);
  Schedule three_at_a_time(layers(), world);
  Schedule list(chain(), world, nullptr, Execution::list);
  BENCHMARK("independent") { all_at_once.run(); };
  BENCHMARK("chain") { one_by_one.run(); };
  BENCHMARK("layers of three") { three_at_a_time.run(); };
  BENCHMARK("list") { list.run(); };
}

TEST_CASE("a profiler adds little to 25 empty systems", "[!benchmark]") {
  World world;
  Profiler profiler;
  Schedule schedule(layers(), world, &profiler);
  BENCHMARK("layers of three, profiled") { schedule.run(); };
}
