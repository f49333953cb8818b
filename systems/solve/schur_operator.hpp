#pragma once
/// \file
/// The pressure Schur complement of the equations of a step, as an operator on pressures.
///
/// (E55)  S = B A^-1 D^T + T + e, B = c_v D + c_a G: what (E25), (E26) leave when the displacement is eliminated, A the
/// velocity tile.

#include "components/grid.hpp"
#include "components/matrix.hpp"
#include "components/node.hpp"
#include "systems/solve/operators.hpp"
#include "systems/solve/stencil_tiles.hpp"

namespace minamo {

/// Pressures and displacements where products look for them, per lane, one direction after the other.
struct TileVectors {
  Values pressure, velocity;
};

template <int Dim>
class SchurOperator {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.schur", "S", "", Lifetime::scratch};

  void assemble(const Operators<Dim>& terms, const Grid<Dim>& grid);
  const Coefficients& coefficients() const { return coefficients_; }

  const StencilTiles<Dim>& tiles() const { return tiles_; }
  std::size_t rows() const { return tiles_.rows(); }
  /// 1/(c_a m_I + c_v K_II) at [Dim r + d], 0 towards walls.
  const Values& inverse_diagonal() const { return inverse_diagonal_; }
  /// D_JI at [Dim k + d], good for periodic ghosts, too.
  const TileEntries<Dim>& gradient_entries() const { return gradient_; }
  /// B_IJ at [(Dim + 1) k + d], T_IJ + e at [(Dim + 1) k + Dim].
  const TileEntries<Dim>& divergence_entries() const { return divergence_; }

  /// Tiles whose rows are read once for all.
  std::size_t inner_tiles() const;

  /// Room for products: zeros, which stay where there is no row.
  void start(TileVectors& work) const;
  /// out = D^T p, at [Dim r + d].
  void apply_gradient(const Values& p, TileVectors& work, Values& out) const;
  /// out = B w + (T + e) p, w at [Dim r + d].
  void apply_divergence(const Values& w, const Values& p, TileVectors& work, Values& out) const;
  /// out = S p with the inverse diagonal for A^-1.
  void apply_with_diagonal(const Values& p, TileVectors& work, Values& out) const;

 private:
  using Tile = typename StencilTiles<Dim>::Tile;
  static constexpr std::size_t own_pressure = (Dim + 1) * (stencil_size<Dim> / 2) + Dim;
  /// Of the rows of a tile at one place of the stencil, T without e.
  struct Entries {
    std::array<Lanes, Dim> gradient;
    std::array<Lanes, Dim + 1> divergence;
  };
  /// Of rows deep in the liquid, (E68), which are all alike: products need not read them from memory row by row.
  struct InnerRow {
    std::array<double, Dim * stencil_size<Dim>> gradient;
    std::array<double, (Dim + 1) * stencil_size<Dim>> divergence;
    std::array<double, Dim> gradient_tolerance;
    std::array<double, Dim + 1> divergence_tolerance;
  };

  void fill_inverse_diagonal(const Operators<Dim>& terms);
  Entries entries(const Operators<Dim>& terms, const Tile& tile, std::size_t place) const;
  bool take_inner(const Operators<Dim>& terms, const Tile& tile);
  bool is_inner(const Entries& found, std::size_t place) const;
  void fill_tile(const Operators<Dim>& terms, std::size_t b);
  void fill_padding();
  template <class Source>
  std::array<Lanes, Dim> gradient_in_lines(const Tile& tile, const Source& entries, const TileVectors& work) const;
  template <class Source>
  Lanes divergence_in_lines(const Tile& tile, const Source& entries, const TileVectors& work) const;
  std::array<Lanes, Dim> gradient_in_tile(std::size_t b, const TileVectors& work) const;
  Lanes divergence_in_tile(std::size_t b, const TileVectors& work) const;
  void divergence_in_tiles(TileVectors& work, Values& out) const;
  void take_pressure(const Values& p, TileVectors& work) const;
  double* velocity(TileVectors& work, std::size_t d) const { return work.velocity.data() + d * tiles_.lanes(); }
  const double* velocity(const TileVectors& work, std::size_t d) const {
    return work.velocity.data() + d * tiles_.lanes();
  }

  StencilTiles<Dim> tiles_;
  TileEntries<Dim> gradient_;
  TileEntries<Dim> divergence_;
  InnerRow inner_{};
  bool has_inner_ = false;
  std::vector<std::uint8_t> is_inner_;  // of every tile
  Values inverse_diagonal_;
  Values lane_inverse_diagonal_;  ///< per lane, one direction after the other
  Coefficients coefficients_;
};

}  // namespace minamo
