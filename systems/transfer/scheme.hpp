#pragma once
/// \file
/// A transfer scheme is a name for the systems that go into the slots `p2g` and `g2p`.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace minamo {

/// Names of registered systems. The acceleration is transferred only by integrators that carry one.
struct TransferScheme {
  std::string name;
  std::string doc;
  std::string p2g_velocity;
  std::string p2g_acceleration;
  std::vector<std::string> g2p_velocity;
  std::string g2p_acceleration;
  bool carries_gradient;  ///< of velocity, and of acceleration where there is one
};

std::span<const TransferScheme> transfer_schemes();
std::vector<std::string> transfer_scheme_names();

/// \pre `name` is one of transfer_scheme_names().
const TransferScheme& transfer_scheme(std::string_view name);

}  // namespace minamo
