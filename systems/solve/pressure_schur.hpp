#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity block.

#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/solve/equations.hpp"
#include "systems/solve/row_blocks.hpp"

namespace minamo {

template <int Dim>
class PressureSchur {
 public:
  void assemble(const EquationTerms<Dim>& terms, const Grid<Dim>& grid);

  const RowBlocks<Dim>& blocks() const { return blocks_; }
  std::size_t rows() const { return blocks_.rows(); }
  /// 1/(c_a m_I + c_v K_II) at [Dim r + d], 0 towards walls.
  const Values& mobility() const { return mobility_; }
  /// D_JI at [Dim k + d], good for images, too.
  const BlockEntries<Dim>& push_entries() const { return push_; }
  /// B_IJ at [(Dim + 1) k + d], T_IJ + e at [(Dim + 1) k + Dim].
  const BlockEntries<Dim>& spread_entries() const { return spread_; }

  /// out = D^T p, at [Dim r + d].
  void push(const Values& p, Values& out);
  /// out = B w + (T + e) p, w at [Dim r + d].
  void spread(const Values& w, const Values& p, Values& out);
  /// out = S p with the mobility for A^-1.
  void apply_with_mobility(const Values& p, Values& out);

 private:
  using Block = typename RowBlocks<Dim>::Block;
  void fill_mobility(const EquationTerms<Dim>& terms);
  void fill_block(const EquationTerms<Dim>& terms, const Block& block);
  void fill_margins();
  std::array<Lanes, Dim> push_block(const Block& block) const;
  void spread_blocks(Values& out);
  void take_pressure(const Values& p);
  double* velocity(std::size_t d) { return velocity_.data() + d * blocks_.slots(); }

  RowBlocks<Dim> blocks_;
  BlockEntries<Dim> push_;
  BlockEntries<Dim> spread_;
  Values mobility_;
  // Per slot: pressure; displacement and mobility, one direction after the other.
  Values pressure_, velocity_, slot_mobility_;
};

}  // namespace minamo
