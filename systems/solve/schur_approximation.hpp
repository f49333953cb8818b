#pragma once
/// \file
/// A matrix near the pressure Schur complement that can be factorized.
///
/// (E56)  P = (1 + (c_v - c_a g)/(c_a rho tau)) T + e + c_v N (c_a m)^-1 D^T, N_IJ = D_IJ + D_JI, within the stencil of
/// 5^d nodes in the rows of full nodes, with all its 9^d entries in the others. Inside the liquid N is zero and D m^-1
/// D^T is nearly L/rho = T/(rho tau); G = g D_JI, g = tau rho with PSPG, where the first factor is 1, g = 0 with OSS.
/// At free surfaces N has the condition p = 0, without which pressures would hang on e alone.

#include "components/fluid.hpp"
#include "systems/solve/schur_operator.hpp"

namespace minamo {

template <int Dim>
class SchurApproximation {
 public:
  using rows_of = ActiveNodes;
  static constexpr ComponentInfo info{"solve.schur_approximation", "P", "", Lifetime::scratch};

  struct Entry {
    std::uint32_t row;
    double value;
  };

  /// \param of_laplacian  the factor of T
  /// \param schur         assembled from the same terms
  void assemble(const Operators<Dim>& terms, const Grid<Dim>& grid, const Fluid& fluid, double of_laplacian,
                const SchurOperator<Dim>& schur);

  std::size_t rows() const { return scale_.size(); }
  /// s_I = P_II^-1/2: light nodes weigh as much in a scaled residual as heavy ones.
  const Values& scale() const { return scale_; }

  /// Calls body(row of the neighbour, entry) for the entries of a row within the stencil.
  /// \param tiles  of the rows, those of the Schur complement
  template <class Body>
  void for_each_near(const StencilTiles<Dim>& tiles, std::size_t row, const Body& body) const {
    entries_.for_each_neighbour(tiles, row, 0, 1, [&](std::size_t, std::size_t other, double value) {
      if (value != 0) body(other, value);
    });
  }
  /// Calls body(row of the neighbour, entry, entry of the way back).
  template <class Body>
  void for_each_near_pair(const StencilTiles<Dim>& tiles, std::size_t row, const Body& body) const {
    entries_.for_each_neighbour(tiles, row, 0, 1, [&](std::size_t k, std::size_t other, double value) {
      const double back = entries_.at(tiles.lane(other))[(stencil_size<Dim> - 1 - k) * StencilTiles<Dim>::width];
      if (value != 0 || back != 0) body(other, value, back);
    });
  }
  /// What lies beyond the stencil: in spray the pressures of several nodes hang on few particles, and a cut row would
  /// tie down what S leaves free.
  const std::vector<Entry>& far_entries(std::size_t row) const { return far_entries_[row]; }

 private:
  using Tile = typename StencilTiles<Dim>::Tile;
  struct From {
    const Operators<Dim>& terms;
    const Grid<Dim>& grid;
    const SchurOperator<Dim>& schur;
    double of_laplacian;
  };
  void fill_rows(const From& from, const Fluid& fluid);
  std::array<std::array<Lanes, 5>, Dim> surface_weights(const From& from, const Tile& tile, std::size_t line) const;
  template <int Reach>
  void add_surface(const From& from, const Tile& tile, Lanes* sum) const;
  void fill_tile(const From& from, const Tile& tile);
  void fill_far_entries(const From& from, const Tile& tile, const Lanes* wide);

  TileEntries<Dim> entries_;
  std::vector<std::vector<Entry>> far_entries_;
  std::vector<char> is_partially_filled_;  ///< whether a row has entries beyond the stencil
  Values scale_;
  Values per_mass_;  ///< c_v/(c_a m) per lane, one direction after the other; 0 towards walls
};

}  // namespace minamo
