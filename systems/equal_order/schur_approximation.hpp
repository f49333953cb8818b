#pragma once
/// \file
/// A matrix near the pressure Schur complement, with entries that can be written down.
///
/// (E56)  P = (1 + (c_v - c_a g)/(c_a rho tau)) T + e + c_v N (c_a m)^-1 D^T, N_IJ = D_IJ + D_JI, within the stencil of
/// 5^d nodes in the rows of full nodes, with all its 9^d entries in the others. Inside the liquid N is zero and D m^-1
/// D^T is nearly L/rho = T/(rho tau); G = g D_JI, g = tau rho with PSPG, where the first factor is 1, g = 0 with OSS.
/// At free surfaces N has the condition p = 0, without which pressures would hang on e alone. In spray the pressures of
/// several nodes hang on few particles, and a cut row would tie down what S leaves free.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "systems/equal_order/schur_operator.hpp"
#include "systems/linear/incomplete_lu.hpp"

namespace minamo {

template <int Dim>
class SchurApproximation {
 public:
  /// \param capacity      of every node
  /// \param of_laplacian  the factor of T
  /// \param schur         assembled from the same terms
  void assemble(const Operators<Dim>& terms, const Grid<Dim>& grid, std::span<const double> capacity,
                const Fluid& fluid, double of_laplacian, const SchurOperator<Dim>& schur);

  std::size_t rows() const { return scale_.size(); }
  const SparseRows& matrix() const { return matrix_; }
  /// s_I = P_II^-1/2: light nodes weigh as much in a scaled residual as heavy ones.
  const Values& scale() const { return scale_; }

 private:
  /// The places of 9^d nodes around one.
  struct WideRow;
  struct From {
    const Operators<Dim>& terms;
    const SchurOperator<Dim>& schur;
    double of_laplacian;
  };
  void find_reach(const From& from, const Grid<Dim>& grid, std::span<const double> capacity, const Fluid& fluid);
  void add_surface(const From& from, std::size_t row, WideRow& wide) const;
  void add_entry(std::size_t row, const WideRow& wide, std::size_t at);
  void fill_row(const From& from, std::size_t row);
  void close_gaps();

  SparseRows matrix_;
  std::vector<std::uint32_t> entries_;  ///< of every row
  std::vector<std::uint8_t> reach_;     ///< of every row, in nodes
  std::vector<Four> per_mass_;          ///< c_v/(c_a m) of every row by directions, 0 towards walls
  Values scale_;
};

}  // namespace minamo
