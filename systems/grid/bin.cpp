#include "systems/grid/bin.hpp"

#include "systems/grid/support.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Numbers dual cells block by block.
template <int Dim>
class CellOrder {
 public:
  static constexpr int width = OccupiedCells<Dim>::block_width;
  static constexpr std::size_t cells_per_block = power(width, Dim);

  explicit CellOrder(const Grid<Dim>& grid) {
    for (int d = 0; d < Dim; ++d) blocks_[static_cast<std::size_t>(d)] = (grid.nodes(d) + width - 1) / width;
  }
  std::size_t cell_count() const {
    std::size_t count = cells_per_block;
    for (const int blocks : blocks_) count *= static_cast<std::size_t>(blocks);
    return count;
  }
  std::uint32_t key(const Index<Dim>& node) const {
    std::size_t block = 0;
    std::size_t within = 0;
    for (std::size_t d = Dim; d-- > 0;) {
      block = block * static_cast<std::size_t>(blocks_[d]) + static_cast<std::size_t>(node[d] / width);
      within = within * width + static_cast<std::size_t>(node[d] % width);
    }
    return static_cast<std::uint32_t>(block * cells_per_block + within);
  }
  Index<Dim> node(std::size_t key) const {
    Index<Dim> node;
    std::size_t block = key / cells_per_block;
    std::size_t within = key % cells_per_block;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto blocks = static_cast<std::size_t>(blocks_[d]);
      node[d] = static_cast<int>(block % blocks) * width + static_cast<int>(within % width);
      block /= blocks;
      within /= width;
    }
    return node;
  }

 private:
  Index<Dim> blocks_;
};

/// Blocks of one colour have the same parity in every direction.
template <int Dim>
std::size_t colour(const Index<Dim>& node) {
  std::size_t colour = 0;
  for (std::size_t d = 0; d < Dim; ++d) {
    colour += static_cast<std::size_t>(node[d] / OccupiedCells<Dim>::block_width % 2) << d;
  }
  return colour;
}

template <int Dim>
void list_cells(const CellOrder<Dim>& order, std::span<const std::uint32_t> first, OccupiedCells<Dim>& occupied) {
  occupied.cells.clear();
  for (auto& blocks : occupied.blocks) blocks.clear();
  for (std::size_t key = 0; key + 1 < first.size(); ++key) {
    if (first[key] == first[key + 1]) continue;
    const auto place = static_cast<std::uint32_t>(occupied.cells.size());
    const Index<Dim> node = order.node(key);
    auto& blocks = occupied.blocks[colour<Dim>(node)];
    const bool continues = !blocks.empty() && blocks.back().end == place && !occupied.cells.empty() &&
                           order.key(occupied.cells.back().node) / order.cells_per_block == key / order.cells_per_block;
    if (!continues) blocks.push_back({place, place});
    occupied.cells.push_back({node, first[key], first[key + 1]});
    blocks.back().end = place + 1;
  }
}

}  // namespace

template <int Dim>
void Bin<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::Configuration<Dim>> y_p, Resize<Particles> particles,
                          Write<OccupiedCells<Dim>> cells, Update<BinBuffer> buffer) const {
  const CellOrder<Dim> order(*grid);
  const std::size_t count = y_p.size();
  auto& [key, first, place] = *buffer;
  key.resize(count);
  place.resize(count);
  for_each_row(count, [&](std::size_t p) { key[p] = order.key(dual_cell<Dim>(*grid, y_p[p])); });

  // Counting sort: first[k] becomes the place of the first particle of cell k.
  first.assign(order.cell_count() + 1, 0);
  for (const std::uint32_t k : key) ++first[k + 1];
  for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
  list_cells<Dim>(order, first, *cells);
  if (std::is_sorted(key.begin(), key.end())) return;
  for (std::size_t p = 0; p < count; ++p) place[first[key[p]]++] = static_cast<std::uint32_t>(p);
  particles.reorder(place);
}

template struct Bin<2>;
template struct Bin<3>;

}  // namespace minamo
