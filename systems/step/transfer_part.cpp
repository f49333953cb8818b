#include "components/transfer.hpp"
#include "systems/equal_order/inertia.hpp"
#include "systems/grid/liquid_cells.hpp"
#include "systems/scene/discretization.hpp"
#include "systems/scene/parts.hpp"
#include "systems/scene/schemes.hpp"
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

namespace minamo {

namespace {

Contribution read_scheme(const TransferScheme& scheme, Input& input, Scene& scene) {
  const auto make = [&](const std::vector<std::string>& names) {
    std::vector<System> systems;
    for (const std::string& name : names) systems.push_back(registry_of(scene).make(name, scene.dimension, &input));
    return systems;
  };
  const bool conforming = is_conforming(scene);
  if (conforming && scheme.p2g_faces.empty()) {
    input.problem("scheme", "not with the conforming discretization", "a scheme with systems for faces",
                  shown(Json(scheme.name)));
  }
  const auto p2g = make(conforming ? scheme.p2g_faces : scheme.p2g_velocity);
  const auto g2p = make(conforming ? scheme.g2p_faces : scheme.g2p_velocity);
  const auto p2g_acceleration = make(conforming ? scheme.p2g_face_acceleration : scheme.p2g_acceleration);
  const auto g2p_acceleration = make(conforming ? scheme.g2p_face_acceleration : scheme.g2p_acceleration);
  scene.facts.set(scheme);
  const bool corrected =
      scheme.carries_gradient &&
      input.choice("inertia", std::vector<std::string>{"corrected", "lumped"},
                   "lumped mass, with or without what it leaves out: (E53), (E62)", "corrected") == "corrected";
  scene.facts.set(InertiaOfParticles{corrected});
  return [=](const Scene&, Recipe& recipe) {
    recipe.constant(VelocityOfParticles{.is_kept = scheme.adds_changes});
    recipe.fill("<p2g_velocity>", p2g);
    recipe.fill("<g2p_velocity>", g2p);
    recipe.fill("<p2g_acceleration>", p2g_acceleration);
    recipe.fill("<g2p_acceleration>", g2p_acceleration);
  };
}

/// What measures best: second derivatives on nodes; across faces there are none (systems/transfer/face_tpic2.hpp).
std::string recommended(const Input&, const Scene& scene) { return is_conforming(scene) ? "tpic" : "tpic2"; }

}  // namespace

void add_transfer(SystemRegistry& registry) {
  registry.add<P2GMass>("p2g_mass");
  registry.add<P2GVelocityPic>("p2g_velocity_pic");
  registry.add<P2GAccelerationPic>("p2g_acceleration_pic");
  registry.add<P2GVelocityTpic>("p2g_velocity_tpic");
  registry.add<P2GVelocityTpic2>("p2g_velocity_tpic2");
  registry.add<P2GAccelerationTpic>("p2g_acceleration_tpic");
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
  registry.add<FindLiquidCells>("find_liquid_cells");
  registry.add<CarryGradient>("carry_gradient_to_middle");
  registry.add<CarryGradient>("carry_gradient_to_end");
  registry.add<CarryGradientByFaces>("carry_gradient_by_faces", OnRanks::own);
  registry.add<AddInertiaCorrection>("add_inertia_correction");
  registry.add<G2PForceGradient>("g2p_force_gradient");
  registry.add<Advect>("advect");
  for (const TransferScheme& scheme : built_in_transfer_schemes()) registry.add(scheme);
  const DefaultScheme fallback{recommended, "\"tpic2\" with the discretization \"equal_order\""};
  registry.add(choice<TransferScheme>("transfer", "transfer between particles and grid", fallback, read_scheme));
}

}  // namespace minamo
