#include "systems/step/fit_for_ranks.hpp"

#include <algorithm>
#include <set>

namespace minamo {

namespace {

const std::set<std::string, std::less<>> fit{
    // between ranks
    "migrate_particles", "find_ghost_cells", "plan_site_exchange", "keep_former_rows", "ask_for_former_rows",
    "solve_multipliers_petsc", "solve_friction",
    // add up at sites that ranks share
    "p2g_faces_pic", "p2g_faces_tpic", "p2g_faces_tpic2", "filter_faces_xpic", "filter_faces_fmpm",
    "p2g_face_acceleration_pic", "p2g_face_acceleration_tpic", "p2g_face_force", "p2g_multipliers", "find_fill",
    "find_face_density", "find_pressure_acceleration", "find_exact_share", "find_liquid_surface", "find_exact_volume",
    "rub_faces", "add_face_inertia", "fill_parts", "recover_pressure",
    // over all particles or faces
    "limit_particle_shift", "count_face_force_work", "accept_step_on_faces", "measure_energy", "measure_momentum",
    "measure_max_speed", "measure_error_velocity", "measure_error_pressure", "measure_face_divergence",
    "measure_multiplier_overlap", "watch_volume", "find_viscosity", "measure_probes_on_faces",
    "measure_probes_on_faces_at_start", "measure_gauges", "pass_meters",
    // alike on all ranks
    "hold_ode", "integrate_ode", "begin_energy_given", "measure_energy_balance", "measure_meters",
    // the first rank writes
    "write_history", "flush_history", "write_frame", "write_xdmf", "write_surfaces",
    // of own particles, cells, and sites
    "place_quadrature_at_middle", "place_quadrature_at_start", "place_quadrature_step_before",
    "place_quadrature_step_ahead", "store_kinetic_energy", "bin_by_cell", "number_sites", "hold_faces",
    "hold_face_accelerations", "predict_faces_midpoint", "predict_faces_backward_euler", "predict_faces_newmark",
    "uniform_face_force", "sample_body_force", "find_cell_viscosity", "find_liquid_cells_by_multipliers",
    "find_mobility", "find_mobility_mixed", "shear_particles", "find_cell_viscosity_by_particles",
    "find_cell_viscosity_of_fluids", "keep_balance_velocity", "keep_pressure", "assemble_multipliers", "face_source",
    "add_exact_pressure", "damp_face_divergence", "face_volume_source", "project_faces", "correct_faces_midpoint",
    "correct_faces_newmark", "watch_turns_of_faces", "watch_move", "correct_faces_backward_euler", "g2p_faces_pic",
    "g2p_faces_flip", "g2p_faces_tpic", "g2p_faces_tpic2", "g2p_faces_apic", "g2p_faces_xpic", "g2p_faces_fmpm",
    "g2p_face_acceleration_pic", "g2p_face_acceleration_tpic", "g2p_face_acceleration_apic", "limit_gradient",
    "carry_gradient_by_faces", "g2p_face_force_gradient", "advect_by_faces", "stir_particles", "gather_face_shift",
    "apply_particle_shift", "soak_velocity", "soak_gradient", "note_step", "keep_former_positions"};

}  // namespace

void require_fit_for_ranks(const Pipeline& pipeline, const std::string& scene) {
  std::set<std::string> others;
  for (const auto* systems : {&pipeline.start, &pipeline.step, &pipeline.output}) {
    for (const System& system : *systems) {
      if (!fit.contains(system.name)) others.insert(system.name);
    }
  }
  std::vector<Problem> problems;
  for (const std::string& system : others) {
    problems.push_back({scene,
                        {},
                        "a system of this scene does not run on several ranks",
                        "systems that do, or one process",
                        shown(Json(system)),
                        {}});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace minamo
