#include "systems/setup/scene_walls.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

const std::vector<std::string> wall_names{"slip", "no_slip"};
const std::vector<std::string> axis_wall_names{"slip", "no_slip", "periodic"};
const std::vector<std::string> axis_names{"x", "y", "z"};

Json schema() {
  const Json name{{"enum", wall_names}};
  const Json sides{{"type", "array"}, {"items", name}, {"minItems", 2}, {"maxItems", 2}};
  const Json axis{{"oneOf", {{{"enum", axis_wall_names}}, sides}}};
  Json axes{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  for (const std::string& x : axis_names) axes["properties"][x] = axis;
  return {
      {"description",
       R"("slip" or "no_slip" for all sides, or per axis {"x": "slip"}, {"x": "periodic"}, or [low side, high side])"},
      {"type", {"string", "object"}},
      {"oneOf", {name, axes}}};
}

/// `at` is the place of the value, as Input::problem() takes it.
Wall read_wall(Input& input, const std::string& at, const Json& value, std::span<const std::string> names) {
  const std::string name = value.is_string() ? value.get<std::string>() : "";
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    input.problem(at, value.is_string() ? "unknown name" : "wrong type", one_of_text(names), shown(value),
                  closest_name(name, names));
  }
  if (name == "periodic") return Wall::periodic;
  return name == "no_slip" ? Wall::no_slip : Wall::slip;
}

Wall read_side(Input& input, const std::string& at, const Json& value) {
  return read_wall(input, at, value, wall_names);
}

std::array<Wall, 2> read_axis(Input& input, const std::string& at, const Json& value) {
  if (!value.is_array()) {
    const Wall both = read_wall(input, at, value, axis_wall_names);
    return {both, both};
  }
  if (value.size() == 2) return {read_side(input, at + "/0", value[0]), read_side(input, at + "/1", value[1])};
  input.problem(at, "wrong length", "one wall, or a list of two: low side, high side", shown(value));
  return {Wall::slip, Wall::slip};
}

/// Around a shorter axis a node would be a neighbour of itself.
void check_periodic(Input& input, const std::string& at, Wall wall, int cells) {
  constexpr int fewest = 5;
  if (wall != Wall::periodic || cells >= fewest || input.describing()) return;
  input.problem(at, "too few cells", fmt::format("at least {} cells along a periodic axis", fewest),
                fmt::format("{} cells", cells));
}

}  // namespace

std::vector<std::array<Wall, 2>> read_walls(Input& input, std::span<const int> cells) {
  const std::size_t dimension = cells.size();
  const Json walls = input.raw("walls", schema(), "slip");
  std::vector<std::array<Wall, 2>> all(dimension, {Wall::slip, Wall::slip});
  if (walls.is_string()) {
    const Wall wall = read_side(input, "walls", walls);
    std::fill(all.begin(), all.end(), std::array{wall, wall});
    return all;
  }
  if (!walls.is_object()) {
    input.problem("walls", "wrong type", R"("slip", "no_slip" or an object, a wall per axis)", shown(walls));
    return all;
  }
  const std::span<const std::string> axes(axis_names.data(), dimension);
  for (const auto& [key, value] : walls.items()) {
    const std::string at = fmt::format("walls/{}", pointer_token(key));
    const auto axis = std::find(axes.begin(), axes.end(), key);
    if (axis == axes.end()) {
      input.problem(at, "unknown key", one_of_text(axes), shown(value), closest_name(key, axes));
    } else {
      const auto d = static_cast<std::size_t>(axis - axes.begin());
      all[d] = read_axis(input, at, value);
      check_periodic(input, at, all[d][0], cells[d]);
    }
  }
  return all;
}

}  // namespace minamo
