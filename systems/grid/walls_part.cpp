#include "components/contact.hpp"
#include "components/grid.hpp"
#include "systems/grid/walls.hpp"
#include "systems/parts.hpp"
#include "systems/setup/discretization.hpp"
#include "systems/setup/schemes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <map>

namespace minamo {

namespace {

constexpr std::string_view periodic = "periodic";
const std::vector<std::string> axis_names{"x", "y", "z"};

/// What the sides of a scene may be.
struct Conditions {
  std::vector<std::string> names;       ///< given as a name
  std::vector<std::string> lengths;     ///< given as {name: slip length}
  std::vector<std::string> separating;  ///< of the names, those that let the liquid leave
  bool is_conforming = true;            ///< only that discretization has walls with a length and separating ones
  double shortest = 0;                  ///< length that is told from none [m]
  std::map<std::string, double> constants;
};

Conditions conditions_of(const Scene& scene) {
  Conditions conditions;
  for (const WallCondition& condition : registry_of(scene).in_order<WallCondition>()) {
    (condition.is_length ? conditions.lengths : conditions.names).push_back(condition.name);
    if (condition.separates) conditions.separating.push_back(condition.name);
  }
  conditions.is_conforming = is_conforming(scene);
  conditions.shortest = 1e-9 * scene.grid.spacing;
  conditions.constants = scene.constants;
  return conditions;
}

/// The names that the discretization has, and `more`.
std::vector<std::string> known_names(const Conditions& conditions, const std::vector<std::string>& more = {}) {
  std::vector<std::string> known;
  for (const std::string& name : conditions.names) {
    const bool separates =
        std::find(conditions.separating.begin(), conditions.separating.end(), name) != conditions.separating.end();
    if (conditions.is_conforming || !separates) known.push_back(name);
  }
  known.insert(known.end(), more.begin(), more.end());
  return known;
}

/// A side of the box.
struct Side {
  std::string condition;
  double length = 0;  ///< of those that have one [m]
};

/// What reads {"slip_length": 1e-3}, once for values, messages and schema.
Side read_length(Input& input, const Conditions& conditions) {
  Side side;
  Input::Variants variants;
  for (const std::string& name : conditions.lengths) {
    variants.emplace_back(name, [&, name](Input& in) {
      const double length =
          in.number(name, {.unit = "m", .doc = "depth below the wall at which the velocity would vanish", .above = 0});
      side = {name, length};
    });
  }
  input.one_of("a wall that rubs", variants);
  return side;
}

Json length_schema(const Conditions& conditions) {
  auto description = Input::Document::describe();
  description.root().use_constants({});
  read_length(description.root(), conditions);
  Json schema = description.schema();
  schema.erase("$schema");
  return schema;
}

Json schema(const Conditions& conditions) {
  const auto one_of = [&](std::vector<std::string> names, bool with_periodic) {
    if (with_periodic) names.emplace_back(periodic);
    return Json{{"oneOf", {{{"enum", names}}, length_schema(conditions)}}};
  };
  const Json sides{{"type", "array"}, {"items", one_of(conditions.names, false)}, {"minItems", 2}, {"maxItems", 2}};
  Json axis = one_of(conditions.names, true);
  axis["oneOf"].push_back(sides);
  Json axes{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  for (const std::string& x : axis_names) axes["properties"][x] = axis;
  return {
      {"description",
       R"("slip" or "no_slip" for all sides, or per axis {"x": "slip"}, {"x": "periodic"}, or [low side, high side]; )"
       R"(with the conforming discretization also "separating" and {"slip_length": m})"},
      {"type", {"string", "object"}},
      {"oneOf", {{{"enum", conditions.names}}, length_schema(conditions), axes}}};
}

/// Low and high side per axis.
using Sides = std::vector<std::array<Side, 2>>;

/// Whether an object is a wall, and not a wall per axis.
bool is_length(const Json& value, const Conditions& conditions) {
  return value.is_object() && std::any_of(conditions.lengths.begin(), conditions.lengths.end(),
                                          [&](const std::string& name) { return value.contains(name); });
}

/// The problems of an object of its own are those of the scene at a place.
Side read_length_at(Input& input, const std::string& at, const Json& value, const Conditions& conditions) {
  if (!conditions.is_conforming) {
    input.problem(
        at, "a slip length needs the conforming discretization",
        fmt::format(R"({}, or "discretization": {{"scheme": "conforming"}})", one_of_text(known_names(conditions))),
        shown(value));
    return {conditions.names.front()};
  }
  Input::Document document(value, "");
  document.root().use_constants(conditions.constants);
  Side side = read_length(document.root(), conditions);
  document.finish();
  for (const Problem& problem : document.problems()) {
    input.problem(at + problem.pointer, problem.what, problem.expected, problem.got, problem.closest);
  }
  if (!document.problems().empty()) return {conditions.names.front()};
  if (side.length >= conditions.shortest) return side;
  input.problem(at, "a slip length that is none",
                fmt::format(R"(at least {:.3g} m, or "no_slip")", conditions.shortest), shown(value));
  return {conditions.names.front()};
}

/// `at` is the place of the value, as Input::problem() takes it.
Side read_wall(Input& input, const std::string& at, const Json& value, const Conditions& conditions,
               const std::vector<std::string>& names) {
  if (value.is_object()) return read_length_at(input, at, value, conditions);
  const std::string name = value.is_string() ? value.get<std::string>() : "";
  if (std::find(names.begin(), names.end(), name) != names.end()) return {name};
  const bool separates =
      std::find(conditions.separating.begin(), conditions.separating.end(), name) != conditions.separating.end();
  if (separates && !conditions.is_conforming) {
    input.problem(at, "a wall that the liquid may leave needs the conforming discretization",
                  fmt::format(R"({}, or "discretization": {{"scheme": "conforming"}})", one_of_text(names)),
                  shown(value));
  } else {
    input.problem(at, value.is_string() ? "unknown name" : "wrong type", one_of_text(names), shown(value),
                  closest_name(name, names));
  }
  return {names.front()};
}

std::array<Side, 2> read_axis(Input& input, const std::string& at, const Json& value, const Conditions& conditions) {
  if (!value.is_array()) {
    const Side both = read_wall(input, at, value, conditions, known_names(conditions, {std::string(periodic)}));
    return {both, both};
  }
  if (value.size() == 2) {
    return {read_wall(input, at + "/0", value[0], conditions, known_names(conditions)),
            read_wall(input, at + "/1", value[1], conditions, known_names(conditions))};
  }
  input.problem(at, "wrong length", "one wall, or a list of two: low side, high side", shown(value));
  return {Side{conditions.names.front()}, Side{conditions.names.front()}};
}

/// Around a shorter axis a node would be a neighbour of itself.
void check_periodic(Input& input, const std::string& at, const std::string& wall, int cells) {
  constexpr int fewest = 5;
  if (wall != periodic || cells >= fewest || input.describing()) return;
  input.problem(at, "too few cells", fmt::format("at least {} cells along a periodic axis", fewest),
                fmt::format("{} cells", cells));
}

Sides read_sides(Input& input, std::span<const int> cells, const Conditions& conditions) {
  const Side usual{conditions.names.front()};
  const Json walls = input.raw("walls", schema(conditions), usual.condition);
  Sides all(cells.size(), {usual, usual});
  if (walls.is_string() || is_length(walls, conditions)) {
    const Side wall = read_wall(input, "walls", walls, conditions, known_names(conditions));
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
      known.insert(known.end(), conditions.lengths.begin(), conditions.lengths.end());
      input.problem(at, "unknown key", one_of_text(axes), shown(value), closest_name(key, known));
    } else {
      const auto d = static_cast<std::size_t>(axis - axes.begin());
      all[d] = read_axis(input, at, value, conditions);
      check_periodic(input, at, all[d][0].condition, cells[d]);
    }
  }
  return all;
}

template <int Dim>
Walls<Dim> make_walls(const Sides& sides, const SystemRegistry& registry) {
  Walls<Dim> walls;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t end = 0; end < 2; ++end) {
      const Side& side = sides[d][end];
      if (side.condition == periodic) continue;
      const auto& condition = registry.choices<WallCondition>().at(side.condition);
      walls.held[d][end] = condition.held(Dim, static_cast<int>(d));
      if (condition.is_length) walls.per_slip_length[d][end] = 1 / side.length;
    }
  }
  return walls;
}

