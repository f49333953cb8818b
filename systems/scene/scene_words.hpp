#pragma once
/// \file
/// What scenes call the words of other programs: SPlisHSPlasH, DualSPHysics, OpenFOAM, LAMMPS, Taichi, Basilisk,
/// Python.

#include "engine/input/other_words.hpp"

namespace minamo {

/// For the messages of a scene that uses them.
std::span<const OtherWord> scene_words();

}  // namespace minamo
