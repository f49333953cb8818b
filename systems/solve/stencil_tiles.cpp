#include "systems/solve/stencil_tiles.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Of x = -8: room for the periodic ghosts of a periodic axis and a padding beside them.
template <int Dim>
int tile_at(int x) {
  constexpr int width = StencilTiles<Dim>::width;
  return (x + 2 * width) / width;
}

template <int Dim>
std::size_t line_of(const Grid<Dim>& grid, const Index<Dim>& node) {
  std::size_t number = 0;
  for (int d = Dim - 1; d > 0; --d) {
    number =
        number * static_cast<std::size_t>(grid.nodes(d)) + static_cast<std::size_t>(node[static_cast<std::size_t>(d)]);
  }
  return number;
}

}  // namespace

/// The tile of a node or periodic ghost of the last line, and one more on each side.
template <int Dim>
void StencilTiles<Dim>::cover(int tile) {
  constexpr auto w = static_cast<std::uint32_t>(width);
  const bool fresh = runs_.size() == lines_.back().first_run ||
                     first_tile_.back() + static_cast<int>(runs_.back().length / w) < tile - 1;
  if (fresh) {
    runs_.push_back({runs_.back().begin + runs_.back().length, 0});
    first_tile_.push_back(tile - 1);
  }
  runs_.back().length = w * static_cast<std::uint32_t>(tile + 2 - first_tile_.back());
}

template <int Dim>
void StencilTiles<Dim>::find_runs(const Grid<Dim>& grid, std::span<const Index<Dim>> site,
                                  std::span<const std::uint32_t> node) {
  // The first run stands for what is beyond the water.
  runs_.assign(1, {0, 3 * width});
  first_tile_.assign(1, 0);
  lines_.clear();
  const int nodes = grid.nodes(0);
  const auto x_of = [&](std::size_t r) { return site[node[r]][0]; };
  for (std::size_t begin = 0, end = 0; begin < node.size(); begin = end) {
    const std::size_t number = line_of<Dim>(grid, site[node[begin]]);
    while (end < node.size() && line_of<Dim>(grid, site[node[end]]) == number) ++end;
    lines_.push_back({number, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(runs_.size())});
    const std::size_t before = grid.periodic[0] ? std::min<std::size_t>(2, end - begin) : 0;
    for (std::size_t r = end - before; r < end; ++r) {
      if (x_of(r) >= nodes - 2) cover(tile_at<Dim>(x_of(r) - nodes));
    }
    for (std::size_t r = begin; r < end; ++r) cover(tile_at<Dim>(x_of(r)));
    for (std::size_t r = begin; r < begin + before; ++r) {
      if (x_of(r) < 2) cover(tile_at<Dim>(x_of(r) + nodes));
    }
  }
  lines_.push_back(
      {~std::size_t{0}, static_cast<std::uint32_t>(node.size()), static_cast<std::uint32_t>(runs_.size())});
}

/// The places in lines_ of the lines that a stencil sees, -1 where there is none.
template <int Dim>
std::array<std::int32_t, StencilTiles<Dim>::lines> StencilTiles<Dim>::lines_around(const Grid<Dim>& grid,
                                                                                   std::size_t number) const {
  Index<Dim> own{};
  for (int d = 1; d < Dim; ++d) {
    own[static_cast<std::size_t>(d)] = static_cast<int>(number % static_cast<std::size_t>(grid.nodes(d)));
    number /= static_cast<std::size_t>(grid.nodes(d));
  }
  std::array<std::int32_t, lines> around;
  for (std::size_t l = 0; l < lines; ++l) {
    around[l] = -1;
    Index<Dim> there = own;
    std::size_t rest = l;
    bool inside = true;
    for (int d = 1; d < Dim; ++d, rest /= 5) {
      auto& at = there[static_cast<std::size_t>(d)];
      at = grid.wrapped(d, at + static_cast<int>(rest % 5) - 2);
      inside = inside && at >= 0 && at < grid.nodes(d);
    }
    if (!inside) continue;
    const std::size_t wanted = line_of<Dim>(grid, there);
    const auto found = std::lower_bound(lines_.begin(), lines_.end(), wanted,
                                        [](const Line& line, std::size_t value) { return line.number < value; });
    if (found->number == wanted) around[l] = static_cast<std::int32_t>(found - lines_.begin());
  }
  return around;
}

