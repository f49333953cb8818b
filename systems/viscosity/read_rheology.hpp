#pragma once
/// \file
/// The key "rheology" of a liquid.

#include "components/rheology.hpp"
#include "engine/input/input.hpp"

namespace minamo {

/// \param input  of the rheology: one law by name, and `iterations`
Rheology read_rheology(Input& input);

}  // namespace minamo
