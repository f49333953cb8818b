#pragma once
/// \file
/// Vectors that fill the lanes of the processor, for sums over the nodes and particles of a cell.

#include "components/types.hpp"

namespace minamo {

/// In 3-D with a fourth number, zero.
template <int Dim>
using PaddedVec = Eigen::Matrix<double, Dim == 3 ? 4 : Dim, 1>;

/// The same vector with as many numbers as fill the lanes.
template <int Dim>
inline PaddedVec<Dim> padded(const Vec<Dim>& v) {
  if constexpr (Dim == 3) {
    return as_vector<PaddedVec<3>>(Four{v[0], v[1], v[2], 0});
  } else {
    return v;
  }
}

/// The vector without the number that was added.
template <int Dim>
inline Vec<Dim> unpadded(const PaddedVec<Dim>& v) {
  return v.template head<Dim>();
}

}  // namespace minamo
