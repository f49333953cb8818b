#include "components/grid.hpp"
#include "systems/grid/walls.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"
#include "systems/setup/schemes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

constexpr std::string_view periodic = "periodic";
const std::vector<std::string> axis_names{"x", "y", "z"};

std::vector<std::string> conditions(const SystemRegistry& registry) {
  std::vector<std::string> names;
  for (const WallCondition& condition : registry.in_order<WallCondition>()) names.push_back(condition.name);
  return names;
}

std::vector<std::string> with_periodic(std::vector<std::string> names) {
  names.emplace_back(periodic);
  return names;
}

Json schema(const std::vector<std::string>& names) {
  const Json name{{"enum", names}};
  const Json sides{{"type", "array"}, {"items", name}, {"minItems", 2}, {"maxItems", 2}};
  const Json axis{{"oneOf", {{{"enum", with_periodic(names)}}, sides}}};
  Json axes{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  for (const std::string& x : axis_names) axes["properties"][x] = axis;
  return {
      {"description",
       R"("slip" or "no_slip" for all sides, or per axis {"x": "slip"}, {"x": "periodic"}, or [low side, high side])"},
      {"type", {"string", "object"}},
      {"oneOf", {name, axes}}};
}

/// Names of wall conditions: low and high side per axis.
using Sides = std::vector<std::array<std::string, 2>>;

/// `at` is the place of the value, as Input::problem() takes it.
std::string read_wall(Input& input, const std::string& at, const Json& value, const std::vector<std::string>& names) {
  const std::string name = value.is_string() ? value.get<std::string>() : "";
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    input.problem(at, value.is_string() ? "unknown name" : "wrong type", one_of_text(names), shown(value),
                  closest_name(name, names));
    return names.front();
  }
  return name;
}

std::array<std::string, 2> read_axis(Input& input, const std::string& at, const Json& value,
                                     const std::vector<std::string>& names) {
  if (!value.is_array()) {
    const std::string both = read_wall(input, at, value, with_periodic(names));
    return {both, both};
  }
  if (value.size() == 2)
    return {read_wall(input, at + "/0", value[0], names), read_wall(input, at + "/1", value[1], names)};
  input.problem(at, "wrong length", "one wall, or a list of two: low side, high side", shown(value));
  return {names.front(), names.front()};
}

/// Around a shorter axis a node would be a neighbour of itself.
void check_periodic(Input& input, const std::string& at, const std::string& wall, int cells) {
  constexpr int fewest = 5;
  if (wall != periodic || cells >= fewest || input.describing()) return;
  input.problem(at, "too few cells", fmt::format("at least {} cells along a periodic axis", fewest),
                fmt::format("{} cells", cells));
}

Sides read_sides(Input& input, std::span<const int> cells, const std::vector<std::string>& names) {
  const Json walls = input.raw("walls", schema(names), names.front());
  Sides all(cells.size(), {names.front(), names.front()});
  if (walls.is_string()) {
    const std::string wall = read_wall(input, "walls", walls, names);
    std::fill(all.begin(), all.end(), std::array{wall, wall});
    return all;
  }
  if (!walls.is_object()) {
    input.problem("walls", "wrong type", R"("slip", "no_slip" or an object, a wall per axis)", shown(walls));
    return all;
  }
  const std::span<const std::string> axes(axis_names.data(), cells.size());
  for (const auto& [key, value] : walls.items()) {
    const std::string at = fmt::format("walls/{}", pointer_token(key));
    const auto axis = std::find(axes.begin(), axes.end(), key);
    if (axis == axes.end()) {
      input.problem(at, "unknown key", one_of_text(axes), shown(value), closest_name(key, axes));
    } else {
      const auto d = static_cast<std::size_t>(axis - axes.begin());
      all[d] = read_axis(input, at, value, names);
      check_periodic(input, at, all[d][0], cells[d]);
    }
  }
  return all;
}

template <int Dim>
Walls<Dim> make_walls(const Sides& sides, const SystemRegistry& registry) {
  Walls<Dim> walls;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t end = 0; end < 2; ++end) {
      if (sides[d][end] == periodic) continue;
      const auto& condition = registry.choices<WallCondition>().at(sides[d][end]);
      walls.held[d][end] = condition.held(Dim, static_cast<int>(d));
    }
  }
  return walls;
}

/// `"slip"` for all sides, or per axis `{"x": "slip", "y": ["no_slip", "slip"]}`.
Contribution read_walls(Input& input, Scene& scene) {
  const Sides sides = read_sides(input, scene.grid.cells, conditions(registry_of(scene)));
  for (std::size_t d = 0; d < sides.size(); ++d) scene.grid.periodic[d] = sides[d][0] == periodic;
  return [sides](const Scene& of, Recipe& recipe) {
    add_systems(of, recipe, "boundaries", {{"apply_wall_condition"}, {"hold_faces"}});
    with_dimension(of.dimension, [&](auto dim) { recipe.constant(make_walls<dim()>(sides, recipe.registry())); });
  };
}

}  // namespace

void add_walls(SystemRegistry& registry) {
  registry.add<ApplyWallCondition>("apply_wall_condition");
  registry.add(WallCondition{"slip", "no flow through the wall",
                             [](int, int axis) { return static_cast<std::uint8_t>(1U << axis); }});
  registry.add(WallCondition{"no_slip", "no flow at the wall",
                             [](int dimension, int) { return static_cast<std::uint8_t>((1U << dimension) - 1); }});
  const auto schemes = [](const SystemRegistry& all) { return schemes_of<WallCondition>(all); };
  registry.add(Part{"walls", "conditions at the sides of the box", read_walls, schemes});
}

}  // namespace minamo
