#include "systems/transfer/scheme.hpp"

#include <algorithm>
#include <array>

namespace minamo {

std::span<const TransferScheme> transfer_schemes() {
  static const std::array<TransferScheme, 5> schemes{{
      {"apic",
       "particles take over the grid velocity and its affine part; keeps angular momentum",
       "p2g_velocity_tpic",
       "p2g_acceleration_tpic",
       {"g2p_velocity_apic"},
       "g2p_acceleration_apic",
       true},
      {"flip",
       "particles add up the changes of the grid velocity; little damping, noisy",
       "p2g_velocity_pic",
       "p2g_acceleration_pic",
       {"g2p_velocity_flip"},
       "g2p_acceleration_pic",
       false},
      {"pic",
       "particles take over the grid velocity; strong damping",
       "p2g_velocity_pic",
       "p2g_acceleration_pic",
       {"g2p_velocity_pic"},
       "g2p_acceleration_pic",
       false},
      {"tpic",
       "particles take over the grid velocity and its gradient; smooth, little damping",
       "p2g_velocity_tpic",
       "p2g_acceleration_tpic",
       {"g2p_velocity_tpic"},
       "g2p_acceleration_tpic",
       true},
      {"xpic",
       "PIC whose damping shrinks with the order; XPIC(1) is PIC",
       "p2g_velocity_pic",
       "p2g_acceleration_pic",
       {"filter_velocity_xpic", "g2p_velocity_xpic"},
       "g2p_acceleration_pic",
       false},
  }};
  return schemes;
}

std::vector<std::string> transfer_scheme_names() {
  std::vector<std::string> names;
  for (const TransferScheme& scheme : transfer_schemes()) names.push_back(scheme.name);
  return names;
}

const TransferScheme& transfer_scheme(std::string_view name) {
  return *std::find_if(transfer_schemes().begin(), transfer_schemes().end(),
                       [&](const TransferScheme& scheme) { return scheme.name == name; });
}

}  // namespace minamo
