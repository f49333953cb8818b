#include "systems/bodies/bodies_part.hpp"

#include "components/vector_text.hpp"
#include "systems/bodies/coupling/attached.hpp"
#include "systems/bodies/coupling/closed_faces.hpp"
#include "systems/bodies/coupling/couple.hpp"
#include "systems/bodies/coupling/cut_friction.hpp"
#include "systems/bodies/coupling/divergence_ahead.hpp"
#include "systems/bodies/coupling/extension.hpp"
#include "systems/bodies/coupling/forces.hpp"
#include "systems/bodies/coupling/wall_flux.hpp"
#include "systems/bodies/geometry/blocks_near.hpp"
#include "systems/bodies/geometry/continue_liquid.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/bodies/geometry/dry_sides.hpp"
#include "systems/bodies/geometry/fill.hpp"
#include "systems/bodies/geometry/hidden_sites.hpp"
#include "systems/bodies/geometry/outlines.hpp"
#include "systems/bodies/geometry/repeats.hpp"
#include "systems/bodies/geometry/sides_around.hpp"
#include "systems/bodies/geometry/solid.hpp"
#include "systems/bodies/geometry/solid_parts.hpp"
#include "systems/bodies/motion/motion.hpp"
#include "systems/bodies/motion/motion_table.hpp"
#include "systems/bodies/motion/read_free.hpp"
#include "systems/bodies/particles/contact.hpp"
#include "systems/bodies/particles/keep_out.hpp"
#include "systems/bodies/particles/room.hpp"
#include "systems/bodies/particles/watch_bodies.hpp"
#include "systems/bodies/read_body_wall.hpp"
#include "systems/grid/grid_of.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/read_shape.hpp"
#include "systems/scene/scene_checks.hpp"
#include "systems/viscosity/friction_choice.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace minamo {

namespace {

ExpressionScope of_time(const Scene& scene) { return {{"t"}, scene.constants}; }

/// The middle of the shape; of an endless one the origin.
template <int Dim>
Vec<Dim> middle_of(const SharedShape<Dim>& shape) {
  if (!shape || !shape->bounds().finite()) return Vec<Dim>::Zero();
  return 0.5 * (shape->bounds().low + shape->bounds().high);
}

template <int Dim>
Prescribed<Dim> read_prescribed(Input& input, const Scene& scene, BodyScene<Dim>& body) {
  Prescribed<Dim> motion;
  motion.velocity =
      input.expressions("velocity", Dim, of_time(scene),
                        {.unit = "m/s", .doc = "of the point that it turns about; in t and constants", .fallback = 0});
  motion.rate = Expression(0);
  input.object("rotation", "turns the body", Input::Presence::only_if_present, [&](Input& in) {
    const auto center =
        in.optional_numbers("center", Dim, {.unit = "m", .doc = "at the start; else the middle of the shape"});
    motion.rate = in.expression("rate", of_time(scene), {.unit = "1/s", .doc = "angular velocity, counter-clockwise"});
    if (center) {
      body.pivot = vec_of<Dim>(*center);
    } else if (in.sound("center") && !in.describing() && body.shape && !body.shape->bounds().finite()) {
      in.problem("center", "missing, and the shape is endless", "the point that the body turns about", "none");
    }
    if constexpr (Dim == 2) {
      motion.axis[0] = 1;
    } else {
      const auto given = in.optional_numbers("axis", 3, {.doc = "of any length but zero; [0, 0, 1] unless given"});
      const Vec<3> axis = given ? vec_of<3>(*given) : Vec<3>::UnitZ();
      if (in.sound("axis") && !in.describing() && axis.norm() == 0) {
        in.problem("axis", "no direction", "a vector that is not zero");
      } else {
        motion.axis = axis.stableNormalized();
      }
    }
  });
  return motion;
}

template <int Dim>
Tabulated<Dim> read_table(Input& input) {
  Tabulated<Dim> table;
  input.object("table", "place by time", Input::Presence::required, [&](Input& in) {
    const auto file = in.path("file", "CSV: time, x, y[, z][, angle in degrees], since the start");
    if (in.describing() || !in.sound("file")) return;
    try {
      table = read_motion_table<Dim>(file);
    } catch (const MotionTableError& error) {
      in.problem("file", error.what(), error.expected, error.got);
    }
  });
  return table;
}

template <int Dim>
void read_motion(Input& input, const Scene& scene, BodyScene<Dim>& body) {
  input.object(
      "motion", "how the body moves; without it, not at all", Input::Presence::only_if_present, [&](Input& motion) {
        motion.one_of("velocities, a table, or what the liquid does to it",
                      {{"prescribed",
                        [&](Input& in) {
                          in.object("prescribed", "moves with a given velocity", Input::Presence::required,
                                    [&](Input& given) { body.motion = read_prescribed<Dim>(given, scene, body); });
                        }},
                       {"table", [&](Input& in) { body.motion = read_table<Dim>(in); }},
                       {"free", [&](Input& in) {
                          in.object("free", "moves with the liquid", Input::Presence::required,
                                    [&](Input& given) { body.motion = read_free<Dim>(given, scene.grid, body); });
                        }}});
      });
}

template <int Dim>
void check_inside(Input& input, const BodyScene<Dim>& body, const GridScene& grid) {
  const Bounds<Dim> bounds = body.shape->bounds();
  const bool may_come_in = body.moves() && body.free() == nullptr;  // what moves a free body is the liquid in the grid
  if (!bounds.finite() || may_come_in) return;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    if (bounds.high[d] > grid.low[axis] && bounds.low[d] < grid.high[axis]) continue;
    input.problem("shape", "outside the grid",
                  fmt::format("a body that reaches into {} = {} ... {} m", "xyz"[d], grid.low[axis], grid.high[axis]),
                  fmt::format("{} = {} ... {} m", "xyz"[d], bounds.low[d], bounds.high[d]));
    return;
  }
}

