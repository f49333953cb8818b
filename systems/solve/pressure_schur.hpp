#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity block.

#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/solve/operators.hpp"
#include "systems/solve/row_blocks.hpp"

namespace minamo {

/// Pressures and displacements where products look for them, per slot, one direction after the other.
struct SlotValues {
  Values pressure, velocity;
};

template <int Dim>
class PressureSchur {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.schur", "S", "", Lifetime::scratch};

  void assemble(const Operators<Dim>& terms, const Grid<Dim>& grid);
  const Coefficients& coefficients() const { return coefficients_; }

  const RowBlocks<Dim>& blocks() const { return blocks_; }
  std::size_t rows() const { return blocks_.rows(); }
  /// 1/(c_a m_I + c_v K_II) at [Dim r + d], 0 towards walls.
  const Values& mobility() const { return mobility_; }
  /// D_JI at [Dim k + d], good for images, too.
  const BlockEntries<Dim>& push_entries() const { return push_; }
  /// B_IJ at [(Dim + 1) k + d], T_IJ + e at [(Dim + 1) k + Dim].
  const BlockEntries<Dim>& spread_entries() const { return spread_; }

  /// Blocks whose rows are read once for all.
  std::size_t inner_blocks() const;

  /// Room for products: zeros, which stay where there is no row.
  void start(SlotValues& work) const;
  /// out = D^T p, at [Dim r + d].
  void apply_gradient(const Values& p, SlotValues& work, Values& out) const;
  /// out = B w + (T + e) p, w at [Dim r + d].
  void apply_divergence(const Values& w, const Values& p, SlotValues& work, Values& out) const;
  /// out = S p with the mobility for A^-1.
  void apply_with_mobility(const Values& p, SlotValues& work, Values& out) const;

 private:
  using Block = typename RowBlocks<Dim>::Block;
  static constexpr std::size_t own_pressure = (Dim + 1) * (stencil_size<Dim> / 2) + Dim;
  /// Of the rows of a block at one place of the stencil, T without e.
  struct Entries {
    std::array<Lanes, Dim> push;
    std::array<Lanes, Dim + 1> spread;
  };
  /// Of rows deep in the liquid, (E68), which are all alike: products need not read them from memory row by row.
  struct InnerRow {
    std::array<double, Dim * stencil_size<Dim>> push;
    std::array<double, (Dim + 1) * stencil_size<Dim>> spread;
    std::array<double, Dim> push_tolerance;
    std::array<double, Dim + 1> spread_tolerance;
  };

  void fill_mobility(const Operators<Dim>& terms);
  Entries entries(const Operators<Dim>& terms, const Block& block, std::size_t place) const;
  bool take_inner(const Operators<Dim>& terms, const Block& block);
  bool is_inner(const Entries& found, std::size_t place) const;
  void fill_block(const Operators<Dim>& terms, std::size_t b);
  void fill_margins();
  template <class Source>
  std::array<Lanes, Dim> push_lines(const Block& block, const Source& entries, const SlotValues& work) const;
  template <class Source>
  Lanes spread_lines(const Block& block, const Source& entries, const SlotValues& work) const;
  std::array<Lanes, Dim> push_block(std::size_t b, const SlotValues& work) const;
  Lanes spread_block(std::size_t b, const SlotValues& work) const;
  void spread_blocks(SlotValues& work, Values& out) const;
  void take_pressure(const Values& p, SlotValues& work) const;
  double* velocity(SlotValues& work, std::size_t d) const { return work.velocity.data() + d * blocks_.slots(); }
  const double* velocity(const SlotValues& work, std::size_t d) const {
    return work.velocity.data() + d * blocks_.slots();
  }

  RowBlocks<Dim> blocks_;
  BlockEntries<Dim> push_;
  BlockEntries<Dim> spread_;
  InnerRow inner_{};
  bool has_inner_ = false;
  std::vector<std::uint8_t> is_inner_;  // of every block
  Values mobility_;
  Values slot_mobility_;  ///< per slot, one direction after the other
  Coefficients coefficients_;
};

}  // namespace minamo
