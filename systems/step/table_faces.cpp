#include "systems/step/conditions.hpp"

namespace minamo {

const StepTable& table_of_faces() {
  using namespace condition;
  constexpr When both = When::always;
  constexpr When step = When::step;
  constexpr When start = When::standing;
  static const StepTable table{
      .rows =
          {
              {"start", "hold_ode", both, {ode_variables}},

              {"configure", "place_bodies", step, {bodies}},
              {"configure", "require_repeats", step, {moving_bodies, periodic}},
              {"configure", "let_in", step, {openings}},
              {"configure", "give_gradient", step, {openings, gradients}},
              {"configure", "place_quadrature_at_middle", step, {midpoint}},
              {"configure", "place_quadrature_at_start", step, {newmark}},
              {"configure", "store_kinetic_energy", step, {projection}},
              {"configure", "stop_at_plates", step, {bodies}},

              {"sort", "keep_former_rows", both, {several_ranks, rows_remember}},
              {"sort", "migrate_particles", both, {several_ranks}},
              {"sort", "bin_by_cell"},
              {"sort", "place_bodies", start, {bodies}},
              {"sort", "find_dry_sides", both, {asked}},  // of bodies with a thin wall, as what it hides
              {"sort", "split_cells", both, {asked}},
              {"sort", "find_blocks_near_bodies", both, {several_ranks, bodies}},
              {"sort", "find_ghost_cells", both, {several_ranks}},
              {"sort", "number_sites"},
              {"sort", "number_hidden_sites", both, {asked}},
              {"sort", "plan_site_exchange", both, {several_ranks}},
              {"sort", "ask_for_former_rows", both, {several_ranks, rows_remember}},
              // Bodies extend velocities to faces that no opening holds.
              {"sort", "open_faces", both, {openings}},
              {"sort", "cut_faces", both, {bodies}},
              {"sort", "find_face_extension", both, {bodies}},
              {"sort", "find_cut_friction", both, {bodies, friction_of_bodies}},
              {"sort", "find_separating_faces", both, {separating_sides}},
              {"sort", "find_separating_rows", both, {separating_bodies}},

              {"p2g", "p2g_multipliers"},
              {"p2g", "find_face_density", both, {several_densities}},
              {"p2g", "<p2g_velocity>"},
              {"p2g", "<p2g_acceleration>", step, {newmark}},
              {"p2g", "fill_empty_faces", both, {separating_bodies}},
              {"p2g", "keep_former_positions", step, {meters}},

              {"boundaries", "hold_faces"},
              {"boundaries", "hold_inflow", both, {openings}},
              {"boundaries", "extend_old_velocity", both, {bodies}},
              {"boundaries", "fill_at_openings", both, {openings}},
              {"boundaries", "pass_inflow", both, {openings, bodies}},
              {"boundaries", "hold_face_accelerations", step, {newmark}},
              {"boundaries", "watch_lid", step, {asked}},  // where there is a weight
              {"boundaries", "stop_old_velocity_at_sides", both, {separating_sides}},

              {"predict", "predict_faces_midpoint", step, {midpoint}},
              {"predict", "predict_faces_newmark", step, {newmark}},
              {"predict", "predict_faces_backward_euler", start, {midpoint_or_newmark}},

              {"forces", "integrate_ode", step, {ode_variables}},
              {"forces", "uniform_face_force", both, {force_in_time}},
              {"forces", "sample_body_force", both, {force_of_place}},
              {"forces", "p2g_face_force", both, {force_of_place}},
              {"forces", "prescribe_inflow", both, {openings}},

              {"material", "find_fill"},
              {"material", "shear_particles", both, {shear_dependent}},
              {"material", "fill_near_bodies", both, {bodies}},
              {"material", "find_divergence_ahead", both, {bodies}},
              {"material", "find_uncut_mass", both, {bodies}},
              {"material", "find_attached_mass", both, {bodies}},
              {"material", "find_liquid_cells_by_multipliers", both, {liquid_cells}},
              {"material", "find_surface_distance", both, {surface_tension}},
              {"material", "extend_surface_distance", both, {surface_tension, bodies}},
              {"material", "find_free_surface", both, {surface_tension}},
              {"material", "measure_surface_around", both, {surface_tension}},
              {"material", "find_surface_traction", both, {surface_tension}},

              {"assemble", "find_mobility_mixed", both, {mixed_or_exact}},
              {"assemble", "find_mobility", both, {by_particles}},
              {"assemble", "find_pressure_acceleration", both, {exact}},
              {"assemble", "find_exact_share", both, {exact}},
              {"assemble", "find_liquid_surface", both, {exact}},
              {"assemble", "continue_liquid", both, {exact, bodies}},
              {"assemble", "find_unseen_liquid", both, {exact, no_bodies}},
              {"assemble", "find_exact_volume", both, {exact}},
              {"assemble", "find_unseen_force", both, {exact, no_bodies}},
              {"assemble", "add_exact_pressure", both, {exact}},
              {"assemble", "assemble_multipliers"},
              {"assemble", "<cell_viscosity>", both, {viscous}},  // behind fill_near_bodies
              {"assemble", "rub_faces", both, {explicit_viscosity}},
              {"assemble", "add_face_inertia", both, {inertia}},
              {"assemble", "add_surface_tension", both, {surface_tension}},
              {"assemble", "push_at_openings", both, {openings}},

              {"right_hand_side", "face_source"},
              {"right_hand_side", "damp_face_divergence", step, {midpoint}},
              {"right_hand_side", "face_volume_source", step, {projection}},
              {"right_hand_side", "start_contact_of_sides", both, {separating_sides}},
              {"right_hand_side", "start_contact_of_bodies", both, {separating_bodies}},

              {"solve", "<solve>", both, {no_separating}},
              {"solve", "couple_free_bodies", both, {no_separating, free_bodies}},
              {"solve", "<project>", both, {no_separating}},
              {"solve", "<solve_viscosity>", both, {no_separating, implicit_viscosity}},
              {"solve", "keep_balance_velocity", both, {no_separating, implicit_viscosity, iterated_viscosity}},
              {"solve", "<find_viscosity>", both, {no_separating, implicit_viscosity, iterated_viscosity}},
              {"<find_viscosity>", "shear_particles_again"},
              {"<find_viscosity>", "<cell_viscosity>"},
              {"<find_viscosity>", "<solve_viscosity>"},
              {"<find_viscosity>", "compare_balance_velocity"},
              {"solve", "<find_contact>", both, {separating}},
              {"<find_contact>", "hold_contact_of_sides", both, {separating_sides}},
              {"<find_contact>", "release_from_bodies", both, {separating_bodies}},
              {"<find_contact>", "assemble_multipliers"},
              {"<find_contact>", "fill_contact_source"},
              {"<find_contact>", "detach_from_bodies", both, {separating_bodies}},
              {"<find_contact>", "damp_face_divergence", step, {midpoint}},
              {"<find_contact>", "face_volume_source", step, {projection}},
              {"<find_contact>", "limit_volume_source_at_sides", both, {separating_sides}},
              {"<find_contact>", "<solve>"},
              {"<find_contact>", "couple_free_bodies", both, {free_bodies}},
              {"<find_contact>", "<project>"},
              {"<find_contact>", "compare_contact_of_sides", both, {separating_sides}},
              {"<find_contact>", "compare_contact_of_bodies", both, {separating_bodies}},
              {"<find_contact>", "end_contact_pass"},
              {"solve", "keep_contact_of_sides", both, {separating_sides}},
              {"solve", "require_room", step, {bodies}},
              {"solve", "renew_wall_flux", step, {free_bodies}},
              // Before velocities are extended to faces that bodies close. These are extended in standing steps, too:
              // particles take a force gradient from them.
              {"solve", "measure_face_divergence", both, {bodies}},
              {"solve", "extend_balance_velocity", both, {bodies}},
              // With bodies, require_room adds up what both do.
              {"solve", "require_outlet", step, {openings, no_bodies}},

              {"correct", "push_bodies", step, {bodies}},
              {"correct", "correct_faces_midpoint", step, {midpoint}},
              {"correct", "correct_faces_newmark", step, {newmark}},
              {"correct", "watch_turns_of_faces", step, {newmark}},
              {"correct", "stop_new_velocity_at_sides", step, {separating_sides}},
              {"correct", "take_opening_velocities", step, {openings}},

              {"g2p", "<g2p_velocity>", step},
              {"g2p", "limit_gradient", step, {gradients}},
              {"g2p", "soak_velocity", step, {sponge}},
              {"g2p", "soak_gradient", step, {sponge, gradients}},
              {"g2p", "<g2p_acceleration>", step, {newmark}},

              {"advect", "count_closed_faces", step, {bodies}},
              {"advect", "move_bodies", step, {bodies}},
              {"advect", "carry_gradient_by_faces", step, {inertia, moving_gradients}},
              {"advect", "g2p_face_force_gradient", step, {inertia}},
              {"advect", "advect_by_faces", step},

              {"volume", "find_solid_parts", step, {projection, bodies}},
              {"volume", "fill_parts", step, {projection}},
              {"volume", "stir_particles", step, {projection}},
              {"volume", "gather_face_shift", step, {projection}},
              {"volume", "limit_particle_shift", step, {projection, some_force}},  // else nothing is lifted
              {"volume", "apply_particle_shift", step, {projection}},

              {"accept", "recover_pressure", both, {rheology_of_pressure}},
              {"accept", "keep_pressure", both, {rheology_of_pressure}},
              {"accept", "keep_out_of_bodies", step, {bodies}},
              {"accept", "count_stops", step, {bodies}},
              {"accept", "measure_multiplier_overlap"},
              {"accept", "pass_meters", step, {meters}},
              {"accept", "accept_step_on_faces", step},
              {"accept", "note_step"},
              {"accept", "move_columns", step, {openings}},
              {"accept", "let_out", step, {openings}},

              {"measure", "measure_bodies", step, {bodies}},
              {"measure", "measure_bodies_at_start", start, {bodies}},
              {"measure", "watch_bodies", step, {bodies}},
              {"measure", "measure_energy"},
              {"measure", "measure_momentum"},
              {"measure", "measure_max_speed"},
              {"measure", "watch_move", step, {fixed_step}},
              {"measure", "measure_face_divergence", both, {no_bodies}},
              {"measure", "watch_volume"},
              {"measure", "measure_surface_energy", step, {surface_tension}},
              {"measure", "measure_surface_energy_at_start", start, {surface_tension}},
              {"measure", "measure_contact", both, {separating}},
              {"measure", "measure_energy_balance"},
              {"measure", "recover_pressure", both, {some_pressure}},
              {"measure", "measure_probes_on_faces", step, {probes}},
              {"measure", "measure_probes_on_faces_at_start", start, {probes}},
              {"measure", "measure_gauges", both, {gauges}},
              {"measure", "measure_meters", both, {meters}},
              {"measure", "measure_patches", both, {patches}},
              {"measure", "measure_error_velocity", both, {exact_velocity}},
              {"measure", "measure_error_pressure", both, {exact_pressure}},
              {"measure", "measure_openings", step, {openings}},
              {"measure", "measure_openings_at_start", start, {openings}},

              {"record", "write_history"},

              {"output", "flush_history"},
              {"output", "recover_pressure"},
              {"output", "write_frame"},
              {"output", "write_bodies", both, {bodies}},
              {"output", "write_surfaces", both, {surfaces}},
              {"output", "write_xdmf"},
          },
      .standing = {{{inertia}, {"correct_faces_backward_euler", "g2p_face_force_gradient"}},
                   {{newmark}, {"correct_faces_backward_euler", "<g2p_acceleration>"}}}};
  return table;
}

}  // namespace minamo