template <int Dim>
void read_body(Input& input, Scene& scene, BodySet<Dim>& set) {
  BodyScene<Dim> body;
  body.name = input.text("name", {.doc = "its columns are NAME_force_x, NAME_torque, NAME_position_x, ..."});
  input.object("shape", "where the body is at the start", Input::Presence::required,
               [&](Input& shape) { body.shape = read_shape<Dim>(shape, scene, ShapePlace::anywhere); });
  body.wall = read_body_wall(input, scene);
  body.contact_angle = input.optional_number(
      "contact_angle",
      {.unit = "degrees",
       .doc = "with surface_tension: in the liquid, between the body and the free surface at rest; else "
              "that of surface_tension",
       .at_least = 0,
       .at_most = 180});
  body.pivot = middle_of<Dim>(body.shape);
  read_motion<Dim>(input, scene, body);
  if (input.describing() || !body.shape) return;
  if (input.sound("name")) check_column_name(input, body.name, "body", scene);
  check_inside<Dim>(input, body, scene.grid);
  set.bodies.push_back(std::move(body));
}

/// An expression may have no value somewhere, which no comparison of distances would tell.
template <int Dim>
void check_distances(const BodySet<Dim>& set, const Grid<Dim>& grid, SeedProblems& problems) {
  Index<Dim> nodes = grid.cells;
  for (int& along : nodes) ++along;
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const Shape<Dim>& shape = *set.bodies[b].shape;
    if (shape.is_bounded_by_distance()) continue;
    for (std::size_t i = 0; i < rows_in<Dim>(nodes); ++i) {
      const Vec<Dim> x = grid.position(index_in<Dim>(nodes, i));
      const double distance = shape.distance(x);
      if (std::isfinite(distance)) continue;
      problems.note(fmt::format("/bodies/{}/shape", b), "not finite", "a finite distance everywhere in the grid [m]",
                    fmt::format("{} at {}", distance, place_text<Dim>(x)));
      break;
    }
  }
}

/// From where to where a body reaches along an axis; what holds a cavity, like a pipe, or a half space may have no end.
std::string reach_text(char axis, double low, double high) {
  if (std::isfinite(low) && std::isfinite(high)) return fmt::format("{} = {:.4g} ... {:.4g} m", axis, low, high);
  const std::string hole = "not alike at both ends: a hole in it, as in a pipe, must go on beyond both";
  if (std::isfinite(low)) return fmt::format("from {} = {:.4g} m on without end, {}", axis, low, hole);
  if (std::isfinite(high)) return fmt::format("without end up to {} = {:.4g} m, {}", axis, high, hole);
  return fmt::format("without end along {}, {}", axis, hole);
}

