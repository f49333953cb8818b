#include "systems/pipeline.hpp"

#include "systems/transfer/scheme.hpp"

#include <algorithm>

namespace minamo {

namespace {

struct Slot {
  std::string name;
  std::vector<std::string> systems;
};

/// What a scene needs, asked of the scene once.
struct Needs {
  const TransferScheme& transfer;
  std::string volume;
  bool newmark;
  bool viscous;
  bool uniform_force;

  explicit Needs(const Scene& scene)
      : transfer(transfer_scheme(scene.transfer)),
        volume(scene.volume),
        newmark(scene.integrator == "newmark"),
        viscous(scene.viscosity > 0) {
    uniform_force = std::none_of(scene.body_force.begin(), scene.body_force.end(), [](const Expression& b) {
      return b.uses("x") || b.uses("y") || b.uses("z");
    });
  }
};

std::vector<std::string> force_systems(const Needs& needs) {
  if (needs.uniform_force) return {"uniform_body_force", "free_flight"};
  return {"sample_body_force", "p2g_body_force", "free_flight"};
}

std::vector<std::string> assemble_systems(const Needs& needs) {
  std::vector<std::string> systems{"moments", "divergence_matrix", "laplacian_matrix"};
  if (needs.viscous) systems.emplace_back("viscosity_matrix");
  systems.emplace_back("pspg");
  systems.emplace_back(needs.viscous ? "assemble_monolithic_viscous" : "assemble_monolithic");
  return systems;
}

std::vector<std::string> measure_systems(const Needs& needs) {
  return {"measure_energy", needs.transfer.carries_gradient ? "measure_momentum_affine" : "measure_momentum",
          "measure_max_speed", "measure_divergence", "measure_overlap"};
}

std::vector<std::string> volume_systems(const Needs& needs) {
  if (needs.volume == "projection") {
    return {"gather_node_volume", "find_volume_excess", "solve_volume_umfpack", "shift_particles"};
  }
  return {};
}

/// `systems`, and `more` if `needed`.
std::vector<std::string> with(std::vector<std::string> systems, bool needed, const std::string& more) {
  if (needed) systems.push_back(more);
  return systems;
}

std::vector<Slot> step_slots(const Needs& needs) {
  const TransferScheme& transfer = needs.transfer;
  return {
      {"configure", {needs.newmark ? "configure_at_start" : "configure_at_middle"}},
      {"bin", {"bin"}},
      {"p2g", with({"p2g_mass", transfer.p2g_velocity}, needs.newmark, transfer.p2g_acceleration)},
      {"walls", with({"activate", "hold_velocity_at_walls"}, needs.newmark, "hold_acceleration_at_walls")},
      {"predict", {needs.newmark ? "predict_newmark" : "predict_midpoint"}},
      {"force", force_systems(needs)},
      {"assemble", assemble_systems(needs)},
      {"solve", {"solve_umfpack", "unpack_solution"}},
      {"correct", {needs.newmark ? "correct_newmark" : "correct_midpoint"}},
      {"g2p", with({transfer.g2p_velocity}, needs.newmark, transfer.g2p_acceleration)},
      {"advect", {"advect"}},
      {"volume", volume_systems(needs)},
      {"measure", measure_systems(needs)},
      {"history", {"write_history"}},
  };
}

/// A backward Euler step on a configuration beside x^0 that leaves the particles where they are.
std::vector<std::string> standing_step(const Needs& needs, const std::string& configure) {
  std::vector<std::string> systems{configure, "bin", "p2g_mass", needs.transfer.p2g_velocity, "activate",
                                   "hold_velocity_at_walls", "predict_backward_euler"};
  for (const auto& part : {force_systems(needs), assemble_systems(needs)}) {
    systems.insert(systems.end(), part.begin(), part.end());
  }
  systems.insert(systems.end(), {"solve_umfpack", "unpack_solution"});
  return systems;
}

std::vector<std::string> start_systems(const Needs& needs) {
  std::vector<std::string> systems;
  if (needs.newmark) {
    systems = standing_step(needs, "configure_step_before");
    systems.insert(systems.end(), {"correct_backward_euler", needs.transfer.g2p_acceleration});
  }
  // The pressure that the first frame shows.
  const auto pressure = standing_step(needs, "configure_step_ahead");
  systems.insert(systems.end(), pressure.begin(), pressure.end());
  const auto measures = measure_systems(needs);
  systems.insert(systems.end(), measures.begin(), measures.end());
  systems.emplace_back("write_history");
  return systems;
}

std::vector<std::string> output_systems(const Needs& needs) {
  std::vector<std::string> systems{"sample_pressure", "write_frame"};
  if (needs.transfer.carries_gradient) systems.emplace_back("write_velocity_gradient");
  systems.emplace_back("write_xdmf");
  return systems;
}

}  // namespace

const std::vector<std::string>& slot_names() {
  static const std::vector<std::string> names{"configure", "bin",     "p2g", "walls",  "predict", "force",  "assemble",
                                              "solve",     "correct", "g2p", "advect", "volume", "measure", "history"};
  return names;
}

Pipeline make_pipeline(const Scene& scene, const SystemRegistry& registry) {
  const Needs needs(scene);
  const auto make = [&](const std::vector<std::string>& names, std::vector<System>& into) {
    for (const std::string& name : names) into.push_back(registry.make(name, scene.dimension));
  };
  Pipeline pipeline;
  make(start_systems(needs), pipeline.start);
  for (const Slot& slot : step_slots(needs)) {
    make(slot.systems, pipeline.step);
    for (const ExtraSystem& extra : scene.systems) {
      if (extra.after == slot.name) pipeline.step.push_back(extra.system);
    }
  }
  make(output_systems(needs), pipeline.output);
  return pipeline;
}

}  // namespace minamo