template <int Dim>
SeparatingSides<Dim> separating_of(const Sides& sides, const SystemRegistry& registry) {
  SeparatingSides<Dim> separating;
  for (std::size_t d = 0; d < Dim; ++d) {
    for (std::size_t end = 0; end < 2; ++end) {
      const std::string& condition = sides[d][end].condition;
      if (condition != periodic) separating.side[d][end] = registry.choices<WallCondition>().at(condition).separates;
    }
  }
  return separating;
}

bool any_separates(const Sides& sides, const Conditions& conditions) {
  return std::any_of(sides.begin(), sides.end(), [&](const auto& axis) {
    return std::any_of(axis.begin(), axis.end(), [&](const Side& side) {
      return std::find(conditions.separating.begin(), conditions.separating.end(), side.condition) !=
             conditions.separating.end();
    });
  });
}

WallFriction friction_of(const Sides& sides) {
  WallFriction friction;
  for (const auto& axis : sides) {
    for (const Side& side : axis) {
      if (side.length > 0) friction.largest_per_length = std::max(friction.largest_per_length, 1 / side.length);
    }
  }
  return friction;
}

/// `"slip"` for all sides, or per axis `{"x": "slip", "y": ["no_slip", {"slip_length": 1e-3}]}`.
Contribution read_walls(Input& input, Scene& scene) {
  const Conditions conditions = conditions_of(scene);
  const Sides sides = read_sides(input, scene.grid.cells, conditions);
  for (std::size_t d = 0; d < sides.size(); ++d) scene.grid.periodic[d] = sides[d][0].condition == periodic;
  scene.facts.set(friction_of(sides));
  const bool separates = any_separates(sides, conditions);
  if (separates) scene.facts.set(RepeatsBalances{.at_sides = true});
  return [sides, separates](const Scene& of, Recipe& recipe) {
    add_systems(of, recipe, "boundaries", {{"apply_wall_condition"}, {"hold_faces"}});
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
  registry.add(Part{"walls", "conditions at the sides of the box", read_walls, schemes});
}

}  // namespace minamo
