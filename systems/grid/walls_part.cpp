#include "components/contact.hpp"
#include "components/grid.hpp"
#include "systems/grid/read_wall.hpp"
#include "systems/grid/walls.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>

namespace minamo {

namespace {

constexpr std::string_view periodic = "periodic";
const std::vector<std::string> axis_names{"x", "y", "z"};

WallWords words_of(const Scene& scene) {
  WallWords words;
  for (const WallCondition& condition : registry_of(scene).in_order<WallCondition>()) {
    (condition.is_length ? words.lengths : words.names).push_back(condition.name);
    if (condition.separates) words.separating.push_back(condition.name);
  }
  words.is_conforming = is_conforming(scene);
  words.shortest = 1e-9 * scene.grid.spacing;
  words.constants = scene.constants;
  return words;
}

Json schema(const WallWords& words) {
  const auto one_of = [&](std::vector<std::string> names, bool with_periodic) {
    if (with_periodic) names.emplace_back(periodic);
    return Json{{"oneOf", {{{"enum", names}}, slip_length_schema(words)}}};
  };
  const Json sides{{"type", "array"}, {"items", one_of(words.names, false)}, {"minItems", 2}, {"maxItems", 2}};
  Json axis = one_of(words.names, true);
  axis["oneOf"].push_back(sides);
  Json axes{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  for (const std::string& x : axis_names) axes["properties"][x] = axis;
  return {
      {"description",
       R"("slip" or "no_slip" for all sides, or per axis {"x": "slip"}, {"x": "periodic"}, or [low side, high side]; )"
       R"(with the conforming discretization also "separating" and {"slip_length": m})"},
      {"type", {"string", "object"}},
      {"oneOf", {{{"enum", words.names}}, slip_length_schema(words), axes}}};
}

/// Low and high side per axis.
using SidesOfScene = std::vector<std::array<WallOfScene, 2>>;

/// Whether an object is a wall, and not a wall per axis.
bool is_length(const Json& value, const WallWords& words) {
  return value.is_object() && std::any_of(words.lengths.begin(), words.lengths.end(),
                                          [&](const std::string& name) { return value.contains(name); });
}

/// "periodic" in the place of one side, or of all.
bool is_misplaced(Input& input, const std::string& at, const Json& value) {
  if (value != periodic) return false;
  input.problem(at, "is of a whole axis", R"(per axis, {"x": "periodic"})", shown(value));
  return true;
}

WallOfScene read_side(Input& input, const std::string& at, const Json& value, const WallWords& words) {
  if (is_misplaced(input, at, value)) return {words.names.front()};
  return read_wall(input, at, value, words, known_names(words));
}

std::array<WallOfScene, 2> read_axis(Input& input, const std::string& at, const Json& value, const WallWords& words) {
  if (!value.is_array()) {
    const WallOfScene both = read_wall(input, at, value, words, known_names(words, {std::string(periodic)}));
    return {both, both};
  }
  if (value.size() == 2) {
    return {read_side(input, at + "/0", value[0], words), read_side(input, at + "/1", value[1], words)};
  }
  input.problem(at, "wrong length", "one wall, or a list of two: low side, high side", shown(value));
  return {WallOfScene{words.names.front()}, WallOfScene{words.names.front()}};
}

/// Around a shorter axis a node would be a neighbour of itself.
void check_periodic(Input& input, const std::string& at, const std::string& wall, int cells) {
  constexpr int fewest = 5;
  if (wall != periodic || cells >= fewest || input.describing()) return;
  input.problem(at, "too few cells", fmt::format("at least {} cells along a periodic axis", fewest),
                fmt::format("{} cells", cells));
}

SidesOfScene read_sides(Input& input, std::span<const int> cells, const WallWords& words) {
  const WallOfScene usual{words.names.front()};
  const Json walls = input.raw("walls", schema(words), usual.condition);
  SidesOfScene all(cells.size(), {usual, usual});
  if (walls.is_string() || is_length(walls, words)) {
    const WallOfScene wall = read_side(input, "walls", walls, words);
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
      std::vector<std::string> known(axes.begin(), axes.end());
      known.insert(known.end(), words.lengths.begin(), words.lengths.end());
      input.problem(at, "unknown key", one_of_text(axes), shown(value), input.closest(key, known));
    } else {
      const auto d = static_cast<std::size_t>(axis - axes.begin());
      all[d] = read_axis(input, at, value, words);
      check_periodic(input, at, all[d][0].condition, cells[d]);
    }
  }
  return all;
}

template <int Dim>
Walls<Dim> make_walls(const SidesOfScene& sides, const SystemRegistry& registry) {
  Walls<Dim> walls;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t end = 0; end < 2; ++end) {
      const WallOfScene& side = sides[d][end];
      if (side.condition == periodic) continue;
      const auto& condition = registry.choices<WallCondition>().at(side.condition);
      walls.held[d][end] = condition.held(Dim, static_cast<int>(d));
      if (condition.is_length) walls.per_slip_length[d][end] = 1 / side.length;
    }
  }
  return walls;
}

