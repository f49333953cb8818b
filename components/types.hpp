#pragma once
/// \file
/// Small fixed-size vectors and matrices, and powers known at compile time.

#include "engine/storage/world.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace minamo {

// Not aligned: columns are plain arrays of doubles, and 2-D vectors pack without gaps.
/// A vector: `v[0]` is its x-component.
template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1, Eigen::DontAlign>;
/// A matrix: `A(i, j)`; of a gradient the derivative of component i along j.
template <int Dim>
using Mat = Eigen::Matrix<double, Dim, Dim, Eigen::DontAlign>;
/// Place of a node, cell or site in the grid: (i, j) or (i, j, k).
template <int Dim>
using Index = std::array<int, static_cast<std::size_t>(Dim)>;

/// The lanes of a register. Made in one piece: a vector that is stored number by number and loaded whole waits for the
/// stores.
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;

/// The same numbers as a vector of Eigen's.
template <class Vector>
inline Vector as_vector(const Four& four) {
  static_assert(sizeof(Vector) == sizeof(Four));
  Vector vector;
  std::memcpy(vector.data(), &four, sizeof four);
  return vector;
}

/// base^exponent.
constexpr std::size_t power(std::size_t base, int exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/// The first numbers of a list.
template <int Dim>
Vec<Dim> vec_of(const std::vector<double>& numbers) {
  return Eigen::Map<const Vec<Dim>>(numbers.data());
}

/// A box with sides along the axes, infinite unless told.
template <int Dim>
struct Bounds {
  Vec<Dim> low = Vec<Dim>::Constant(-std::numeric_limits<double>::infinity());  ///< lowest corner [m]
  Vec<Dim> high = Vec<Dim>::Constant(std::numeric_limits<double>::infinity());  ///< highest corner [m]

  /// Whether no side is at infinity.
  bool finite() const { return low.allFinite() && high.allFinite(); }
};

/// Nodes that carry a particle: 3 per direction.
template <int Dim>
inline constexpr std::size_t support_size = power(3, Dim);

/// Nodes that share a particle with a node: 5 per direction.
template <int Dim>
inline constexpr std::size_t stencil_size = power(5, Dim);

/// Components of an angular momentum: 1 in 2-D, 3 in 3-D.
template <int Dim>
inline constexpr int rotations = Dim == 2 ? 1 : 3;

// Columns of these are compiled once, in types.cpp.
extern template class ColumnStorage<Vec<1>>;
extern template class ColumnStorage<Vec<2>>;
extern template class ColumnStorage<Vec<3>>;
extern template class ColumnStorage<Mat<2>>;
extern template class ColumnStorage<Mat<3>>;
extern template class ColumnStorage<Index<2>>;
extern template class ColumnStorage<Index<3>>;

}  // namespace minamo
