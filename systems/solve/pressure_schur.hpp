#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity block.
/// (E56)  P = (1 + (c_v - c_a g)/(c_a rho tau)) T + e + c_v N (c_a m)^-1 D^T, N_IJ = D_IJ + D_JI: a matrix near S,
/// within the stencil of 5^d nodes in the rows of full nodes, with all its 9^d entries in the others. Inside the liquid
/// N is zero and D m^-1 D^T is nearly L/rho = T/(rho tau); G = g D_JI, g = tau rho with PSPG, where the first factor is
/// 1, g = 0 with OSS. At free surfaces N has the condition p = 0, without which pressures would hang on e alone.

#include "components/fluid.hpp"
#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/solve/equations.hpp"
#include "systems/solve/row_blocks.hpp"

namespace minamo {

template <int Dim>
class PressureSchur {
 public:
  struct Entry {
    std::uint32_t row;
    double value;
  };

  /// \param of_laplacian  the factor of T in (E56)
  void assemble(const EquationTerms<Dim>& terms, const Grid<Dim>& grid, const Fluid& fluid, double of_laplacian);

  const RowBlocks<Dim>& blocks() const { return blocks_; }
  std::size_t rows() const { return blocks_.rows(); }
  /// s_I = P_II^-1/2: light nodes weigh as much in a scaled residual as heavy ones.
  const Values& scale() const { return scale_; }
  /// 1/(c_a m_I + c_v K_II) at [Dim r + d], 0 towards walls.
  const Values& mobility() const { return mobility_; }

  /// out = D^T p, at [Dim r + d].
  void push(const Values& p, Values& out);
  /// out = B w + (T + e) p, w at [Dim r + d].
  void spread(const Values& w, const Values& p, Values& out);
  /// out = S p with the mobility for A^-1.
  void apply_with_mobility(const Values& p, Values& out);

  /// Calls body(row of the neighbour, entry) for the entries of a row of (E56) within the stencil.
  template <class Body>
  void for_each_compact(std::size_t row, const Body& body) const {
    for_each_entry(compact_, 1, 0, row, body);
  }
  /// Calls body(row of the neighbour, entry, entry of the way back).
  template <class Body>
  void for_each_compact_pair(std::size_t row, const Body& body) const {
    blocks_.for_each_neighbour(row, [&](std::size_t k, std::size_t other) {
      const double value = compact(row, k);
      const double back = compact(other, stencil_size<Dim> - 1 - k);
      if (value != 0 || back != 0) body(other, value, back);
    });
  }
  /// The same as for_each_compact() for T + e.
  template <class Body>
  void for_each_pressure(std::size_t row, const Body& body) const {
    for_each_entry(spread_, Dim + 1, Dim, row, body);
  }
  /// What of (E56) lies beyond the stencil: in spray the pressures of several nodes hang on few particles, and a cut
  /// row would tie down what S leaves free.
  const std::vector<Entry>& beyond(std::size_t row) const { return beyond_[row]; }

 private:
  using Block = typename RowBlocks<Dim>::Block;
  template <class Body>
  void for_each_entry(const BlockEntries<Dim>& entries, std::size_t width, std::size_t component, std::size_t row,
                      const Body& body) const {
    const std::size_t slot = blocks_.slot(row);
    const double* first = entries.at(slot) + component * entries.stride(slot);
    const std::size_t step = width * entries.stride(slot);
    blocks_.for_each_neighbour(row, [&](std::size_t k, std::size_t other) {
      if (first[k * step] != 0) body(other, first[k * step]);
    });
  }
  double compact(std::size_t row, std::size_t place) const {
    const std::size_t slot = blocks_.slot(row);
    return compact_.at(slot)[place * compact_.stride(slot)];
  }
  void fill_mobility(const EquationTerms<Dim>& terms);
  void fill_block(const EquationTerms<Dim>& terms, const Block& block);
  void fill_margins();
  template <int Reach>
  void add_surface(const EquationTerms<Dim>& terms, const Block& block, Lanes* sum) const;
  void fill_compact(const EquationTerms<Dim>& terms, const Grid<Dim>& grid, double of_laplacian, const Block& block);
  void fill_beyond(const EquationTerms<Dim>& terms, const Grid<Dim>& grid, const Block& block, const Lanes* wide);
  std::array<Lanes, Dim> push_block(const Block& block) const;
  void spread_blocks(Values& out);
  void take_pressure(const Values& p);
  double* velocity(std::size_t d) { return velocity_.data() + d * blocks_.slots(); }

  RowBlocks<Dim> blocks_;
  BlockEntries<Dim> push_;     ///< D_JI at [Dim k + d]
  BlockEntries<Dim> spread_;   ///< B_IJ at [(Dim + 1) k + d], T_IJ + e at [(Dim + 1) k + Dim]
  BlockEntries<Dim> compact_;  ///< (E56) within the stencil
  std::vector<std::vector<Entry>> beyond_;
  std::vector<char> thin_;  ///< whether a row has entries beyond the stencil
  Values scale_, mobility_;
  // Per slot: pressure; displacement and mobility, one direction after the other; c_v/(c_a m), 0 towards walls.
  Values pressure_, velocity_, slot_mobility_, per_mass_;
};

}  // namespace minamo
