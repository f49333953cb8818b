#include "tools/program/outlook.hpp"

#include "components/fluid.hpp"
#include "components/particle.hpp"
#include "systems/openings/openings_part.hpp"
#include "systems/output/frame_size.hpp"
#include "systems/scene/time_counts.hpp"
#include "systems/step/memory.hpp"
#include "systems/step/time_plan.hpp"
#include "systems/surface_tension/capillary_step.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace minamo {

namespace {

/// What the liquid is driven by, at the start.
struct Drive {
  double speed = 0;  ///< of the fastest particle [m/s]
  double force = 0;  ///< |b| in the middle of the box [m/s^2]
  double work = 0;   ///< of the force across the box, per mass [m^2/s^2]
};

template <int Dim>
Drive drive_of(const Scene& scene, World& world) {
  Drive drive;
  for (const Vec<Dim>& v : world.column<particle::Velocity<Dim>>()) drive.speed = std::max(drive.speed, v.norm());
  const Vec<Dim> low = vec_of<Dim>(scene.grid.low);
  const Vec<Dim> high = vec_of<Dim>(scene.grid.high);
  Arguments arguments(scene.start);
  const Vec<Dim> middle = 0.5 * (low + high);
  const Vec<Dim> b = vector_at<Dim>(scene.facts.get<BodyForce>().of_place_and_time, arguments.at<Dim>(middle));
  drive.force = b.norm();
  // Along a periodic axis nothing ends the fall; that it gets as fast as across the box is as good a guess as any.
  drive.work = b.cwiseAbs().dot(high - low);
  return drive;
}

bool is_near(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); }

/// Whether a step is no longer because waves would grow in a liquid at rest, (E34).
bool is_for_rest(const Scene& scene, const Drive& drive, double step) {
  const auto gravity = gravity_step(scene, drive.speed, drive.force);
  return gravity && is_near(step, *gravity);
}

/// Why a step that the CFL number has chosen is no longer.
std::string limit_of(const Scene& scene, const Drive& drive, double step) {
  if (scene.time.max_step && is_near(step, *scene.time.max_step)) return "max_step";
  if (const auto capillary = capillary_step(scene); capillary && is_near(step, *capillary))
    return "waves of surface tension, (E116)";
  if (is_for_rest(scene, drive, step)) return "waves of a liquid at rest";
  if (is_near(step, scene.output.every)) return "the time from one frame to the next";
  const double distance = scene.time.cfl * scene.grid.spacing;
  const std::string cells = fmt::format("CFL number {}", scene.time.cfl);
  if (drive.speed * step >= 0.5 * distance)
    return fmt::format("{}: the fastest particle, {:.3g} m/s", cells, drive.speed);
  if (drive.force * step * step + drive.speed * step >= 0.5 * distance)
    return fmt::format("{}: the body force, {:.3g} m/s^2, which makes it faster", cells, drive.force);
  return fmt::format("{}: bodies, or what comes in", cells);
}

/// The step that a run begins with, and why it is no longer. Where a run would refuse to choose one, it is none.
void foresee_step(const Scene& scene, World& world, const Drive& drive, Outlook& outlook) {
  const TimePlan plan = make_time_plan(scene);
  outlook.falls = drive.work > 0;
  outlook.speed_of_fall = std::sqrt(drive.speed * drive.speed + 2 * drive.work);
  if (plan.step) {
    outlook.step = std::min(*plan.step, scene.time.end);
    outlook.limit = "time.step";
    outlook.steps = steps_of(scene.time).value_or(0);
    outlook.steps_are_known = true;
    return;
  }
  try {
    outlook.step = plan.choose_step(world);
  } catch (const std::runtime_error& refused) {
    outlook.limit = refused.what();
    return;
  }
  outlook.limit = limit_of(scene, drive, outlook.step);
  // That limits less once the liquid falls.
  const double limit = is_for_rest(scene, drive, outlook.step)
                           ? gravity_step(scene, outlook.speed_of_fall, drive.force).value_or(outlook.step)
                           : outlook.step;
  const double later = std::min(limit, step_of_cfl(scene, outlook.speed_of_fall, 0));
  if (later > 0) outlook.steps = std::ceil(scene.time.end / later);
}

/// As many as fit into the box where liquid comes in.
double most_particles_of(const Scene& scene, double particles) {
  const auto* openings = scene.facts.find<OpeningsOfScene>();
  if (!openings || !has_inflow(*openings)) return particles;
  double places = 1;
  for (const int cells : scene.grid.cells) places *= static_cast<double>(cells) * most_per_cell(*openings);
  return std::max(particles, places);
}

