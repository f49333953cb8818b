#include "systems/pipeline.hpp"

namespace minamo {

namespace {

struct Slot {
  std::string name;
  std::vector<std::string> systems;
};

/// What a scene needs, asked of the scene once.
struct Needs {
  const TransferScheme& transfer;
  std::string quadrature;
  std::string stabilization;
  std::string volume;
  std::string solver;
  bool newmark;
  bool corrected_inertia;
  bool viscous;
  bool body_force;
  bool uniform_force;
  bool ode;
  bool exact_velocity;
  bool exact_pressure;
  bool probes;

  explicit Needs(const Scene& scene)
      : transfer(scene.transfer_scheme),
        quadrature(scene.quadrature),
        stabilization(scene.stabilization),
        volume(scene.volume),
        solver(scene.solver),
        newmark(scene.integrator == "newmark"),
        corrected_inertia(scene.corrected_inertia),
        viscous(scene.viscosity > 0),
        body_force(has_body_force(scene)),
        uniform_force(has_uniform_force(scene)),
        ode(!scene.ode.empty()),
        exact_velocity(!scene.exact.velocity.empty()),
        exact_pressure(scene.exact.pressure.has_value()),
        probes(!scene.probes.empty()) {}
};

/// `systems`, and `more` if `needed`.
std::vector<std::string> with(std::vector<std::string> systems, bool needed, const std::string& more) {
  if (needed) systems.push_back(more);
  return systems;
}

void append(std::vector<std::string>& systems, const std::vector<std::string>& more) {
  systems.insert(systems.end(), more.begin(), more.end());
}

/// Volume and capacity of the nodes that particles touch where they are.
std::vector<std::string> node_volume_systems() { return {"gather_node_volume", "find_advected_capacity"}; }

std::vector<std::string> force_systems(const Needs& needs) {
  if (needs.uniform_force) return {needs.ode ? "uniform_body_force_ode" : "uniform_body_force", "move_ballistic_nodes"};
  return {needs.ode ? "sample_body_force_ode" : "sample_body_force", "p2g_body_force", "move_ballistic_nodes"};
}

/// VMS adds a bulk viscosity even to an inviscid liquid.
bool needs_viscosity_matrix(const Needs& needs) { return needs.viscous || needs.stabilization == "vms"; }

std::vector<std::string> material_systems(const Needs& needs) {
  return {"set_material", needs.stabilization == "vms" ? "find_tau_vms" : "find_tau"};
}

std::vector<std::string> assemble_systems(const Needs& needs) {
  std::vector<std::string> systems;
  if (needs.quadrature == "mixed") systems.emplace_back("find_filled_nodes");
  systems.emplace_back("moments");
  if (needs.stabilization == "oss") {
    append(systems, {"p2g_pressure_gradient", "divergence_matrix_oss"});
  } else {
    systems.emplace_back("divergence_matrix");
  }
  systems.emplace_back(needs_viscosity_matrix(needs) ? "viscosity_matrix" : "laplacian_matrix");
  systems.emplace_back("right_hand_side");
  const std::string viscous = needs_viscosity_matrix(needs) ? "_viscous" : "";
  if (needs.solver == "umfpack") systems.push_back("assemble_monolithic" + viscous);
  if (needs.corrected_inertia) systems.emplace_back("add_inertia_correction");
  return systems;
}

std::vector<std::string> solve_systems(const Needs& needs) {
  const bool block = needs.solver == "block";
  std::vector<std::string> systems{"solve_" + needs.solver + (block && needs_viscosity_matrix(needs) ? "_viscous" : ""),
                                   "unpack_solution"};
  if (needs.stabilization == "oss") systems.emplace_back("g2p_pressure_gradient");
  return systems;
}

std::vector<std::string> measure_systems(const Needs& needs, const std::string& probes) {
  std::vector<std::string> systems{"measure_energy",
                                   needs.transfer.carries_gradient ? "measure_momentum_affine" : "measure_momentum",
                                   "measure_max_speed", "measure_divergence"};
  append(systems, node_volume_systems());
  systems.emplace_back("measure_overlap");
  // Their order is that of the columns.
  if (needs.probes) systems.push_back(probes);
  if (needs.exact_velocity) systems.emplace_back(needs.ode ? "measure_error_velocity_ode" : "measure_error_velocity");
  if (needs.exact_pressure) {
    systems.emplace_back("sample_pressure");
    systems.emplace_back(needs.ode ? "measure_error_pressure_ode" : "measure_error_pressure");
  }
  return systems;
}

/// Without a body force nothing is lifted.
bool limits_shift(const Needs& needs) { return needs.volume == "projection" && needs.body_force; }

std::vector<std::string> volume_systems(const Needs& needs) {
  if (needs.volume == "projection") {
    std::vector<std::string> systems = node_volume_systems();
    append(systems, {"find_volume_excess", "solve_volume_" + needs.solver});
    if (limits_shift(needs)) systems.emplace_back("limit_shift");
    systems.emplace_back("shift_particles");
    return systems;
  }
  if (needs.volume == "delta") return with(node_volume_systems(), true, "shift_by_delta");
  return {};
}

/// Not with newmark, whose configuration lags behind by more than what this mends.
bool carries_gradient_along(const Needs& needs) { return needs.corrected_inertia && !needs.newmark; }

bool needs_liquid_indicator(const Needs& needs) {
  return needs.corrected_inertia || needs.transfer.reads_liquid_indicator;
}

std::vector<std::string> p2g_systems(const Needs& needs) {
  std::vector<std::string> systems{"p2g_mass"};
  if (needs_liquid_indicator(needs)) systems.emplace_back("find_liquid_cells");
  if (carries_gradient_along(needs)) systems.emplace_back("carry_gradient_to_middle");
  append(systems, needs.transfer.p2g_velocity);
  if (needs.newmark) append(systems, needs.transfer.p2g_acceleration);
  return systems;
}

std::vector<std::string> g2p_systems(const Needs& needs) {
  std::vector<std::string> systems = needs.transfer.g2p_velocity;
  if (needs.newmark) append(systems, needs.transfer.g2p_acceleration);
  if (carries_gradient_along(needs)) systems.emplace_back("carry_gradient_to_end");
  if (needs.corrected_inertia) systems.emplace_back("g2p_force_gradient");
  return systems;
}

std::vector<Slot> step_slots(const Needs& needs) {
  return {
      {"configure", with({needs.newmark ? "place_quadrature_at_start" : "place_quadrature_at_middle"},
                         limits_shift(needs), "store_kinetic_energy")},
      {"bin", {"bin", "number_nodes", "find_capacity"}},
      {"p2g", p2g_systems(needs)},
      {"walls", with({"activate", "find_neighbours", "apply_wall_condition"}, needs.newmark,
                     "apply_wall_condition_acceleration")},
      {"predict", with({needs.newmark ? "predict_newmark" : "predict_midpoint"}, needs.ode, "integrate_ode")},
      {"force", force_systems(needs)},
      {"material", material_systems(needs)},
      {"assemble", with(assemble_systems(needs), !needs.newmark, "damp_divergence")},
      {"solve", solve_systems(needs)},
      {"correct", {needs.newmark ? "correct_newmark" : "correct_midpoint"}},
      {"g2p", g2p_systems(needs)},
      {"advect", {"advect"}},
      {"volume", volume_systems(needs)},
      {"measure", measure_systems(needs, "measure_probes")},
      {"history", {"accept_step", "write_history"}},
  };
}

/// A backward Euler step on a configuration beside x^0 that leaves the particles where they are.
std::vector<std::string> standing_step(const Needs& needs, const std::string& configure) {
  std::vector<std::string> systems{configure, "bin", "number_nodes", "find_capacity", "p2g_mass"};
  if (needs_liquid_indicator(needs)) systems.emplace_back("find_liquid_cells");
  append(systems, needs.transfer.p2g_velocity);
  append(systems, {"activate", "find_neighbours", "apply_wall_condition", "predict_backward_euler"});
  for (const auto& part :
       {force_systems(needs), material_systems(needs), assemble_systems(needs), solve_systems(needs)})
    append(systems, part);
  return systems;
}

std::vector<std::string> start_systems(const Needs& needs) {
  std::vector<std::string> systems;
  const std::string beside = needs.newmark ? "place_quadrature_step_before" : "place_quadrature_step_ahead";
  if (needs.ode) append(systems, {"hold_ode"});
  if (needs.corrected_inertia) {
    append(systems, standing_step(needs, beside));
    append(systems, {"correct_backward_euler_velocity", "g2p_force_gradient"});
  }
  if (needs.newmark) {
    append(systems, standing_step(needs, beside));
    append(systems, {"correct_backward_euler"});
    append(systems, needs.transfer.g2p_acceleration);
  }
  // The pressure that the first frame shows.
  append(systems, standing_step(needs, "place_quadrature_step_ahead"));
  append(systems, measure_systems(needs, "measure_probes_at_start"));
  append(systems, {"write_history"});
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
  static const std::vector<std::string> names{"configure", "bin",      "p2g",      "walls",   "predict",
                                              "force",     "material", "assemble", "solve",   "correct",
                                              "g2p",       "advect",   "volume",   "measure", "history"};
  return names;
}

Pipeline make_pipeline(const Scene& scene, const SystemRegistry& registry) {
  const Needs needs(scene);
  const auto make = [&](const std::vector<std::string>& names, std::vector<System>& into) {
    for (const std::string& name : names) {
      const auto configured = scene.configured.find(name);
      into.push_back(configured != scene.configured.end() ? configured->second : registry.make(name, scene.dimension));
    }
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
