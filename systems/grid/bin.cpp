#include "systems/grid/bin.hpp"

#include "systems/grid/support.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// The blocks of a grid. The last block of an axis takes what is left, so that no block is narrow.
template <int Dim>
class Blocks {
 public:
  static constexpr int width = OccupiedCells<Dim>::block_width;

  /// \param first  is filled with the number of the first cell of every block
  Blocks(const Grid<Dim>& grid, std::vector<std::uint32_t>& first) : grid_(grid), first_(first) {
    std::size_t count = 1;
    for (int d = 0; d < Dim; ++d) {
      blocks_[static_cast<std::size_t>(d)] = std::max(1, grid.nodes(d) / width);
      count *= static_cast<std::size_t>(blocks_[static_cast<std::size_t>(d)]);
    }
    first.assign(count + 1, 0);
    Index<Dim> block{};
    for (std::size_t b = 0; b < count; ++b, advance(block)) first[b + 1] = first[b] + cells_in(block);
  }

  std::uint32_t cell_count() const { return first_.back(); }

  /// Cells are numbered block by block, x fastest in both.
  std::uint32_t number(const Index<Dim>& cell) const {
    std::size_t block = 0;
    std::size_t within = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      const int b = std::min(cell[d] / width, blocks_[d] - 1);
      block = block * static_cast<std::size_t>(blocks_[d]) + static_cast<std::size_t>(b);
      within = within * static_cast<std::size_t>(extent(d, b)) + static_cast<std::size_t>(cell[d] - b * width);
    }
    return first_[block] + static_cast<std::uint32_t>(within);
  }

  /// Calls start(colour) for every block and cell(number, node) for its cells, in the order of the numbers.
  template <class Start, class Cell>
  void for_each(const Start& start, const Cell& cell) const {
    std::uint32_t number = 0;
    Index<Dim> block{};
    for (std::size_t b = 0; b + 1 < first_.size(); ++b, advance(block)) {
      start(colour(block));
      for (Index<Dim> within{}; number < first_[b + 1]; ++number) {
        Index<Dim> node;
        for (std::size_t d = 0; d < Dim; ++d) node[d] = block[d] * width + within[d];
        cell(number, node);
        for (std::size_t d = 0; d < Dim && ++within[d] == extent(d, block[d]) && d + 1 < Dim; ++d) within[d] = 0;
      }
    }
  }

 private:
  /// Cells of the blocks at place b of an axis.
  int extent(std::size_t axis, int b) const {
    return b + 1 < blocks_[axis] ? width : grid_.nodes(static_cast<int>(axis)) - b * width;
  }
  std::uint32_t cells_in(const Index<Dim>& block) const {
    std::uint32_t count = 1;
    for (std::size_t d = 0; d < Dim; ++d) count *= static_cast<std::uint32_t>(extent(d, block[d]));
    return count;
  }
  void advance(Index<Dim>& block) const {
    for (std::size_t d = 0; d < Dim && ++block[d] == blocks_[d] && d + 1 < Dim; ++d) block[d] = 0;
  }
  /// Even and odd places; the last of an odd number around a periodic axis meets an even one and gets a third.
  std::size_t colour(const Index<Dim>& block) const {
    std::size_t colour = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      const bool meets_first = grid_.periodic[d] && blocks_[d] % 2 == 1 && block[d] + 1 == blocks_[d];
      colour = 3 * colour + (meets_first ? 2 : static_cast<std::size_t>(block[d] % 2));
    }
    return colour;
  }

  const Grid<Dim>& grid_;
  const std::vector<std::uint32_t>& first_;
  Index<Dim> blocks_;
};

/// Lists the cells and blocks that hold particles.
template <int Dim>
void list_occupied(const Blocks<Dim>& blocks, std::span<const std::uint32_t> first, OccupiedCells<Dim>& occupied) {
  occupied.cells.clear();
  for (auto& of_colour : occupied.blocks) of_colour.clear();
  std::size_t colour = 0;
  bool is_new = true;
  blocks.for_each(
      [&](std::size_t c) {
        colour = c;
        is_new = true;
      },
      [&](std::uint32_t number, const Index<Dim>& node) {
        if (first[number] == first[number + 1]) return;
        const auto place = static_cast<std::uint32_t>(occupied.cells.size());
        auto& of_colour = occupied.blocks[colour];
        if (is_new) of_colour.push_back({place, place});
        is_new = false;
        occupied.cells.push_back({node, first[number], first[number + 1]});
        of_colour.back().end = place + 1;
      });
}

}  // namespace

template <int Dim>
void Bin<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::Configuration<Dim>> y_p, Resize<Particles> particles,
                          Write<OccupiedCells<Dim>> cells, Update<BinBuffer> buffer) const {
  auto& [number, first, place, first_of_block] = *buffer;
  const Blocks<Dim> blocks(*grid, first_of_block);
  const std::size_t count = y_p.size();
  number.resize(count);
  place.resize(count);
  for_each_row(count, [&](std::size_t p) { number[p] = blocks.number(dual_cell<Dim>(*grid, y_p[p])); });

  // Counting sort: first[c] becomes the place of the first particle of cell c.
  first.assign(blocks.cell_count() + 1, 0);
  for (const std::uint32_t c : number) ++first[c + 1];
  for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
  list_occupied<Dim>(blocks, first, *cells);
  if (std::is_sorted(number.begin(), number.end())) return;
  for (std::size_t p = 0; p < count; ++p) place[first[number[p]]++] = static_cast<std::uint32_t>(p);
  particles.reorder(place);
}

template struct Bin<2>;
template struct Bin<3>;

}  // namespace minamo