template <int Dim>
SeparatingSides<Dim> separating_of(const SidesOfScene& sides, const SystemRegistry& registry) {
  SeparatingSides<Dim> separating;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t end = 0; end < 2; ++end) {
      const std::string& condition = sides[d][end].condition;
      if (condition != periodic) separating.side[d][end] = registry.choices<WallCondition>().at(condition).separates;
    }
  }
  return separating;
}

bool any_separates(const SidesOfScene& sides, const WallWords& words) {
  return std::any_of(sides.begin(), sides.end(), [&](const auto& axis) {
    return std::any_of(axis.begin(), axis.end(), [&](const WallOfScene& side) {
      return std::find(words.separating.begin(), words.separating.end(), side.condition) != words.separating.end();
    });
  });
}

WallFriction friction_of(const SidesOfScene& sides, const SystemRegistry& registry) {
  WallFriction friction;
  const auto dimension = static_cast<int>(sides.size());
  for (const auto& axis : sides) {
    for (const WallOfScene& side : axis) {
      if (side.condition == periodic) continue;
      const auto& condition = registry.choices<WallCondition>().at(side.condition);
      const auto sticks = static_cast<std::uint8_t>((1U << dimension) - 1);
      friction.any_side_slips = friction.any_side_slips || condition.held(dimension, 0) != sticks;
      if (side.length > 0) friction.largest_per_length = std::max(friction.largest_per_length, 1 / side.length);
    }
  }
  return friction;
}

/// `"slip"` for all sides, or per axis `{"x": "slip", "y": ["no_slip", {"slip_length": 1e-3}]}`.
Contribution read_walls(Input& input, Scene& scene) {
  const WallWords words = words_of(scene);
  const SidesOfScene sides = read_sides(input, scene.grid.cells, words);
  for (std::size_t d = 0; d < sides.size(); ++d) scene.grid.periodic[d] = sides[d][0].condition == periodic;
  scene.facts.set(friction_of(sides, registry_of(scene)));
  const bool separates = any_separates(sides, words);
  if (separates) scene.facts.set(RepeatsBalances{.at_sides = true});
  return [sides, separates](const Scene& of, Recipe& recipe) {
    with_dimension(of.dimension, [&](auto dim) {
      recipe.constant(make_walls<dim()>(sides, recipe.registry()));
      if (separates) recipe.constant(separating_of<dim()>(sides, recipe.registry()));
    });
  };
}

}  // namespace

void add_walls(SystemRegistry& registry) {
  registry.add<ApplyWallCondition>("apply_wall_condition");
  const auto no_flow_through = [](int, int axis) { return static_cast<std::uint8_t>(1U << axis); };
  registry.add(WallCondition{"slip", "no flow through the wall", no_flow_through});
  registry.add(WallCondition{"no_slip", "no flow at the wall",
                             [](int dimension, int) { return static_cast<std::uint8_t>((1U << dimension) - 1); }});
  registry.add(WallCondition{"slip_length", "friction mu v/b along the wall, {\"slip_length\": b}; conforming",
                             no_flow_through, false, true});
  const auto nothing = [](int, int) { return std::uint8_t{0}; };
  registry.add(WallCondition{"separating", "no flow into the wall and no suction: the liquid may leave it; conforming",
                             nothing, true});
  const auto schemes = [](const SystemRegistry& all) { return schemes_of<WallCondition>(all); };
  registry.add(Part{"walls", "words at the sides of the box", read_walls, schemes});
}

}  // namespace minamo
