#pragma once
/// \file
/// How the unknowns of a step are numbered, whatever the solver: unknown (d + 1) r + i of matrix row r is component i
/// of the displacement, and the pressure for i = d.

#include "components/matrix.hpp"
#include "components/sites.hpp"

#include <span>

namespace minamo {

constexpr std::size_t unknowns_per_row(int dim) { return static_cast<std::size_t>(dim) + 1; }

/// e_I/m_I of (E27): the rate of volume change that this allows in a column of water of 1 kPa is 5e-6 1/s.
constexpr double pressure_per_mass(double dt, double density, double spacing) {
  constexpr double eps = 1e-6;
  return eps * dt / (density * density * spacing * spacing);
}

/// What the matrices of (E25), (E26) are made of.
template <int Dim>
struct EquationTerms {
  double c_v;
  double c_a;
  double pressure_per_mass;
  std::span<const std::int32_t> row;
  std::span<const std::uint8_t> fixed;
  std::span<const double> m_i;
  std::span<const Index<Dim>> site;    ///< of every node
  const SiteRows<Dim>* rows_of_sites;  ///< and which node is there
  std::span<const std::uint32_t> node;
  std::span<const typename matrix::Divergence<Dim>::value_type> divergence;
  std::span<const typename matrix::Stabilization<Dim>::value_type> stabilization;
  std::span<const typename matrix::Viscosity<Dim>::value_type> viscosity;  ///< empty if inviscid
};

}  // namespace minamo
