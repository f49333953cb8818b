#include "systems/grid/bin.hpp"
#include "systems/grid/number_sites.hpp"
#include "systems/measure/on_faces.hpp"
#include "systems/momentum/balances.hpp"
#include "systems/momentum/fill.hpp"
#include "systems/pressure/pressure.hpp"
#include "systems/pressure/solve.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/time/turns.hpp"
#include "systems/transfer/face_filters.hpp"
#include "systems/transfer/face_schemes.hpp"
#include "systems/transfer/face_tpic2.hpp"
#include "systems/transfer/limit_gradient.hpp"
#include "systems/viscosity/friction.hpp"
#include "systems/viscosity/solve_friction.hpp"
#include "systems/viscosity/solve_umfpack.hpp"
#include "systems/volume/face_volume.hpp"

namespace minamo {

namespace {

/// A discretization that scenes choose by name.
struct DiscretizationScheme : Scheme {};

Contribution read_equal_order(Input&, Scene& scene) {
  scene.facts.set(Discretization{});
  return {};
}

Contribution read_conforming(Input& input, Scene& scene) {
  Discretization discretization{.is_conforming = true};
  discretization.degree =
      static_cast<int>(input.integer("degree", {.doc = "of the velocity along itself; across itself it has one less",
                                                .fallback = discretization.degree,
                                                .at_least = least_degree,
                                                .at_most = largest_degree}));
  scene.facts.set(discretization);
  return {};
}

/// Conforming, unless the scene asks for what only equal order has.
std::string recommended(const Input& input, const Scene&) {
  const bool of_equal_order =
      !input.describing() && (input.has("stabilization") || input.text_at("volume/scheme") == "delta");
  return of_equal_order ? "equal_order" : "conforming";
}

}  // namespace

void add_discretization(SystemRegistry& registry) {
  registry.add<BinByCell>("bin_by_cell", OnRanks::own);
  registry.add<NumberSites>("number_sites", OnRanks::own);
  registry.add<P2GFacesPic>("p2g_faces_pic", OnRanks::adds_up);
  registry.add<P2GFacesTpic>("p2g_faces_tpic", OnRanks::adds_up);
  registry.add<P2GFacesTpic2>("p2g_faces_tpic2", OnRanks::adds_up);
  registry.add<G2PFacesPic>("g2p_faces_pic", OnRanks::own);
  registry.add<G2PFacesFlip>("g2p_faces_flip", OnRanks::own);
  registry.add<G2PFacesTpic>("g2p_faces_tpic", OnRanks::own);
  registry.add<G2PFacesTpic2>("g2p_faces_tpic2", OnRanks::own);
  registry.add<G2PFacesApic>("g2p_faces_apic", OnRanks::own);
  registry.add<FilterFacesXpic>("filter_faces_xpic", OnRanks::adds_up);
  registry.add<G2PFacesXpic>("g2p_faces_xpic", OnRanks::own);
  registry.add<FilterFacesFmpm>("filter_faces_fmpm", OnRanks::adds_up);
  registry.add<G2PFacesFmpm>("g2p_faces_fmpm", OnRanks::own);
  registry.add<P2GFaceAccelerationPic>("p2g_face_acceleration_pic", OnRanks::adds_up);
  registry.add<P2GFaceAccelerationTpic>("p2g_face_acceleration_tpic", OnRanks::adds_up);
  registry.add<G2PFaceAccelerationPic>("g2p_face_acceleration_pic", OnRanks::own);
  registry.add<G2PFaceAccelerationTpic>("g2p_face_acceleration_tpic", OnRanks::own);
  registry.add<G2PFaceAccelerationApic>("g2p_face_acceleration_apic", OnRanks::own);
  registry.add<LimitGradient>("limit_gradient", OnRanks::own);
  registry.add<AdvectByFaces>("advect_by_faces", OnRanks::own);
  registry.add<P2GMultipliers>("p2g_multipliers", OnRanks::adds_up);
  registry.add<FindFill>("find_fill", OnRanks::adds_up);
  registry.add<FindLiquidCellsByMultipliers>("find_liquid_cells_by_multipliers", OnRanks::own);
  registry.add<FindMobility>("find_mobility", OnRanks::own);
  registry.add<FindMobilityMixed>("find_mobility_mixed", OnRanks::own);
  registry.add<AssembleMultipliers>("assemble_multipliers", OnRanks::own);
  registry.add<HoldFaces>("hold_faces", OnRanks::own);
  registry.add<HoldFaceAccelerations>("hold_face_accelerations", OnRanks::own);
  registry.add<PredictFacesMidpoint>("predict_faces_midpoint", OnRanks::own);
  registry.add<PredictFacesBackwardEuler>("predict_faces_backward_euler", OnRanks::own);
  registry.add<PredictFacesNewmark>("predict_faces_newmark", OnRanks::own);
  registry.add<UniformFaceForce>("uniform_face_force", OnRanks::own);
  registry.add<P2GFaceForce>("p2g_face_force", OnRanks::adds_up);
  registry.add<AddFaceInertia>("add_face_inertia", OnRanks::adds_up);
  registry.add<FillFaceSource>("face_source", OnRanks::own);
  registry.add<DampFaceDivergence>("damp_face_divergence", OnRanks::own);
  registry.add<FillFaceVolumeSource>("face_volume_source", OnRanks::own);
  registry.add<FindCellViscosity>("find_cell_viscosity", OnRanks::own);
  registry.add<RubFaces>("rub_faces", OnRanks::adds_up);
  registry.add<PrepareMultipliers>("prepare_multipliers");
  registry.add<SolveMultipliers>("solve_multipliers");
  registry.add<ProjectFaces>("project_faces", OnRanks::own);
  registry.add<SolveFriction>("solve_friction", OnRanks::exchanges);
  registry.add<SolveFacesUmfpack>("solve_faces_umfpack");
  registry.add<SolveFrictionUmfpack>("solve_face_friction_umfpack");
  registry.add<CorrectFacesMidpoint>("correct_faces_midpoint", OnRanks::own);
  registry.add<CorrectFacesNewmark>("correct_faces_newmark", OnRanks::own);
  registry.add<WatchTurnsOfFaces>("watch_turns_of_faces", OnRanks::own);
  registry.add<CorrectFacesBackwardEuler>("correct_faces_backward_euler", OnRanks::own);
  registry.add<G2PFaceForceGradient>("g2p_face_force_gradient", OnRanks::own);
  registry.add<FillParts>("fill_parts", OnRanks::adds_up);
  registry.add<StirParticles>("stir_particles", OnRanks::own);
  registry.add<GatherFaceShift>("gather_face_shift", OnRanks::own);
  registry.add<LimitParticleShift>("limit_particle_shift", OnRanks::adds_up);
  registry.add<ApplyParticleShift>("apply_particle_shift", OnRanks::own);
  registry.add<MeasureFaceDivergence>("measure_face_divergence", OnRanks::adds_up);
  registry.add<MeasureMultiplierOverlap>("measure_multiplier_overlap", OnRanks::adds_up);
  registry.add<MeasureProbesOnFaces>("measure_probes_on_faces", OnRanks::adds_up);
  registry.add<MeasureProbesOnFacesAtStart>("measure_probes_on_faces_at_start", OnRanks::adds_up);
  registry.add<RecoverPressure>("recover_pressure", OnRanks::adds_up);
  registry.add(DiscretizationScheme{
      {"conforming", "splines free of divergence at every point, velocities on faces", read_conforming}});
  registry.add(DiscretizationScheme{{"equal_order", "velocity and pressure on nodes, stabilized", read_equal_order}});
  const DefaultScheme fallback{recommended, "\"equal_order\" with stabilization, or volume by \"delta\""};
  registry.add(choice<DiscretizationScheme>("discretization", "where velocity and pressure live", fallback));
}

}  // namespace minamo