/// Liquid flows over the ends of a periodic axis, a body does not.
template <int Dim>
void check_repeats(const BodySet<Dim>& set, World& world, SeedProblems& problems) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  const double reach = reach_over_ends<Dim>(grid, world.resource<Splines<Dim>>());
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    const auto& body = set.bodies[b];
    const auto ends = axis_where_it_ends<Dim>(*body.shape, {body.pivot, body.pivot, Mat<Dim>::Identity()}, grid, reach);
    if (!ends) continue;
    const Bounds<Dim> bounds = body.shape->bounds();
    const auto axis = static_cast<Eigen::Index>(*ends);
    const char name = "xyz"[*ends];
    problems.note(
        fmt::format("/bodies/{}/shape", b), fmt::format("not the same at both ends of periodic {}", name),
        fmt::format("a body {0:.4g} m or more from both ends, or one that reaches as far over one as over the "
                    "other, {0:.4g} m or more",
                    reach),
        reach_text(name, bounds.low[axis], bounds.high[axis]));
  }
}

template <int Dim>
void seed_bodies(BodySet<Dim> set, World& world) {
  const Grid<Dim>& grid = world.resource<Grid<Dim>>();
  if (set.any_is_free()) {
    for (auto& body : set.bodies) {
      if (body.shape->bounds().finite()) body.surface = surface_points<Dim>(*body.shape, point_spacing * grid.spacing);
    }
  }
  world.resource<BodyOutlines<Dim>>() = outlines_of<Dim>(set, {grid.low, grid.high}, grid.spacing);
  set.parts_liquid = parts_liquid<Dim>(set, world.resource<BodyOutlines<Dim>>(), grid);
  world.resource<BodySet<Dim>>() = set;
  world.resource<StaticCut<Dim>>() = cut_by_bodies_at_rest<Dim>(set, grid, world.resource<Splines<Dim>>());
  if (set.rubs)
    world.resource<FrictionAtRest<Dim>>() = friction_at_rest<Dim>(set, grid, world.resource<Splines<Dim>>());
  world.resize<Bodies>(set.bodies.size());
  for (std::size_t b = 0; b < set.bodies.size(); ++b) {
    world.column<body::Position<Dim>>()[b] = set.bodies[b].pivot;
    world.column<body::Rotation<Dim>>()[b] = Mat<Dim>::Identity();
    std::tie(world.column<body::Velocity<Dim>>()[b], world.column<body::Spin<Dim>>()[b]) =
        velocity_at<Dim>(set.bodies[b], 0);
    world.column<body::Angle<Dim>>()[b].setZero();
    world.column<body::Work>()[b] = 0;
    world.column<body::StopImpulse<Dim>>()[b].setZero();
  }
}

/// \return whether a wall is so thin that it has any
template <int Dim>
bool seed_dry_sides(const BodiesOfScene& bodies, const Scene& scene, Recipe& recipe) {
  const auto dry =
      dry_sides_of<Dim>(bodies.of<Dim>(), grid_of<Dim>(scene.grid), scene.facts.get<Discretization>().degree);
  if (!dry) return false;
  recipe.seed([dry](const Scene&, World& world, SeedProblems&) { world.resource<DrySides<Dim>>() = *dry; });
  return true;
}

void seed_with_bodies(const BodiesOfScene& bodies, const Scene& scene, Recipe& recipe) {
  const bool rubs = finds_friction(bodies, scene);
  const bool any_is_thin =
      with_dimension(scene.dimension, [&](auto dim) { return seed_dry_sides<dim()>(bodies, scene, recipe); });
  if (any_is_thin) {
    for (const char* system : {"find_dry_sides", "split_cells", "number_hidden_sites"}) recipe.add("sort", system);
  }
  with_dimension(scene.dimension, [&](auto dim) {
    constexpr int Dim = dim();
    BodySet<Dim> set = bodies.of<Dim>();
    set.rubs = rubs;
    for (auto& body : set.bodies) body.wall = wall_on_grid(body.wall, friction_of(scene), scene.grid.spacing);
    recipe.seed([set](const Scene&, World& world, SeedProblems& problems) {
      check_distances<Dim>(set, world.resource<Grid<Dim>>(), problems);
      check_repeats<Dim>(set, world, problems);
      seed_bodies<Dim>(set, world);
    });
  });
}

