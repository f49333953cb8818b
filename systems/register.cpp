#include "systems/register.hpp"

#include "systems/assemble/inertia.hpp"
#include "systems/assemble/mass_balance.hpp"
#include "systems/assemble/material.hpp"
#include "systems/assemble/neighbours.hpp"
#include "systems/assemble/pressure_gradient.hpp"
#include "systems/assemble/right_hand_side.hpp"
#include "systems/assemble/viscosity.hpp"
#include "systems/assemble/vms.hpp"
#include "systems/grid/activate.hpp"
#include "systems/grid/bin.hpp"
#include "systems/grid/capacity.hpp"
#include "systems/grid/filled_nodes.hpp"
#include "systems/grid/liquid_cells.hpp"
#include "systems/grid/number_nodes.hpp"
#include "systems/grid/walls.hpp"
#include "systems/measure/acceptance.hpp"
#include "systems/measure/conservation.hpp"
#include "systems/measure/error.hpp"
#include "systems/measure/probes.hpp"
#include "systems/measure/volume.hpp"
#include "systems/output/fields.hpp"
#include "systems/output/history.hpp"
#include "systems/solve/block.hpp"
#include "systems/solve/monolithic.hpp"
#include "systems/solve/umfpack.hpp"
#include "systems/time/body_force.hpp"
#include "systems/time/damp_divergence.hpp"
#include "systems/time/midpoint.hpp"
#include "systems/time/newmark.hpp"
#include "systems/time/ode.hpp"
#include "systems/time/quadrature_position.hpp"
#include "systems/transfer/advect.hpp"
#include "systems/transfer/apic.hpp"
#include "systems/transfer/carry_gradient.hpp"
#include "systems/transfer/fmpm.hpp"
#include "systems/transfer/mass.hpp"
#include "systems/transfer/pic_flip.hpp"
#include "systems/transfer/scheme.hpp"
#include "systems/transfer/tpic.hpp"
#include "systems/transfer/tpic2.hpp"
#include "systems/transfer/xpic.hpp"
#include "systems/volume/delta.hpp"
#include "systems/volume/limit_shift.hpp"
#include "systems/volume/projection.hpp"

