#pragma once
/// \file
/// Density of the liquid around a face: that of the only one, or (E118).

#include "components/types.hpp"

#include <span>

namespace minamo {

template <int Dim>
struct FaceDensity {
  double only;                                ///< [kg/m^3]
  std::span<const Vec<Dim>> of_several = {};  ///< of face::Density; empty: there is one liquid

  /// Where no particle is around there is none of several.
  double at(std::size_t face, Eigen::Index axis) const {
    return of_several.empty() || of_several[face][axis] == 0 ? only : of_several[face][axis];
  }
};

}  // namespace minamo