/// The shortest slip length of a scene, those of bodies included, tells how friction is solved; one that is told
/// from none by no liquid says no more than that.
void set_wall_friction(const BodiesOfScene& bodies, Scene& scene) {
  WallFriction friction = scene.facts.get<WallFriction>();
  const auto take = [&](const auto& set) {
    for (const auto& body : set.bodies) {
      if (body.wall.kind == BodyWall::Kind::slip_length)
        friction.largest_per_length = std::max(friction.largest_per_length,
                                               1 / std::max(body.wall.slip_length, sticks_below * scene.grid.spacing));
    }
  };
  take(bodies.in_plane);
  take(bodies.in_space);
  scene.facts.set(friction);
}

Contribution read_bodies(Input& input, Scene& scene) {
  BodiesOfScene bodies;
  const auto is_there = input.elements("bodies").value_or(0) > 0;
  input.list("bodies", "solids in the liquid", 0, [&](Input& in, std::size_t) {
    with_dimension(scene.dimension, [&](auto dim) { read_body<dim()>(in, scene, bodies.of<dim()>()); });
  });
  if (!is_there || input.describing()) return {};
  scene.facts.set(bodies);
  set_wall_friction(bodies, scene);
  if (bodies.in_plane.any_separates() || bodies.in_space.any_separates()) {
    const auto* sides = scene.facts.find<RepeatsBalances>();
    scene.facts.set(RepeatsBalances{.at_sides = sides != nullptr && sides->at_sides, .at_bodies = true});
  }
  return [bodies](const Scene& of, Recipe& recipe) { seed_with_bodies(bodies, of, recipe); };
}

}  // namespace

bool finds_friction(const BodiesOfScene& bodies, const Scene& scene) {
  const Friction friction = friction_of(scene);
  const bool any_rubs = bodies.in_plane.any_rubs() || bodies.in_space.any_rubs();
  return friction == Friction::in_balances || (friction == Friction::at_start && any_rubs);
}

void add_bodies(SystemRegistry& registry) {
  registry.add<PlaceBodies>("place_bodies", OnRanks::alike_on_all);
  registry.add<RequireRepeats>("require_repeats", OnRanks::alike_on_all);
  registry.add<FindDrySides>("find_dry_sides", OnRanks::adds_up);
  registry.add<SplitCells>("split_cells", OnRanks::own);
  registry.add<NumberHiddenSites>("number_hidden_sites", OnRanks::own);
  registry.add<FindBlocksNearBodies>("find_blocks_near_bodies", OnRanks::own);
  registry.add<CutFaces>("cut_faces", OnRanks::own);
  registry.add<FindFaceExtension>("find_face_extension", OnRanks::adds_up);
  registry.add<FindCutFriction>("find_cut_friction", OnRanks::own);
  registry.add<ExtendOldVelocity>("extend_old_velocity", OnRanks::own);
  registry.add<FindDivergenceAhead>("find_divergence_ahead", OnRanks::adds_up);
  registry.add<FillNearBodies>("fill_near_bodies", OnRanks::own);
  registry.add<ContinueLiquid>("continue_liquid", OnRanks::exchanges);
  registry.add<FindUncutMass>("find_uncut_mass", OnRanks::exchanges);
  registry.add<FindAttachedMass>("find_attached_mass", OnRanks::own);
  registry.add<CoupleFreeBodies>("couple_free_bodies", OnRanks::adds_up);
  registry.add<PushBodies>("push_bodies", OnRanks::adds_up);
  registry.add<MoveBodies>("move_bodies", OnRanks::alike_on_all);
  registry.add<FindSolidParts>("find_solid_parts", OnRanks::own);
  registry.add<KeepOutOfBodies>("keep_out_of_bodies", OnRanks::adds_up);
  registry.add<CountStops>("count_stops", OnRanks::alike_on_all);
  registry.add<CountClosedFaces>("count_closed_faces", OnRanks::adds_up);
  registry.add<MeasureBodies>("measure_bodies", OnRanks::alike_on_all);
  registry.add<MeasureBodiesAtStart>("measure_bodies_at_start", OnRanks::alike_on_all);
  registry.add<WatchBodies>("watch_bodies", OnRanks::adds_up);
  registry.add<StopAtPlates>("stop_at_plates", OnRanks::adds_up);
  registry.add<RequireRoom>("require_room", OnRanks::adds_up);
  registry.add<RenewWallFlux>("renew_wall_flux", OnRanks::own);
  registry.add<ExtendBalanceVelocity>("extend_balance_velocity", OnRanks::own);
  registry.add(Part{"bodies", "solids in the liquid", read_bodies});
}

}  // namespace minamo
