#pragma once
/// \file
/// What other parts know of the bodies of a scene.

#include "systems/bodies/body_set.hpp"
#include "systems/scene/scene.hpp"

namespace minamo {

/// One of the two, as the scene has dimensions.
struct BodiesOfScene {
  BodySet<2> in_plane;
  BodySet<3> in_space;

  template <int Dim>
  const BodySet<Dim>& of() const {
    if constexpr (Dim == 2) {
      return in_plane;
    } else {
      return in_space;
    }
  }
  template <int Dim>
  BodySet<Dim>& of() {
    return const_cast<BodySet<Dim>&>(std::as_const(*this).template of<Dim>());
  }
};

/// Whether friction is found near the bodies, (E110). It costs something: not where a liquid that flows easily slips
/// along all of them.
bool finds_friction(const BodiesOfScene& bodies, const Scene& scene);

}  // namespace minamo
