#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on scaled pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity block.
/// (E56)  P = (1 + (c_v - c_a g)/(c_a rho tau)) T + e + c_v N (c_a m)^-1 D^T, N_IJ = D_IJ + D_JI, within the stencil of
/// 5^d nodes, and beyond it between nodes less than half full: a compact matrix near S. Inside the liquid N is zero and
/// D m^-1 D^T is nearly L/rho = T/(rho tau); G = g D_JI, g = tau rho with PSPG, where the first factor is 1, g = 0 with
/// OSS. At free surfaces N has the condition p = 0, without which pressures would hang on e alone. Rows and columns are
/// scaled by s_I = S_II^-1/2, so that light nodes weigh as much in a residual as heavy ones.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/solve/equations.hpp"
#include "systems/solve/gmres.hpp"

namespace minamo {

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
  struct Entry {
    std::uint32_t row;
    double value;
  };
  /// What of (E56) lies beyond the stencil, between nodes less than half full: in spray the pressures of several nodes
  /// hang on few particles, and a cut matrix would tie down what S leaves free.
  std::vector<std::vector<Entry>> beyond;
  Values scale;     ///< s_I
  Values mobility;  ///< 1/(c_a m_I + c_v K_II) per row and component, 0 towards walls

  /// \param of_laplacian  the factor of T in (E56)
  void assemble(const EquationTerms<Dim>& terms, const Grid<Dim>& grid, const Fluid& fluid, double of_laplacian);
  std::size_t rows() const { return scale.size(); }

  /// out = D^T p, per row and component.
  void push_all(const Values& p, Values& out) const;
  /// out = B w + T p.
  void spread_all(const Values& w, const Values& p, Values& out) const;
};

}  // namespace minamo
