#include "tools/program/summary.hpp"

#include "components/energy_given.hpp"
#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "components/step.hpp"
#include "engine/run/communicator.hpp"
#include "engine/run/step_control.hpp"
#include "systems/measure/acceptance.hpp"
#include "systems/output/history.hpp"
#include "systems/ranks/rank_map.hpp"
#include "systems/time/body_force.hpp"
#include "systems/time/turns.hpp"
#include "tools/program/version.hpp"

#include "minamo_version.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace minamo {

namespace {

using Json = nlohmann::ordered_json;

const char* status(Ending ending) {
  switch (ending) {
  case Ending::done:
    return "done";
  case Ending::interrupted:
    return "interrupted";
  case Ending::failed:
    return "failed";
  }
  return "";
}

/// Sums over the ranks.
Json of_all(Communicator& ranks, const Effort& effort) {
  return {{"compute_s", ranks.sum(effort.compute)},
          {"messages", ranks.sum(effort.messages)},
          {"bytes", ranks.sum(effort.bytes)},
          {"collectives", ranks.sum(effort.collectives)}};
}

Json system_rows(const Profiler& profiler, double wall_seconds) {
  Json rows = Json::array();
  for (const Profiler::Row& row : profiler.rows()) {
    rows.push_back({{"name", row.name},
                    {"calls", row.calls},
                    {"seconds", row.seconds},
                    {"declared_bytes", row.bytes},
                    {"share", wall_seconds > 0 ? row.seconds / wall_seconds : 0}});
    if (Communicator* ranks = all_ranks()) rows.back().update(of_all(*ranks, row.effort));
  }
  return rows;
}

/// In 2-D momentum has two components and angular momentum one.
Json conserved(const RunTotals::Values& values, bool in_plane) {
  const std::span momentum = std::span(values.momentum).first(in_plane ? 2 : 3);
  const std::span angular = std::span(values.angular_momentum).first(in_plane ? 1 : 3);
  return {{"momentum", std::vector(momentum.begin(), momentum.end())},
          {"angular_momentum", std::vector(angular.begin(), angular.end())},
          {"energy", values.energy}};
}

/// Of the last row of the history that has them.
Json last_errors(const RunTotals& totals) {
  Json errors = Json::object();
  if (!std::isnan(totals.error_velocity)) errors["velocity"] = totals.error_velocity;
  if (!std::isnan(totals.error_pressure)) errors["pressure"] = totals.error_pressure;
  return errors;
}

/// Over all ranks. [kg]
double total_mass(World& world) {
  double mass = 0;
  for (const double m : world.column<particle::Mass>()) mass += m;
  return sum_over_ranks(mass);
}

}  // namespace

double energy_rise(World& world) {
  const double mass = total_mass(world);
  const bool in_plane = world.has<Grid<2>>();
  const double h = in_plane ? world.resource<Grid<2>>().spacing : world.resource<Grid<3>>().spacing;
  const double slow = 1e-6 * h / world.resource<Clock>().step;
  double weight = mass * size_of_constant_force(world.resource<BodyForce>());
  if (world.has<EnergyGiven>()) weight = std::max(weight, world.resource<EnergyGiven>().weight);
  return totals_of_all_rows(world).energy.share(mass * slow * slow + 0.01 * h * weight);
}

Json make_summary(const std::string& scene, const Outcome& outcome, int threads, double end, const Stopwatch& stopwatch,
                  const Profiler& profiler, World& world) {
  const Clock& clock = world.resource<Clock>();
  const RunTotals& totals = totals_of_all_rows(world);
  const StepTotals& steps = world.resource<StepTotals>();
  const double wall = stopwatch.wall_seconds();
  const double mass = total_mass(world);
  Json summary{{"scene", scene}, {"status", status(outcome.ending)}};
  if (!outcome.message.empty()) summary["message"] = outcome.message;
  summary.update({{"steps", clock.index},
                  {"time", clock.time},
                  {"end", end},
                  {"complete", clock.time >= end},
                  {"rejected_steps", world.resource<StepControl>().rejected},
                  {"wall_s", wall},
                  {"cpu_s", stopwatch.cpu_seconds()},
                  {"threads", threads},
                  {"cpu_model", cpu_model()},
                  {"version", version},
                  {"build", build_facts()},
                  {"particles", sum_over_ranks(static_cast<std::int64_t>(world.rows<Particles>()))},
                  {"clamped", world.resource<Clamped>().count},
                  {"active_nodes_max", steps.active_nodes_max},
                  {"unknowns_max", steps.unknowns_max},
                  {"peak_memory_bytes", peak_memory()},
                  {"systems", system_rows(profiler, wall)}});
  if (world.has<Turns>()) summary["pressure_turns"] = world.resource<Turns>().longest;
  const bool in_plane = world.has<Grid<2>>();
  if (Communicator* ranks = all_ranks()) {
    const Effort effort = ranks->effort();
    Json of_ranks{{"count", ranks->size()}};
    of_ranks.update(of_all(*ranks, effort));
    of_ranks["most_compute_s"] = ranks->largest(effort.compute);
    of_ranks["imbalance"] = world.resource<RankMap>().largest_imbalance;
    of_ranks["peak_memory_bytes"] = static_cast<std::int64_t>(ranks->largest(static_cast<double>(peak_memory())));
    summary["ranks"] = of_ranks;
  }
  Json conservation{{"mass", mass}};
  conservation.update(conserved(totals.last, in_plane));
  conservation["overlap_max"] = steps.overlap_max;
  conservation["energy_rise"] = energy_rise(world);
  conservation["initial"] = conserved(totals.first, in_plane);
  summary["conservation"] = conservation;
  summary["errors"] = last_errors(totals);
  return summary;
}

}  // namespace minamo
