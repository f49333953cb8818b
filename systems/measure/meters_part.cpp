#include "systems/measure/meters.hpp"
#include "systems/measure/own_column.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/read_shape.hpp"
#include "systems/scene/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>

namespace minamo {

namespace {

/// How far the box reaches to either side of a plane, the less of the two. [m]
template <int Dim>
double room_around(const GridScene& grid, const Vec<Dim>& point, const Vec<Dim>& normal) {
  double below = 0;
  double above = 0;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    const double to_low = (grid.low[axis] - point[d]) * normal[d];
    const double to_high = (grid.high[axis] - point[d]) * normal[d];
    below += std::min(to_low, to_high);
    above += std::max(to_low, to_high);
  }
  return std::min(-below, above);
}

template <int Dim>
void read_plane(Input& input, const Scene& scene, typename Meters<Dim>::Meter& meter) {
  const auto point = input.numbers("point", Dim, {.unit = "m", .doc = "that the plane goes through"});
  const auto normal =
      input.numbers("normal", Dim, {.doc = "in the direction that counts as positive, of any length but zero"});
  if (input.describing() || !input.sound("point") || !input.sound("normal")) return;
  meter.point = vec_of<Dim>(point);
  meter.normal = vec_of<Dim>(normal);
  if (meter.normal.norm() == 0) {
    input.problem("normal", "no direction", "a vector that is not zero");
    return;
  }
  meter.normal.stableNormalize();
  if (scene.grid.spacing == 0) return;  // the grid has problems of its own
  constexpr double least = 1e-3;        // of a cell: what passes sooner is at the side already
  meter.width = std::min(scene.grid.spacing, room_around<Dim>(scene.grid, meter.point, meter.normal));
  if (meter.width < least * scene.grid.spacing)
    input.problem("point", "the plane does not pass the inside of the box", "a plane with liquid on both sides of it");
}

template <int Dim>
void read_meter(Input& input, Scene& scene, Meters<Dim>& meters) {
  typename Meters<Dim>::Meter meter;
  meter.name = input.text("name", {.doc = "its columns are NAME and NAME_volume"});
  input.object("plane", "a plane, in two dimensions a line", Input::Presence::required,
               [&](Input& in) { read_plane<Dim>(in, scene, meter); });
  input.object("within", "a shape: what passes the plane outside of it does not count",
               Input::Presence::only_if_present,
               [&](Input& in) { meter.within = read_shape<Dim>(in, scene, ShapePlace::anywhere); });
  if (input.describing()) return;
  if (input.sound("name")) check_own_column(input, meter.name, "meter", scene);
  meters.meters.push_back(std::move(meter));
}

void seed_meters(World& world, std::size_t meters) {
  world.resize<MeterRows>(meters);
  for (std::size_t k = 0; k < meters; ++k) {
    world.column<meter::Volume>()[k] = 0;
    world.column<meter::Rate>()[k] = std::numeric_limits<double>::quiet_NaN();
  }
}

template <int Dim>
Contribution read_meters_in(Input& input, Scene& scene) {
  Meters<Dim> meters;
  input.list("meters", "planes whose flow rate goes into the history", 0,
             [&](Input& in, std::size_t) { read_meter<Dim>(in, scene, meters); });
  if (meters.meters.empty()) return {};
  return [meters](const Scene&, Recipe& recipe) {
    recipe.constant(meters);
    recipe.seed(
        [count = meters.meters.size()](const Scene&, World& world, SeedProblems&) { seed_meters(world, count); });
  };
}

Contribution read_meters(Input& input, Scene& scene) {
  return with_dimension(scene.dimension, [&](auto dim) { return read_meters_in<dim()>(input, scene); });
}

}  // namespace

void add_meters(SystemRegistry& registry) {
  registry.add<KeepFormerPositions>("keep_former_positions", OnRanks::own);
  registry.add<PassMeters>("pass_meters", OnRanks::adds_up);
  registry.add<MeasureMeters>("measure_meters", OnRanks::alike_on_all);
  registry.add(Part{"meters", "planes whose flow rate goes into the history", read_meters});
}

}  // namespace minamo
