#pragma once
/// \file
/// Shapes as scenes give them.

#include "systems/scene/scene.hpp"
#include "systems/shapes/shape.hpp"

namespace minamo {

/// Where a shape may lie.
enum class ShapePlace {
  anywhere,
  inside_the_grid  ///< shapes with bounds, and the members of a union; what others are made of may lie anywhere
};

/// The keys of a shape: those of one of the shapes, and in it whatever that needs. All problems are noted.
/// \param input  the object under the key `shape`
/// \param more   further keys that may stand instead of one of these
/// \return null if there was a problem, if one of `more` was read, and in description mode.
template <int Dim>
SharedShape<Dim> read_shape(Input& input, const Scene& scene, ShapePlace place, const Input::Variants& more = {});

}  // namespace minamo
