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
  registry.add<BinByCell>("bin_by_cell");
  registry.add<NumberSites>("number_sites");
  registry.add<P2GFacesPic>("p2g_faces_pic");
  registry.add<P2GFacesTpic>("p2g_faces_tpic");
  registry.add<P2GFacesTpic2>("p2g_faces_tpic2");
  registry.add<G2PFacesPic>("g2p_faces_pic");
  registry.add<G2PFacesFlip>("g2p_faces_flip");
  registry.add<G2PFacesTpic>("g2p_faces_tpic");
  registry.add<G2PFacesTpic2>("g2p_faces_tpic2");
  registry.add<G2PFacesApic>("g2p_faces_apic");
  registry.add<FilterFacesXpic>("filter_faces_xpic");
  registry.add<G2PFacesXpic>("g2p_faces_xpic");
  registry.add<FilterFacesFmpm>("filter_faces_fmpm");
  registry.add<G2PFacesFmpm>("g2p_faces_fmpm");
  registry.add<P2GFaceAccelerationPic>("p2g_face_acceleration_pic");
  registry.add<P2GFaceAccelerationTpic>("p2g_face_acceleration_tpic");
  registry.add<G2PFaceAccelerationPic>("g2p_face_acceleration_pic");
  registry.add<G2PFaceAccelerationTpic>("g2p_face_acceleration_tpic");
  registry.add<G2PFaceAccelerationApic>("g2p_face_acceleration_apic");
  registry.add<LimitGradient>("limit_gradient");
  registry.add<AdvectByFaces>("advect_by_faces");
  registry.add<P2GMultipliers>("p2g_multipliers");
  registry.add<FindFill>("find_fill");
  registry.add<FindLiquidCellsByMultipliers>("find_liquid_cells_by_multipliers");
  registry.add<FindMobility>("find_mobility");
  registry.add<FindMobilityMixed>("find_mobility_mixed");
  registry.add<AssembleMultipliers>("assemble_multipliers");
  registry.add<HoldFaces>("hold_faces");
  registry.add<HoldFaceAccelerations>("hold_face_accelerations");
  registry.add<PredictFacesMidpoint>("predict_faces_midpoint");
  registry.add<PredictFacesBackwardEuler>("predict_faces_backward_euler");
  registry.add<PredictFacesNewmark>("predict_faces_newmark");
  registry.add<UniformFaceForce>("uniform_face_force");
  registry.add<P2GFaceForce>("p2g_face_force");
  registry.add<AddFaceInertia>("add_face_inertia");
  registry.add<FillFaceSource>("face_source");
  registry.add<DampFaceDivergence>("damp_face_divergence");
  registry.add<FillFaceVolumeSource>("face_volume_source");
  registry.add<FindCellViscosity>("find_cell_viscosity");
  registry.add<RubFaces>("rub_faces");
  registry.add<PrepareMultipliers>("prepare_multipliers");
  registry.add<SolveMultipliers>("solve_multipliers");
  registry.add<ProjectFaces>("project_faces");
  registry.add<SolveFriction>("solve_friction");
  registry.add<SolveFacesUmfpack>("solve_faces_umfpack");
  registry.add<SolveFrictionUmfpack>("solve_face_friction_umfpack");
  registry.add<CorrectFacesMidpoint>("correct_faces_midpoint");
  registry.add<CorrectFacesNewmark>("correct_faces_newmark");
  registry.add<WatchTurnsOfFaces>("watch_turns_of_faces");
  registry.add<CorrectFacesBackwardEuler>("correct_faces_backward_euler");
  registry.add<G2PFaceForceGradient>("g2p_face_force_gradient");
  registry.add<FillParts>("fill_parts");
  registry.add<StirParticles>("stir_particles");
  registry.add<GatherFaceShift>("gather_face_shift");
  registry.add<LimitParticleShift>("limit_particle_shift");
  registry.add<ApplyParticleShift>("apply_particle_shift");
  registry.add<MeasureFaceDivergence>("measure_face_divergence");
  registry.add<MeasureMultiplierOverlap>("measure_multiplier_overlap");
  registry.add<MeasureProbesOnFaces>("measure_probes_on_faces");
  registry.add<MeasureProbesOnFacesAtStart>("measure_probes_on_faces_at_start");
  registry.add<RecoverPressure>("recover_pressure");
  registry.add(DiscretizationScheme{
      {"conforming", "splines free of divergence at every point, velocities on faces", read_conforming}});
  registry.add(DiscretizationScheme{{"equal_order", "velocity and pressure on nodes, stabilized", read_equal_order}});
  const DefaultScheme fallback{recommended, "\"equal_order\" with stabilization, or volume by \"delta\""};
  registry.add(choice<DiscretizationScheme>("discretization", "where velocity and pressure live", fallback));
}

}  // namespace minamo
