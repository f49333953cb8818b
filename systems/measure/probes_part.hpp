#pragma once
/// \file
/// The probes of a scene.

#include <string>
#include <vector>

namespace minamo {

struct ProbeScene {
  std::string name;
  std::vector<double> at;  ///< [m]
};
using ProbeScenes = std::vector<ProbeScene>;

}  // namespace minamo
