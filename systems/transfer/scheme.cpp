#include "systems/transfer/scheme.hpp"

namespace minamo {

std::vector<TransferScheme> built_in_transfer_schemes() {
  return {{.name = "apic",
           .doc = "particles take over the grid velocity and its affine part; keeps angular momentum",
           .p2g_velocity = {"p2g_velocity_tpic"},
           .p2g_acceleration = {"p2g_acceleration_tpic"},
           .g2p_velocity = {"g2p_velocity_apic"},
           .g2p_acceleration = {"g2p_acceleration_apic"},
           .carries_gradient = true},
          {.name = "flip",
           .doc = "particles add up the changes of the grid velocity; little damping, noisy",
           .p2g_velocity = {"p2g_velocity_pic"},
           .g2p_velocity = {"g2p_velocity_flip"}},
          {.name = "fmpm",
           .doc = "PIC with a fuller mass matrix, whose damping shrinks with the order; FMPM(1) is PIC",
           .p2g_velocity = {"p2g_velocity_pic"},
           .g2p_velocity = {"filter_velocity_fmpm", "g2p_velocity_fmpm"}},
          {.name = "pic",
           .doc = "particles take over the grid velocity; strong damping",
           .p2g_velocity = {"p2g_velocity_pic"},
           .g2p_velocity = {"g2p_velocity_pic"}},
          {.name = "tpic",
           .doc = "particles take over the grid velocity and its gradient; smooth, little damping",
           .p2g_velocity = {"p2g_velocity_tpic"},
           .p2g_acceleration = {"p2g_acceleration_tpic"},
           .g2p_velocity = {"g2p_velocity_tpic"},
           .g2p_acceleration = {"g2p_acceleration_tpic"},
           .carries_gradient = true},
          {.name = "tpic2",
           .doc = "TPIC with second derivatives where the grid resolves them; half the error in smooth flow",
           .p2g_velocity = {"p2g_velocity_tpic2"},
           .p2g_acceleration = {"p2g_acceleration_tpic"},
           .g2p_velocity = {"g2p_velocity_tpic2"},
           .g2p_acceleration = {"g2p_acceleration_tpic"},
           .carries_gradient = true,
           .reads_liquid_indicator = true},
          {.name = "xpic",
           .doc = "PIC whose damping shrinks with the order; XPIC(1) is PIC",
           .p2g_velocity = {"p2g_velocity_pic"},
           .g2p_velocity = {"filter_velocity_xpic", "g2p_velocity_xpic"}}};
}

}  // namespace minamo
