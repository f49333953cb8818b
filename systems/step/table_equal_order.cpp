#include "systems/step/conditions.hpp"

namespace minamo {

const StepTable& table_of_equal_order() {
  using namespace condition;
  constexpr When both = When::always;
  constexpr When step = When::step;
  constexpr When start = When::standing;
  static const StepTable table{
      .rows =
          {
              {"start", "hold_ode", both, {ode_variables}},

              {"configure", "place_quadrature_at_middle", step, {midpoint}},
              {"configure", "place_quadrature_at_start", step, {newmark}},
              {"configure", "store_kinetic_energy", step, {projection, some_force}},

              {"sort", "bin"},
              {"sort", "number_nodes"},
              {"sort", "find_capacity"},

              {"p2g", "p2g_mass"},
              {"p2g", "find_liquid_cells", both, {liquid_indicator}},
              {"p2g", "carry_gradient_to_middle", step, {inertia, moving_gradients}},
              {"p2g", "<p2g_velocity>"},
              {"p2g", "<p2g_acceleration>", step, {newmark}},
              {"p2g", "keep_former_positions", step, {meters}},

              {"boundaries", "activate"},
              {"boundaries", "find_neighbours"},
              {"boundaries", "apply_wall_condition"},
              {"boundaries", "apply_wall_condition_acceleration", step, {newmark}},
              {"boundaries", "watch_lid", step, {asked}},  // where there is a weight

              {"predict", "predict_midpoint", step, {midpoint}},
              {"predict", "predict_newmark", step, {newmark}},
              {"predict", "predict_backward_euler", start, {midpoint_or_newmark}},

              {"forces", "integrate_ode", step, {ode_variables}},
              {"forces", "uniform_body_force", both, {force_in_time}},
              {"forces", "sample_body_force", both, {force_of_place}},
              {"forces", "p2g_body_force", both, {force_of_place}},

              {"ballistic", "move_ballistic_nodes"},

              {"material", "set_material"},
              {"material", "find_tau", both, {pspg_or_oss}},
              {"material", "find_tau_vms", both, {vms}},

              {"assemble", "find_filled_nodes", both, {mixed_or_exact}},
              {"assemble", "moments", both, {moments}},
              {"assemble", "p2g_pressure_gradient", both, {oss}},
              {"assemble", "divergence_matrix", both, {pspg_or_vms}},
              {"assemble", "divergence_matrix_oss", both, {oss}},
              // T_IJ comes along with the viscosity, or alone where there is none.
              {"assemble", "viscosity_matrix", both, {built_in_stabilization, viscous_on_nodes}},
              {"assemble", "laplacian_matrix", both, {built_in_stabilization, inviscid_on_nodes}},

              {"right_hand_side", "right_hand_side"},
              {"right_hand_side", "add_inertia_correction", both, {inertia}},
              {"right_hand_side", "damp_divergence", step, {midpoint}},

              {"solve", "<solve>"},
              {"solve", "unpack_solution"},
              {"solve", "g2p_pressure_gradient", both, {oss}},

              {"correct", "correct_midpoint", step, {midpoint}},
              {"correct", "correct_newmark", step, {newmark}},
              {"correct", "watch_turns", step, {newmark}},

              {"g2p", "<g2p_velocity>", step},
              {"g2p", "<g2p_acceleration>", step, {newmark}},

              {"advect", "carry_gradient_to_end", step, {inertia, moving_gradients}},
              {"advect", "g2p_force_gradient", step, {inertia}},
              {"advect", "advect", step},

              {"volume", "gather_node_volume", step, {projection_or_delta}},
              {"volume", "find_advected_capacity", step, {projection_or_delta}},
              {"volume", "shift_by_delta", step, {delta}},
              {"volume", "find_volume_excess", step, {projection}},
              {"volume", "volume_source", step, {projection}},
              {"volume", "<solve_volume>", step, {projection}},
              {"volume", "unpack_shift", step, {projection}},
              {"volume", "limit_shift", step, {projection, some_force}},  // else nothing is lifted
              {"volume", "shift_particles", step, {projection}},

              {"accept", "gather_node_volume"},
              {"accept", "find_advected_capacity"},
              {"accept", "measure_overlap"},
              {"accept", "pass_meters", step, {meters}},
              {"accept", "accept_step", step},
              {"accept", "note_step"},

              {"measure", "measure_energy"},
              {"measure", "measure_momentum"},
              {"measure", "measure_max_speed"},
              {"measure", "watch_move", step, {fixed_step}},
              {"measure", "measure_divergence"},
              {"measure", "watch_volume"},
              {"measure", "measure_energy_balance"},
              {"measure", "measure_probes", step, {probes}},
              {"measure", "measure_probes_at_start", start, {probes}},
              {"measure", "measure_gauges", both, {gauges}},
              {"measure", "measure_meters", both, {meters}},
              {"measure", "measure_error_velocity", both, {exact_velocity}},
              {"measure", "sample_pressure", both, {exact_pressure}},
              {"measure", "measure_error_pressure", both, {exact_pressure}},

              {"record", "write_history"},

              {"output", "flush_history"},
              {"output", "sample_pressure"},
              {"output", "write_frame"},
              {"output", "write_surfaces", both, {surfaces}},
              {"output", "write_xdmf"},
          },
      .standing = {{{inertia}, {"correct_backward_euler_velocity", "g2p_force_gradient"}},
                   {{newmark}, {"correct_backward_euler", "<g2p_acceleration>"}}}};
  return table;
}

}  // namespace minamo
