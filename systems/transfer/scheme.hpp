#pragma once
/// \file
/// A transfer scheme is a name for the systems that go into the slots `p2g` and `g2p`.

#include "engine/schedule/system.hpp"

#include <string>
#include <vector>

namespace minamo {

/// Names of registered systems, in their order. They read their options, if any, next to `scheme`. Accelerations are
/// transferred only by integrators that carry them; those of PIC suit every scheme.
struct TransferScheme {
  std::string name = {};                                                 ///< as in the scene
  std::string doc = {};                                                  ///< one line
  std::vector<std::string> p2g_velocity = {};                            ///< node::Velocity from particles
  std::vector<std::string> p2g_acceleration = {"p2g_acceleration_pic"};  ///< node::Acceleration
  std::vector<std::string> g2p_velocity = {};                            ///< particles from nodes
  std::vector<std::string> g2p_acceleration = {"g2p_acceleration_pic"};  ///< the same of accelerations
  /// The same for the conforming discretization: mass and velocity of faces, and back. Empty: not with that one.
  std::vector<std::string> p2g_faces = {};
  std::vector<std::string> g2p_faces = {};                                         ///< particles from faces
  std::vector<std::string> p2g_face_acceleration = {"p2g_face_acceleration_pic"};  ///< face::Acceleration
  std::vector<std::string> g2p_face_acceleration = {"g2p_face_acceleration_pic"};  ///< the same of accelerations
  bool carries_gradient =
      false;                  ///< in particle.velocity_gradient, and with p2g_acceleration_tpic that of acceleration
  bool adds_changes = false;  ///< particles keep their velocity, and get changes of the grid's
  bool reads_liquid_indicator = false;  ///< liquid or spray, (E61)
};

/// What lumped mass leaves out, (E53), (E62).
struct InertiaOfParticles {
  bool is_corrected = false;  ///< whether it is put back
};

/// PIC, FLIP, APIC, TPIC, TPIC2, XPIC and FMPM.
std::vector<TransferScheme> built_in_transfer_schemes();

}  // namespace minamo
