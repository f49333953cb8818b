#include "systems/bodies/read_body_wall.hpp"

#include "systems/grid/read_wall.hpp"

#include <algorithm>

namespace minamo {

BodyWall read_body_wall(Input& input, const Scene& scene) {
  const WallWords words{.names = {"slip", "no_slip", "separating"},
                        .lengths = {"slip_length"},
                        .separating = {"separating"},
                        .shortest = 1e-9 * scene.grid.spacing,
                        .constants = scene.constants};
  const Json schema{
      {"description", R"(what its surface does to the liquid: "slip", "no_slip", "separating" or {"slip_length": m})"},
      {"oneOf", {{{"enum", words.names}}, slip_length_schema(words)}}};
  const WallOfScene side = read_wall(input, "wall", input.raw("wall", schema, "slip"), words, words.names);
  if (side.length > 0) return {BodyWall::Kind::slip_length, side.length};
  if (side.condition == "no_slip") return {BodyWall::Kind::no_slip};
  return {side.condition == "slip" ? BodyWall::Kind::slip : BodyWall::Kind::separating};
}

BodyWall wall_on_grid(const BodyWall& wall, Friction friction, double spacing) {
  if (wall.kind == BodyWall::Kind::slip || wall.kind == BodyWall::Kind::separating) return wall;
  if (friction == Friction::at_start) {
    constexpr double film = 0.05;
    return {BodyWall::Kind::slip_length, std::max(wall.slip_length, film * spacing)};
  }
  constexpr double least = 0.2;
  if (wall.slip_length < sticks_below * spacing) return {BodyWall::Kind::no_slip};
  return {BodyWall::Kind::slip_length, std::max(wall.slip_length, least * spacing)};
}

}  // namespace minamo
