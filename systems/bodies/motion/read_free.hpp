#pragma once
/// \file
/// What a scene says of a body that the liquid moves.

#include "engine/input/input.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// The object under "free". Sets the pivot of the body, too: its centre of mass.
template <int Dim>
Free<Dim> read_free(Input& input, const GridScene& grid, BodyScene<Dim>& body);

}  // namespace minamo
