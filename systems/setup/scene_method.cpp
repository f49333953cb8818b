#include "systems/setup/scene_method.hpp"

namespace minamo {

namespace {

/// The options of the systems of a transfer scheme.
void configure_transfer(Input& input, const TransferScheme& scheme, const SystemRegistry& registry, Scene& scene) {
  for (const auto* names :
       {&scheme.p2g_velocity, &scheme.p2g_acceleration, &scheme.g2p_velocity, &scheme.g2p_acceleration}) {
    for (const std::string& name : *names) {
      scene.configured.insert_or_assign(name, registry.make(name, scene.dimension, &input));
    }
  }
}

void read_transfer(Input& input, const SystemRegistry& registry, Scene& scene) {
  Input::Variants variants;
  for (const auto& named : registry.choices<TransferScheme>()) {
    variants.emplace_back(named.first, [&, &scheme = named.second](Input& in) {
      configure_transfer(in, scheme, registry, scene);
      if (scheme.carries_gradient) {
        scene.corrected_inertia =
            in.choice("inertia", std::vector<std::string>{"corrected", "lumped"},
                      "lumped mass, with or without what it leaves out: (E53), (E62)", "corrected") == "corrected";
      } else if (scheme.name == "flip") {
        scene.flip_blend = in.number(
            "blend",
            {.doc = "share of FLIP, the rest is PIC", .fallback = scene.flip_blend, .at_least = 0, .at_most = 1});
      } else if (scheme.name == "xpic" || scheme.name == "fmpm") {
        scene.filter_order = static_cast<int>(
            in.integer("order", {.doc = "order; 1 is PIC", .fallback = 2, .at_least = 1, .at_most = 20}));
      }
    });
  }
  scene.transfer = input.variant("scheme", "transfer scheme", "tpic2", variants);
  scene.transfer_scheme = registry.choices<TransferScheme>().at(scene.transfer);
}

void read_integrator(Input& input, Scene& scene) {
  const auto read_newmark = [&](Input& in) {
    scene.newmark_beta = in.number("beta", {.doc = "Newmark's beta", .fallback = 0.25, .at_most = 0.5, .above = 0});
    scene.newmark_gamma =
        in.number("gamma", {.doc = "Newmark's gamma", .fallback = 0.5, .at_least = 0.5, .at_most = 1});
  };
  scene.integrator =
      input.variant("scheme", "integrator", "midpoint", {{"midpoint", [](Input&) {}}, {"newmark", read_newmark}});
}

void read_solver(Input& input, Scene& scene) {
  const auto read_tolerance = [&](Input& in) {
    scene.solver_tolerance = in.number(
        "tolerance", {.doc = "residual over right-hand side", .fallback = 1e-8, .at_least = 1e-13, .at_most = 1e-3});
  };
  scene.solver =
      input.variant("scheme", "linear solver", "block", {{"block", read_tolerance}, {"umfpack", [](Input&) {}}});
}

void read_volume(Input& input, Scene& scene) {
  const auto read_rate = [&](Input& in) {
    scene.volume_rate = in.number("rate", {.doc = "share of the excess that is corrected in a step",
                                           .fallback = scene.volume_rate,
                                           .at_most = 1,
                                           .above = 0});
  };
  scene.volume = input.variant("scheme", "volume correction", "projection",
                               {{"delta", [](Input&) {}}, {"none", [](Input&) {}}, {"projection", read_rate}});
}

}  // namespace

void read_method(Input& input, const SystemRegistry& registry, Scene& scene) {
  const auto block = [&](std::string_view key, std::string_view doc, const auto& read) {
    input.object(key, doc, Input::Presence::optional, [&](Input& in) { read(in, scene); });
  };
  block("transfer", "transfer between particles and grid",
        [&](Input& in, Scene& s) { read_transfer(in, registry, s); });
  block("integrator", "time integration", read_integrator);
  block("stabilization", "pressure stabilization", [](Input& in, Scene& s) {
    s.stabilization = in.choice("scheme", std::vector<std::string>{"oss", "pspg", "vms"}, "stabilization", "pspg");
  });
  block("quadrature", "integrals of the balances", [](Input& in, Scene& s) {
    s.quadrature = in.choice("scheme", std::vector<std::string>{"mixed", "particles"},
                             "exact inside the liquid and by particles at its surface, or by particles alone", "mixed");
  });
  block("volume", "volume correction", read_volume);
  block("solver", "linear solver", read_solver);
}

}  // namespace minamo
