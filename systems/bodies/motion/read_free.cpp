#include "systems/bodies/motion/read_free.hpp"

#include "systems/bodies/geometry/solid.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace minamo {

namespace {

template <int Dim>
std::vector<std::string> names_of_motions() {
  if constexpr (Dim == 2) return {"x", "y", "rotation"};
  return {"x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};
}

/// "rotation" stands for all three in 3-D, too.
template <int Dim>
void read_locked(Input& input, Free<Dim>& free) {
  auto names = names_of_motions<Dim>();
  if constexpr (Dim == 3) names.push_back("rotation");
  const Json schema = {{"type", "array"},
                       {"description", "motions that the body does not take part in"},
                       {"items", {{"enum", names}}},
                       {"uniqueItems", true}};
  const Json locked = input.raw("locked", schema, Json::array());
  if (input.describing()) return;
  if (!locked.is_array()) {
    input.problem("locked", "wrong type", "a list of some of " + listed(names), shown(locked));
    return;
  }
  for (const Json& element : locked) {
    const auto name = element.is_string() ? element.template get<std::string>() : std::string();
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end()) {
      input.problem("locked", "not a motion", "a list of some of " + listed(names), shown(element),
                    input.closest(name, names));
      return;
    }
    const auto c = static_cast<std::size_t>(known - names.begin());
    if (c < free.locked.size()) {
      free.locked[c] = true;
    } else {
      std::fill(free.locked.begin() + Dim, free.locked.end(), true);
    }
  }
  if (std::all_of(free.locked.begin(), free.locked.end(), [](bool is_locked) { return is_locked; }))
    input.problem("locked", "no motion is left", "a motion that is not locked, or a body without \"motion\"",
                  shown(locked));
}

template <int Dim>
Spring<Dim> read_spring(Input& input) {
  Spring<Dim> spring;
  input.object("spring", "draws the centre of mass to a point", Input::Presence::only_if_present, [&](Input& in) {
    spring.to = vec_of<Dim>(in.numbers("to", Dim, {.unit = "m", .doc = "where the spring is at rest"}));
    spring.stiffness = in.number(
        "stiffness", {.unit = "N/m; N/m^2 in 2-D", .doc = "force per distance", .fallback = 0, .at_least = 0});
    spring.damping = in.number(
        "damping", {.unit = "N s/m; N s/m^2 in 2-D", .doc = "force per velocity", .fallback = 0, .at_least = 0});
  });
  return spring;
}

/// Mass and inertia, of the density or as given.
template <int Dim>
void read_mass(Input& input, const Solid<Dim>& solid, Free<Dim>& free) {
  const bool is_2d = Dim == 2;
  input.one_of(
      "of the body",
      {{"density", [&](Input& in) { free.mass = solid.volume * in.number("density", {.unit = "kg/m^3", .above = 0}); }},
       {"mass", [&](Input& in) { free.mass = in.number("mass", {.unit = is_2d ? "kg/m" : "kg", .above = 0}); }}});
  if (solid.volume > 0) free.inertia = free.mass / solid.volume * solid.inertia;
  const auto given = input.optional_numbers(
      "inertia", rotations<Dim>,
      {.unit = is_2d ? "kg m" : "kg m^2",
       .doc = "about the centre of mass, in 3-D about x, y and z; else that of a homogeneous body",
       .above = 0});
  if (given) free.inertia = vec_of<rotations<Dim>>(*given).asDiagonal();
}

}  // namespace

template <int Dim>
Free<Dim> read_free(Input& input, const GridScene& grid, BodyScene<Dim>& body) {
  Free<Dim> free;
  Solid<Dim> solid;
  if (std::find(grid.periodic.begin(), grid.periodic.end(), true) != grid.periodic.end())
    input.problem("", "not with periodic sides", "a grid with walls all around", "periodic");
  if (body.shape && !input.describing()) {
    if (!body.shape->bounds().finite()) {
      input.problem("", "endless", "a shape with an end", "a shape without one");
    } else {
      solid = solid_of<Dim>(*body.shape);
      if (solid.volume == 0) input.problem("", "no volume", "a shape with a volume", "0");
      body.pivot = solid.centre;
    }
  }
  read_mass<Dim>(input, solid, free);
  free.velocity = vec_of<Dim>(
      input.numbers("velocity", Dim, {.unit = "m/s", .doc = "of the centre of mass at the start", .fallback = 0}));
  if constexpr (Dim == 2) {
    free.spin[0] = input.number("rotation", {.unit = "1/s", .doc = "angular velocity at the start", .fallback = 0});
  } else {
    free.spin =
        vec_of<3>(input.numbers("rotation", 3, {.unit = "1/s", .doc = "angular velocity at the start", .fallback = 0}));
  }
  read_locked<Dim>(input, free);
  for (std::size_t c = 0; c < free.locked.size(); ++c) {
    auto& start = c < Dim ? free.velocity[static_cast<Eigen::Index>(c)] : free.spin[static_cast<Eigen::Index>(c) - Dim];
    if (free.locked[c] && start != 0) {
      input.problem(c < Dim ? "velocity" : "rotation", "moves along what is locked",
                    fmt::format("0 along \"{}\"", names_of_motions<Dim>()[c]));
    }
  }
  free.spring = read_spring<Dim>(input);
  return free;
}

template Free<2> read_free<2>(Input&, const GridScene&, BodyScene<2>&);
template Free<3> read_free<3>(Input&, const GridScene&, BodyScene<3>&);

}  // namespace minamo