template <int Dim>
std::uint32_t StencilTiles<Dim>::lane_in_line(std::int32_t line, int tile) const {
  constexpr auto w = static_cast<std::uint32_t>(width);
  if (line >= 0) {
    const auto l = static_cast<std::size_t>(line);
    for (std::uint32_t r = lines_[l].first_run; r < lines_[l + 1].first_run && first_tile_[r] <= tile; ++r) {
      const std::uint32_t at = w * static_cast<std::uint32_t>(tile - first_tile_[r]);
      if (at < runs_[r].length) return runs_[r].begin + at;
    }
  }
  return w;
}

template <int Dim>
void StencilTiles<Dim>::find_tiles(const Grid<Dim>& grid) {
  for (std::size_t l = 0; l + 1 < lines_.size(); ++l) {
    const auto around = lines_around(grid, lines_[l].number);
    for (std::size_t r = lines_[l].first_run; r < lines_[l + 1].first_run; ++r) {
      for (std::uint32_t at = 0; at < runs_[r].length; at += width) {
        Tile tile{runs_[r].begin + at, {}, {}};
        bool empty = true;
        for (std::size_t i = 0; i < width; ++i) {
          const std::int32_t row = row_[tile.lane + i];
          const bool own = row >= 0 && lane_[static_cast<std::size_t>(row)] == tile.lane + i;
          tile.row[i] = own ? row : -1;
          if (own) tile_of_row_[static_cast<std::size_t>(row)] = static_cast<std::uint32_t>(tiles_.size());
          empty = empty && !own;
        }
        if (empty) {
          padding_.push_back(tile.lane);
          continue;
        }
        const int number = first_tile_[r] + static_cast<int>(at / width);
        for (std::size_t k = 0; k < lines; ++k) tile.beside[k] = lane_in_line(around[k], number);
        tiles_.push_back(tile);
      }
    }
  }
}

template <int Dim>
bool StencilTiles<Dim>::is_whole(const Tile& tile) const {
  if (std::any_of(tile.row.begin(), tile.row.end(), [](std::int32_t row) { return row < 0; })) return false;
  for (const std::uint32_t beside : tile.beside) {
    if (is_outside(beside)) return false;
    for (std::size_t x = 0; x < width + 4; ++x) {
      if (row_[beside - 2 + x] < 0) return false;
    }
  }
  return true;
}

template <int Dim>
void StencilTiles<Dim>::build(const Grid<Dim>& grid, std::span<const Index<Dim>> site,
                              std::span<const std::uint32_t> node) {
  find_runs(grid, site, node);
  // A padding for those who look beside the last tile.
  const std::size_t lanes = runs_.back().begin + runs_.back().length + width;
  row_.assign(lanes, -1);
  lane_.resize(node.size());
  tile_of_row_.resize(node.size());
  ghosts_.clear();
  tiles_.clear();
  padding_.clear();
  for (std::uint32_t at = 0; at < 3 * width; at += width) padding_.push_back(at);
  padding_.push_back(static_cast<std::uint32_t>(lanes - width));
  const int nodes = grid.nodes(0);
  for (std::size_t l = 0; l + 1 < lines_.size(); ++l) {
    const auto lane_at = [&](int x) {
      return lane_in_line(static_cast<std::int32_t>(l), tile_at<Dim>(x)) +
             static_cast<std::uint32_t>((x + 2 * static_cast<int>(width)) % static_cast<int>(width));
    };
    for (std::uint32_t r = lines_[l].first_row; r < lines_[l + 1].first_row; ++r) {
      const int x = site[node[r]][0];
      lane_[r] = lane_at(x);
      row_[lane_[r]] = static_cast<std::int32_t>(r);
      if (!grid.periodic[0] || (x >= 2 && x < nodes - 2)) continue;
      ghosts_.push_back({lane_[r], lane_at(x < 2 ? x + nodes : x - nodes)});
      row_[ghosts_.back()[1]] = static_cast<std::int32_t>(r);
    }
  }
  find_tiles(grid);
}

template class StencilTiles<2>;
template class StencilTiles<3>;

}  // namespace minamo
