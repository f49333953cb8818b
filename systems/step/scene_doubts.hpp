#pragma once
/// \file
/// What a scene may not mean: lengths that are not in metres, speeds that no liquid has. Bodies are not here
/// (systems/bodies/warnings.hpp).

#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// A sentence each. Lengths are doubted where the force that drives the liquid hardly moves what is as large as the box
/// until the end of the run: of a box in millimetres that was given in metres the time is thirty times too short. A box
/// that is small is no matter of doubt: drops of micrometres are.
std::vector<std::string> warnings_of_lengths(const Scene& scene);

/// A sentence each: of the liquid at the start, bodies whose velocity is given, and what comes in.
/// \pre the world was seeded with the scene
std::vector<std::string> warnings_of_speeds(const Scene& scene, World& world);

}  // namespace minamo