double history_bytes(const Scene& scene, double steps) {
  constexpr double of_row = 250;  // sixteen columns of up to 22 characters, half of them short
  return of_row * (1 + steps / static_cast<double>(scene.output.history));
}

std::string extents_text(const GridScene& grid) {
  std::vector<std::string> extents;
  for (std::size_t d = 0; d < grid.low.size(); ++d)
    extents.push_back(fmt::format("{:.6g} m", grid.high[d] - grid.low[d]));
  return fmt::format("{}", fmt::join(extents, " x "));
}

std::string step_text(const Outlook& outlook, const Scene& scene) {
  if (outlook.step == 0) return "none can be chosen: " + outlook.limit;
  const double v = outlook.speed_of_fall;
  const std::string when = outlook.falls ? "after a fall through the box" : "as at the start";
  if (outlook.steps_are_known) {
    const std::string given = fmt::format("{:.4g} s as given, {:.6g} steps", outlook.step, outlook.steps);
    if (v == 0) return given;
    return given +
           fmt::format("; at {:.3g} m/s, {}, {:.2g} cells a step", v, when, v * outlook.step / scene.grid.spacing);
  }
  const std::string chosen =
      fmt::format("{:.4g} s at first, limited by {}; about {:.3g} steps", outlook.step, outlook.limit, outlook.steps);
  return v == 0 ? chosen : chosen + fmt::format(" at {:.3g} m/s, {}", v, when);
}

std::string disk_text(const Outlook& outlook, const Scene& scene) {
  std::error_code unknown;
  const auto here = std::filesystem::space(".", unknown);
  const std::string free =
      unknown ? "" : fmt::format(" of {} free here", bytes_text(static_cast<double>(here.available)));
  const std::string surfaces = scene.output.surface == "none" ? "" : ", and surfaces";
  return fmt::format("about {}{}: frames of {}, history, checkpoint{}", bytes_text(outlook.disk_bytes), free,
                     bytes_text(outlook.frame_bytes), surfaces);
}

}  // namespace

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.3g} kB", bytes / 1e3);
  const char* unit = "MB";
  double value = bytes / 1e6;
  for (const char* larger : {"GB", "TB"}) {
    if (value < 1e3) break;
    value /= 1e3;
    unit = larger;
  }
  return fmt::format("{:.3g} {}", value, unit);
}

Outlook outlook_of(const Scene& scene, World& world, const AvailableMemory& available) {
  Outlook outlook;
  const Drive drive = with_dimension(scene.dimension, [&](auto dim) { return drive_of<dim()>(scene, world); });
  outlook.particles = static_cast<double>(world.rows<Particles>());
  outlook.most_particles = most_particles_of(scene, outlook.particles);
  foresee_step(scene, world, drive, outlook);
  outlook.frames = frames_of(scene.time, scene.output);
  outlook.frame_bytes = frame_bytes(scene, world) * outlook.most_particles / std::max(1.0, outlook.particles);
  outlook.disk_bytes =
      outlook.frames * outlook.frame_bytes + history_bytes(scene, outlook.steps) + checkpoint_bytes(world);
  outlook.memory_bytes = memory_of(scene, size_of(scene));
  outlook.available = available;
  return outlook;
}

std::string text_of(const Outlook& outlook, const Scene& scene) {
  const GridScene& grid = scene.grid;
  std::string liquid = fmt::format("{:.0f} particles", outlook.particles);
  if (outlook.most_particles > outlook.particles)
    liquid += fmt::format(", up to {:.3g} if what comes in fills the box", outlook.most_particles);
  std::string text;
  const auto add = [&](std::string_view what, const std::string& line) {
    text += fmt::format("  {:8} {}\n", what, line);
  };
  add("grid",
      fmt::format("{} cells of {:.6g} m, a box of {}", fmt::join(grid.cells, " x "), grid.spacing, extents_text(grid)));
  add("liquid", liquid);
  add("step", step_text(outlook, scene));
  const bool at_every_step = outlook.steps_are_known && outlook.frames > outlook.steps;
  const std::string when = at_every_step ? "at every step" : fmt::format("every {:.6g} s", scene.output.every);
  add("frames", fmt::format("{:.6g}, one {} up to {:.6g} s", outlook.frames, when, scene.time.end));
  add("memory", fmt::format("about {} of {}, {}", bytes_text(outlook.memory_bytes), bytes_text(outlook.available.bytes),
                            outlook.available.source));
  add("disk", disk_text(outlook, scene));
  return text;
}

}  // namespace minamo
