#pragma once
/// \file
/// The operators of the equations of a step, as the assembly leaves them.

#include "components/matrix.hpp"

#include <span>

namespace minamo {

/// e_I/m_I of (E27): the rate of volume change that this allows in a column of water of 1 kPa is 5e-6 1/s.
constexpr double pressure_per_mass(double dt, double density, double spacing) {
  constexpr double eps = 1e-6;
  return eps * dt / (density * density * spacing * spacing);
}

/// What multiplies the operators of (E25), (E26).
struct Coefficients {
  double c_v = 0;
  double c_a = 0;
  double pressure_per_mass = 0;
};

/// What the matrices of (E25), (E26) are made of: what one system has declared, for as long as it runs.
template <int Dim>
struct Operators : Coefficients {
  std::span<const std::int32_t> row;
  std::span<const std::uint8_t> fixed;
  std::span<const double> m_i;
  std::span<const std::uint32_t> node;
  std::span<const typename matrix::Neighbour<Dim>::value_type> neighbour;
  std::span<const typename matrix::Divergence<Dim>::value_type> divergence;
  std::span<const typename matrix::Stabilization<Dim>::value_type> stabilization;
  std::span<const typename matrix::Viscosity<Dim>::value_type> viscosity;  ///< empty if inviscid

  bool is_fixed(std::size_t r, std::size_t d) const { return fixed[node[r]] >> d & 1; }
  /// Calls body(place in the stencil, row) for the neighbours of a row that have one.
  template <class Body>
  void for_each_neighbour(std::size_t r, const Body& body) const {
    for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
      const std::int32_t other = neighbour[r][k];
      if (other == matrix::Neighbour<Dim>::none) continue;
      const std::int32_t row_of_other = row[static_cast<std::size_t>(other)];
      if (row_of_other >= 0) body(k, static_cast<std::size_t>(row_of_other));
    }
  }
};

}  // namespace minamo
