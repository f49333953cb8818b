#pragma once
/// \file
/// The dual cells that hold particles, in the order in which particles are sorted: blocks of 4^d dual cells (the last
/// of an axis up to 7), cells within a block. Blocks of one colour share no node: they can be scattered from side by
/// side.

#include "components/blocks.hpp"
#include "components/types.hpp"
#include "engine/storage/component.hpp"

#include <span>
#include <vector>

namespace minamo {

/// The dual cells that hold particles, and which of them may be scattered from at the same time.
template <int Dim>
struct OccupiedCells {
  /// Dual cells per direction of a block. Less than 3 would let the cut cells of two walls share a node.
  static constexpr int block_width = 4;
  /// Two per axis, and a third where a periodic axis has an odd number of blocks.
  static constexpr std::size_t colours = power(3, Dim);

  /// A cell, the particles in it, and the rows of its nodes.
  struct Cell {
    Index<Dim> node;                                    ///< the node in its middle
    std::uint32_t begin;                                ///< first particle
    std::uint32_t end;                                  ///< past the last particle
    std::array<std::uint32_t, support_size<Dim>> rows;  ///< of its 3^d nodes, x fastest; from the system number_nodes
  };
  /// A range of `cells`.
  struct Block {
    std::uint32_t begin;  ///< first cell
    std::uint32_t end;    ///< past the last cell
  };
  std::vector<Cell> cells;                         ///< in the order of the particles
  std::array<std::vector<Block>, colours> blocks;  ///< by colour
  static constexpr ComponentInfo info{"cells", "c", "1", Lifetime::scratch};
};

/// The same for the cells of the grid, between its nodes, which the conforming discretization sorts particles by.
/// `Cell::node` is the low corner, and there are no rows of nodes.
template <int Dim>
struct GridCells : OccupiedCells<Dim> {
  static constexpr ComponentInfo info{"grid_cells", "c", "1", Lifetime::scratch};
};

/// The occupied cells, of whichever kind, as a table: row c is cells[c].
struct Cells {
  static constexpr std::string_view name = "cell";
};

namespace cell {

/// Density rho_c. [kg/m^3]
struct Density : Column<Cells, double> {
  static constexpr ComponentInfo info{"cell.density", "rho_c", "kg/m^3", Lifetime::scratch};
};

/// Dynamic viscosity mu_c. [Pa s]
struct Viscosity : Column<Cells, double> {
  static constexpr ComponentInfo info{"cell.viscosity", "mu_c", "Pa s", Lifetime::scratch};
};

/// Viscosity against a change of volume, tau_2 of (E51): only VMS has one. [Pa s]
struct BulkViscosity : Column<Cells, double> {
  static constexpr ComponentInfo info{"cell.bulk_viscosity", "tau_2", "Pa s", Lifetime::scratch};
};

/// Parameter tau_c of the stabilization. [m^3 s/kg]
struct Tau : Column<Cells, double> {
  static constexpr ComponentInfo info{"cell.tau", "tau_c", "m^3 s/kg", Lifetime::scratch};
};

/// w_c of (E61): 0 in spray, 1 in liquid. [1]
struct LiquidIndicator : Column<Cells, double> {
  static constexpr ComponentInfo info{"cell.liquid_indicator", "w_c", "1", Lifetime::scratch};
};

/// b_c of (E61): 0 in spray and thin films, 1 in the bulk. [1]
struct BulkIndicator : Column<Cells, double> {
  static constexpr ComponentInfo info{"cell.bulk_indicator", "b_c", "1", Lifetime::scratch};
};

}  // namespace cell

/// sum over the particles of a cell of V_p xi^a eta^b (zeta^c), 0 <= a, b, c <= 4, at [a + 5 b + 25 c]; xi, eta, zeta
/// in units of h from the cell's node. With mixed quadrature (E68) an integral takes the place of the sum, or of a part
/// of it. One entry per occupied cell. [m^3; m^2 in 2-D]
template <int Dim>
struct Moments {
  std::vector<std::array<double, stencil_size<Dim>>> of_cell;  ///< row c is cell c
  std::vector<std::uint8_t> is_filled;                         ///< 1 where they are those of a filled cell, (E68)
  static constexpr ComponentInfo info{"cells.moments", "M_c", "m^d", Lifetime::scratch};
};

/// Work space of the sort, kept so that a step does not allocate.
struct BinBuffer {
  BlockNumbers blocks;                        ///< those with particles
  std::vector<std::uint32_t> first_of_block;  ///< number of the first cell of every block with particles
  std::vector<std::uint32_t> number;          ///< of the cell of every particle, among the cells of such blocks
  std::vector<std::uint16_t> within;          ///< the same within its block
  std::vector<std::uint32_t> first;           ///< particle of every such cell
  std::vector<std::uint32_t> place;           ///< which particle comes here
  static constexpr ComponentInfo info{"cells.bin_buffer", "", "1", Lifetime::cache};
};

}  // namespace minamo
