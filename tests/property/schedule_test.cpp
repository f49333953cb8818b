#include "engine/schedule/schedule.hpp"

#include "support/rows.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <set>
#include <thread>

using namespace minamo;
using namespace minamo::rows;

namespace {

constexpr std::array<std::string_view, 9> names{"row.0",   "row.1",   "row.2",      "row.3",     "other.4",
                                                "other.5", "other.6", "resource.7", "resource.8"};
constexpr std::size_t columns_of_rows = 4;
constexpr std::size_t columns = 7;

using Table = std::array<std::string_view, 2>;
constexpr Table tables{Rows::name, OtherRows::name};

template <std::size_t k>
struct Quantity : Column<std::conditional_t<(k < columns_of_rows), Rows, OtherRows>, std::uint64_t> {
  static constexpr ComponentInfo info{names[k], "q", "1", Lifetime::state};
};
template <std::size_t k>
struct Resource {
  std::uint64_t value = 0;
  static constexpr ComponentInfo info{names[k], "r", "1", Lifetime::state};
};

template <std::size_t k>
std::span<std::uint64_t> numbers_in(World& world) {
  if constexpr (k < columns) {
    return world.column<Quantity<k>>();
  } else {
    return {&world.resource<Resource<k>>().value, 1};
  }
}

template <std::size_t... k>
constexpr auto all_numbers(std::index_sequence<k...>) {
  return std::array{&numbers_in<k>...};
}
constexpr auto numbers = all_numbers(std::make_index_sequence<names.size()>{});

/// What one random system touches: a mode for some components, and perhaps a table to resize.
struct Plan {
  std::uint64_t number = 0;
  std::vector<std::pair<std::size_t, Mode>> touched;
  std::optional<std::size_t> resized;
};

// Neither commutative nor associative, so that every change of order shows.
std::uint64_t mix(std::uint64_t x, std::uint64_t y) {
  x = (x ^ (y + 0x9e3779b97f4a7c15u + (x << 6))) * 0xbf58476d1ce4e5b9u;
  return x ^ (x >> 29);
}

void resize(World& world, std::size_t table, std::size_t rows) {
  table == 0 ? world.resize<Rows>(rows) : world.resize<OtherRows>(rows);
}

/// All that the system may read, folded into one number; then every number it may write from that.
void follow(const Plan& plan, World& world) {
  std::uint64_t sum = plan.number;
  for (const auto& [component, mode] : plan.touched) {
    if (mode == Mode::write) continue;
    for (const std::uint64_t value : numbers[component](world)) sum = mix(sum, value);
  }
  if (sum % 3 == 0) std::this_thread::yield();  // other interleavings
  if (plan.resized) resize(world, *plan.resized, 1 + sum % 7);
  for (const auto& [component, mode] : plan.touched) {
    if (mode == Mode::read) continue;
    for (std::uint64_t& value : numbers[component](world)) {
      sum = mix(sum, plan.number);
      value = mode == Mode::write ? sum : mix(value, sum);
    }
  }
}

const ComponentInfo any_state{"", "", "1", Lifetime::state};

System system_of(const Plan& plan) {
  System system{std::to_string(plan.number), {}, [](World&) {}, [plan](World& world) { follow(plan, world); }};
  for (const auto& [component, mode] : plan.touched) {
    const std::string_view table =
        component < columns ? tables[component < columns_of_rows ? 0 : 1] : std::string_view();
    system.access.push_back({mode, names[component], table, &any_state});
  }
  if (plan.resized) system.access.push_back({Mode::resize, {}, tables[*plan.resized], nullptr});
  return system;
}

/// \param chance  of a system to touch a component [1]
std::vector<Plan> random_plans(std::uint32_t seed, double chance) {
  std::mt19937 random(seed);
  std::bernoulli_distribution touches(chance);
  std::bernoulli_distribution resizes(0.1);
  std::uniform_int_distribution<int> mode(0, 3);  // half of the accesses read
  std::vector<Plan> plans(24);
  for (Plan& plan : plans) {
    plan.number = random();
    for (std::size_t component = 0; component < names.size(); ++component) {
      if (touches(random))
        plan.touched.emplace_back(component, std::array{Mode::read, Mode::read, Mode::write,
                                                        Mode::update}[static_cast<std::size_t>(mode(random))]);
    }
    if (resizes(random)) plan.resized = random() % tables.size();
  }
  return plans;
}

std::vector<System> systems_of(const std::vector<Plan>& plans) {
  std::vector<System> systems;
  for (const Plan& plan : plans) systems.push_back(system_of(plan));
  return systems;
}

/// All components after a few runs, one after the other.
std::vector<std::vector<std::uint64_t>> result(const std::vector<Plan>& plans, Execution execution) {
  World world;
  for (const auto& component : numbers) component(world);
  for (std::size_t table = 0; table < tables.size(); ++table) resize(world, table, 5);
  Schedule schedule(systems_of(plans), world, nullptr, execution);
  for (int step = 0; step < 4; ++step) schedule.run();
  std::vector<std::vector<std::uint64_t>> all;
  for (const auto& component : numbers) {
    const auto values = component(world);
    all.emplace_back(values.begin(), values.end());
  }
  return all;
}

/// reach[to][from]: there is a path.
using Reach = std::vector<std::vector<bool>>;

Reach closure(std::size_t n, const std::vector<Edge>& edges) {
  Reach reach(n, std::vector<bool>(n, false));
  for (const Edge& edge : edges) reach[edge.to][edge.from] = true;
  for (std::size_t via = 0; via < n; ++via) {
    for (std::size_t to = 0; to < n; ++to) {
      for (std::size_t from = 0; from < n; ++from) {
        if (reach[to][via] && reach[via][from]) reach[to][from] = true;
      }
    }
  }
  return reach;
}

/// The rule in other words: memory that a system looks at and memory that it changes. The rows of a table are memory of
/// their own, which every access to a column looks at; a resize changes them and all columns.
struct Footprint {
  std::set<std::string_view> looked_at;
  std::set<std::string_view> changed;
};

Footprint footprint(const Plan& plan) {
  Footprint result;
  for (const auto& [component, mode] : plan.touched) {
    if (component < columns) result.looked_at.insert(tables[component < columns_of_rows ? 0 : 1]);
    (mode == Mode::read ? result.looked_at : result.changed).insert(names[component]);
  }
  if (!plan.resized) return result;
  result.changed.insert(tables[*plan.resized]);
  for (std::size_t k = 0; k < columns; ++k) {
    if ((k < columns_of_rows) == (*plan.resized == 0)) result.changed.insert(names[k]);
  }
  return result;
}

bool meet(const std::set<std::string_view>& x, const std::set<std::string_view>& y) {
  return std::any_of(x.begin(), x.end(), [&y](std::string_view name) { return y.contains(name); });
}

std::vector<Edge> all_pairs(const std::vector<Plan>& plans) {
  std::vector<Edge> pairs;
  for (std::size_t to = 0; to < plans.size(); ++to) {
    for (std::size_t from = 0; from < to; ++from) {
      const Footprint x = footprint(plans[from]);
      const Footprint y = footprint(plans[to]);
      if (meet(x.changed, y.changed) || meet(x.changed, y.looked_at) || meet(x.looked_at, y.changed)) {
        pairs.push_back({from, to});
      }
    }
  }
  return pairs;
}

std::vector<Plan> any_plans() {
  const auto seed = GENERATE(range(0u, 100u));
  const auto chance = GENERATE(0.05, 0.15, 0.4);
  UNSCOPED_INFO("seed " << seed << ", chance " << chance);
  return random_plans(seed, chance);
}

}  // namespace

TEST_CASE("a graph gives bit for bit what its list gives", "[property][threads]") {
  const auto plans = any_plans();
  CHECK(result(plans, Execution::graph) == result(plans, Execution::list));
}

TEST_CASE("the reduced edges order exactly the systems that share memory", "[property]") {
  const auto plans = any_plans();
  CHECK(closure(plans.size(), derive_edges(systems_of(plans))) == closure(plans.size(), all_pairs(plans)));
}

TEST_CASE("no reduced edge follows from the others", "[property]") {
  const auto plans = any_plans();
  const auto edges = derive_edges(systems_of(plans));
  const Reach reach = closure(plans.size(), edges);
  const auto follows = [&](const Edge& edge) {
    return std::any_of(edges.begin(), edges.end(),
                       [&](const Edge& last) { return last.to == edge.to && reach[last.from][edge.from]; });
  };
  CHECK(std::none_of(edges.begin(), edges.end(), follows));
}
