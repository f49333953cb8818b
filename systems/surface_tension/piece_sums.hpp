#pragma once
/// \file
/// Sums over the points of the surface, by sites around them. The pieces of the surface are gone through side by side,
/// each with its own sums; those are added up in the order of the pieces: the same bits on any number of threads.

#include "components/surface_tension.hpp"
#include "systems/surface_tension/point_sites.hpp"

#include <span>

namespace minamo {

/// The sums of a piece, for the sites of the cells that its points lie in.
template <int Dim, int K, class Value>
class SumsOfCells {
 public:
  using Blocks = typename PieceSums<Dim>::template Blocks<Value>;
  static constexpr std::size_t width = cell_sites<Dim, K>;

  explicit SumsOfCells(Blocks& blocks) : blocks_(blocks) {
    blocks_.cell.clear();
    blocks_.row.clear();
    blocks_.value.clear();
  }
  /// Those of the sites around the last point, in their order.
  std::span<Value> around(const PointSites<Dim, K>& sites, const Value& zero) {
    // Points that follow each other lie in few cells; one that comes back later may have a second block.
    constexpr std::size_t looked_at = 8;
    for (std::size_t back = 1; back <= std::min(looked_at, blocks_.cell.size()); ++back) {
      const std::size_t k = blocks_.cell.size() - back;
      if (blocks_.cell[k] == sites.cell()) return std::span(blocks_.value).subspan(k * width, width);
    }
    blocks_.cell.push_back(sites.cell());
    for (std::size_t k = 0; k < width; ++k) blocks_.row.push_back(sites.row(k));
    blocks_.value.resize(blocks_.value.size() + width, zero);
    return std::span(blocks_.value).last(width);
  }

 private:
  Blocks& blocks_;
};

/// Adds the sums of all pieces to the rows of the sites.
template <class Blocks, class Value>
void add_pieces(const std::vector<Blocks>& pieces, std::span<Value> to) {
  for (const Blocks& blocks : pieces) {
    for (std::size_t k = 0; k < blocks.row.size(); ++k) {
      if (blocks.row[k] != staggered::none) to[static_cast<std::size_t>(blocks.row[k])] += blocks.value[k];
    }
  }
}

}  // namespace minamo
