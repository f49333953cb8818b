#pragma once
/// \file
/// What friction of the conforming discretization keeps in addition to the viscosity of cells.

#include "components/staggered.hpp"

namespace minamo {

namespace face {

/// Bound D_f of the friction at a face: K <= D. [kg/s]
template <int Dim>
struct FrictionBound : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.friction_bound", "D_f", "kg/s", Lifetime::scratch};
};

/// (K v)_f, what friction takes of the momentum. [N]
template <int Dim>
struct Friction : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.friction", "(K v)_f", "N", Lifetime::scratch};
};

}  // namespace face
}  // namespace minamo
