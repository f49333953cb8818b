#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on scaled pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity block.
/// (E56)  P = (1 + (c_v - c_a g)/(c_a rho tau)) T + e + c_v N (c_a m)^-1 D^T within the stencil of 5^d nodes,
/// N_IJ = D_IJ + D_JI: a compact matrix near S. Inside the liquid N is zero and D m^-1 D^T is nearly L/rho = T/(rho
/// tau); G = g D_JI, g = tau rho with PSPG, where the first factor is 1, g = 0 with OSS. At free surfaces N has the
/// condition p = 0, without which pressures would hang on e alone. Rows and columns are scaled by s_I = S_II^-1/2, so
/// that light nodes weigh as much in a residual as heavy ones.

#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/solve/gmres.hpp"

#include <span>

namespace minamo {

/// What the equations are made of.
template <int Dim>
struct BlockTerms {
  double c_v;
  double c_a;
  double pressure_per_mass;  ///< e_I/m_I of (E27)
  double of_laplacian;       ///< the factor of T in (E56)
  std::span<const std::int32_t> row;
  std::span<const std::uint8_t> fixed;
  std::span<const double> m_i;
  std::span<const std::uint32_t> node;
  std::span<const typename matrix::Divergence<Dim>::value_type> divergence;
  std::span<const typename matrix::Stabilization<Dim>::value_type> stabilization;
  std::span<const typename matrix::Viscosity<Dim>::value_type> viscosity;  ///< empty if inviscid
};

/// One entry per place of the stencil, in the order of matrix.hpp.
template <int Dim>
using StencilRow = std::array<double, stencil_size<Dim>>;

template <int Dim>
struct PressureSchur {
  std::vector<std::array<std::uint32_t, stencil_size<Dim>>> neighbour;  ///< row; the own one where there is none
  std::vector<std::array<StencilRow<Dim>, Dim>> push;                   ///< D_JI s_J: force on row I by pressure J
  std::vector<std::array<StencilRow<Dim>, Dim>> spread;                 ///< s_I B_IJ
  std::vector<StencilRow<Dim>> pressure;                                ///< s_I (T_IJ + e) s_J
  std::vector<StencilRow<Dim>> compact;                                 ///< (E56), scaled
  Values scale;                                                         ///< s_I
  Values mobility;  ///< 1/(c_a m_I + c_v K_II) per row and component, 0 towards walls

  void assemble(const BlockTerms<Dim>& terms, const Grid<Dim>& grid);
  std::size_t rows() const { return scale.size(); }

  /// out = D^T p, per row and component.
  void push_all(const Values& p, Values& out) const;
  /// out = B w + T p.
  void spread_all(const Values& w, const Values& p, Values& out) const;
};

}  // namespace minamo