namespace minamo {

void register_systems(SystemRegistry& registry) {
  registry.add<PlaceQuadratureAtStart>("place_quadrature_at_start");
  registry.add<PlaceQuadratureAtMiddle>("place_quadrature_at_middle");
  registry.add<PlaceQuadratureStepBefore>("place_quadrature_step_before");
  registry.add<PlaceQuadratureStepAhead>("place_quadrature_step_ahead");
  registry.add<Bin>("bin");
  registry.add<NumberNodes>("number_nodes");
  registry.add<FindCapacity>("find_capacity");
  registry.add<FindAdvectedCapacity>("find_advected_capacity");

  registry.add<P2GMass>("p2g_mass");
  registry.add<P2GVelocityPic>("p2g_velocity_pic");
  registry.add<P2GAccelerationPic>("p2g_acceleration_pic");
  registry.add<P2GVelocityTpic>("p2g_velocity_tpic");
  registry.add<P2GVelocityTpic2>("p2g_velocity_tpic2");
  registry.add<P2GAccelerationTpic>("p2g_acceleration_tpic");

  registry.add<Activate>("activate");
  registry.add<FindNeighbours>("find_neighbours");
  registry.add<ApplyWallCondition>("apply_wall_condition");
  registry.add<ApplyWallConditionAcceleration>("apply_wall_condition_acceleration");

  registry.add<PredictNewmark>("predict_newmark");
  registry.add<PredictMidpoint>("predict_midpoint");
  registry.add<PredictBackwardEuler>("predict_backward_euler");
  registry.add<CorrectNewmark>("correct_newmark");
  registry.add<CorrectMidpoint>("correct_midpoint");
  registry.add<CorrectBackwardEuler>("correct_backward_euler");
  registry.add<CorrectBackwardEulerVelocity>("correct_backward_euler_velocity");

  registry.add<IntegrateOde>("integrate_ode");
  registry.add<HoldOde>("hold_ode");

  registry.add<UniformBodyForce>("uniform_body_force");
  registry.add<UniformBodyForceOde>("uniform_body_force_ode");
  registry.add<SampleBodyForce>("sample_body_force");
  registry.add<SampleBodyForceOde>("sample_body_force_ode");
  registry.add<P2GBodyForce>("p2g_body_force");
  registry.add<MoveBallisticNodes>("move_ballistic_nodes");

  registry.add<FindFilledNodes>("find_filled_nodes");
  registry.add<GatherMoments>("moments");
  registry.add<SetMaterial>("set_material");
  registry.add<FindTau>("find_tau");
  registry.add<FindTauVms>("find_tau_vms");
  registry.add<AssembleDivergence>("divergence_matrix");
  registry.add<AssembleDivergenceOss>("divergence_matrix_oss");
  registry.add<AssembleLaplacian>("laplacian_matrix");
  registry.add<AssembleViscosity>("viscosity_matrix");
  registry.add<G2PPressureGradient>("g2p_pressure_gradient");
  registry.add<P2GPressureGradient>("p2g_pressure_gradient");
  registry.add<AssembleMonolithic>("assemble_monolithic");
  registry.add<AssembleMonolithicViscous>("assemble_monolithic_viscous");
  registry.add<FindLiquidCells>("find_liquid_cells");
  registry.add<CarryGradient>("carry_gradient_to_middle");
  registry.add<CarryGradient>("carry_gradient_to_end");
  registry.add<AddInertiaCorrection>("add_inertia_correction");
  registry.add<DampDivergence>("damp_divergence");
  registry.add<SolveUmfpack>("solve_umfpack");
  registry.add<SolveBlock>("solve_block");
  registry.add<SolveBlockViscous>("solve_block_viscous");
  registry.add<FillRightHandSide>("right_hand_side");
  registry.add<UnpackSolution>("unpack_solution");

  registry.add<G2PVelocityPic>("g2p_velocity_pic");
  registry.add<G2PVelocityFlip>("g2p_velocity_flip");
  registry.add<G2PVelocityTpic>("g2p_velocity_tpic");
  registry.add<G2PVelocityTpic2>("g2p_velocity_tpic2");
  registry.add<G2PVelocityApic>("g2p_velocity_apic");
  registry.add<G2PAccelerationApic>("g2p_acceleration_apic");
  registry.add<FilterVelocityXpic>("filter_velocity_xpic");
  registry.add<G2PVelocityXpic>("g2p_velocity_xpic");
  registry.add<FilterVelocityFmpm>("filter_velocity_fmpm");
  registry.add<G2PVelocityFmpm>("g2p_velocity_fmpm");
  registry.add<G2PAccelerationPic>("g2p_acceleration_pic");
  registry.add<G2PAccelerationTpic>("g2p_acceleration_tpic");
  registry.add<G2PForceGradient>("g2p_force_gradient");
  registry.add<Advect>("advect");

  registry.add<GatherNodeVolume>("gather_node_volume");
  registry.add<FindVolumeExcess>("find_volume_excess");
  registry.add<SolveVolumeUmfpack>("solve_volume_umfpack");
  registry.add<SolveVolumeBlock>("solve_volume_block");
  registry.add<StoreKineticEnergy>("store_kinetic_energy");
  registry.add<LimitShift>("limit_shift");
  registry.add<ShiftParticles>("shift_particles");
  registry.add<ShiftByDelta>("shift_by_delta");

  registry.add<MeasureEnergy>("measure_energy");
  registry.add<MeasureMomentum>("measure_momentum");
  registry.add<MeasureMomentumAffine>("measure_momentum_affine");
  registry.add<MeasureMaxSpeed>("measure_max_speed");
  registry.add<MeasureDivergence>("measure_divergence");
  registry.add<MeasureOverlap>("measure_overlap");
  registry.add<MeasureProbes>("measure_probes");
  registry.add<MeasureProbesAtStart>("measure_probes_at_start");
  registry.add<MeasureErrorVelocity>("measure_error_velocity");
  registry.add<MeasureErrorVelocityOde>("measure_error_velocity_ode");
  registry.add<MeasureErrorPressure>("measure_error_pressure");
  registry.add<MeasureErrorPressureOde>("measure_error_pressure_ode");

  registry.add<AcceptStep>("accept_step");
  registry.add<WriteHistory>("write_history");
  registry.add<SamplePressure>("sample_pressure");
  registry.add<WriteFrame>("write_frame");
  registry.add<WriteVelocityGradient>("write_velocity_gradient");
  registry.add<WriteXdmf>("write_xdmf");

  for (const TransferScheme& scheme : built_in_transfer_schemes()) registry.add(scheme);
}

}  // namespace minamo
