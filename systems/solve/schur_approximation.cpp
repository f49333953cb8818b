#include "systems/solve/schur_approximation.hpp"

#include "engine/parallel.hpp"
#include "systems/grid/node_volume.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace minamo {

namespace {

/// A row is cut where at least so much of the volume around its node is filled. Fewer whole rows save less in the
/// factorization than they cost in iterations.
constexpr double full = 0.9;

/// Where the neighbour at a place of the stencil of 5^d has its place in one of (2 Reach + 1)^d.
template <int Dim, int Reach>
constexpr std::size_t wider(std::size_t place) {
  constexpr std::size_t size = 2 * Reach + 1;
  std::size_t out = 0;
  for (std::size_t d = 0, step = 1; d < static_cast<std::size_t>(Dim); ++d, place /= 5, step *= size) {
    out += (place % 5 + Reach - 2) * step;
  }
  return out;
}

/// sum[J - I] += weight[K - I] from[J - K] along x, for K and J up to two nodes from I and K.
/// \param from     entry of the tile of the K that has the x of I, those of the next J `step` further
/// \param to_next  how far the tiles beside it are
template <int Reach>
[[gnu::always_inline]] inline void add_line(const std::array<Lanes, 5>& weight, const double* from, std::size_t step,
                                            std::size_t to_next, std::array<Lanes, 2 * Reach + 1>& sum) {
  constexpr auto beside = static_cast<std::size_t>(4 - Reach);
  const auto add = [&]<std::size_t J>() __attribute__((always_inline)) {
    const std::array<Lanes, 5> entry = around(from + J * step, to_next);
    for (std::size_t k = 0; k < 5; ++k) {
      if (k + J >= beside && k + J <= 8 - beside) sum[k + J - beside] += weight[k] * entry[k];
    }
  };
  [&]<std::size_t... Before>(std::index_sequence<Before...>) __attribute__((always_inline)) {
    (add.template operator()<4 - Before>(), ...);
  }
  (std::make_index_sequence<5>());
}

/// Where the line at J - I begins in a stencil of (2 Reach + 1)^d, from the lines at K - I and J - K; none if it is
/// not there.
template <int Dim, int Reach>
constexpr std::optional<std::size_t> line_in(std::size_t to_k, std::size_t from_k) {
  constexpr std::size_t size = 2 * Reach + 1;
  std::size_t begin = 0;
  for (std::size_t d = 1, step = size; d < static_cast<std::size_t>(Dim); ++d, step *= size) {
    const std::size_t at = to_k % 5 + from_k % 5 + Reach;
    if (at < 4 || at > 4 + 2 * Reach) return std::nullopt;
    begin += (at - 4) * step;
    to_k /= 5;
    from_k /= 5;
  }
  return begin;
}

/// Finds rows of nodes up to four nodes away from one.
template <int Dim>
class WideStencil {
 public:
  WideStencil(const Operators<Dim>& t, const Grid<Dim>& grid, std::size_t row) : t_(t), find_(*t.rows_of_sites) {
    const Index<Dim>& own = t.site[t.node[row]];
    for (int d = 0; d < Dim; ++d) {
      const auto axis = static_cast<std::size_t>(d);
      for (int step = -4; step <= 4; ++step) {
        const int at = grid.wrapped(d, own[axis] + step);
        if (at >= 0 && at < grid.nodes(d))
          part_[axis][static_cast<std::size_t>(step + 4)] = t.rows_of_sites->part(d, at);
      }
    }
  }
  /// The row at an offset, -1 if there is none.
  std::int32_t row(const Index<Dim>& offset) {
    typename SiteRows<Dim>::Address at;
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto& part = part_[d][static_cast<std::size_t>(offset[d] + 4)];
      if (!part) return -1;
      at = at + *part;
    }
    const auto i = find_(at);
    return i ? t_.row[*i] : -1;
  }

 private:
  const Operators<Dim>& t_;
  typename SiteRows<Dim>::Finder find_;
  std::array<std::array<std::optional<typename SiteRows<Dim>::Address>, 9>, Dim> part_;  ///< none outside the grid
};

/// Whether the wide stencil does not meet itself around a short periodic axis.
template <int Dim>
bool wide_stencil_fits(const Grid<Dim>& grid) {
  for (int d = 0; d < Dim; ++d) {
    if (grid.periodic[static_cast<std::size_t>(d)] && grid.nodes(d) < 9) return false;
  }
  return true;
}

}  // namespace

/// c_v N_IK/(c_a m_K) for the rows I of a tile and the nodes K in a line of their stencil, by direction.
template <int Dim>
auto SchurApproximation<Dim>::surface_weights(const From& from, const Tile& tile, std::size_t line) const
    -> std::array<std::array<Lanes, 5>, Dim> {
  const TileEntries<Dim>& gradient = from.schur.gradient_entries();
  const double* to_tile = gradient.at(tile.lane);
  const double* per_mass = per_mass_.data() + tile.line(line);
  std::array<const double*, StencilTiles<Dim>::width> from_tile;
  for (std::size_t i = 0; i < from_tile.size(); ++i) {
    const std::int32_t row = tile.row[i];
    from_tile[i] = row < 0 ? no_row.data() : from.terms.divergence[static_cast<std::size_t>(row)].data();
  }
  std::array<std::array<Lanes, 5>, Dim> weight;
  for (std::size_t x = 0; x < 5; ++x) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const std::size_t entry = Dim * (5 * line + x) + d;
      weight[d][x] = (load(to_tile + entry * tile_width) + take(from_tile, entry)) *
                     load(per_mass + d * from.schur.tiles().lanes() + x);
    }
  }
  return weight;
}

/// Adds c_v N (c_a m)^-1 D^T to the rows of a tile, J at its place in a stencil of (2 Reach + 1)^d.
template <int Dim>
template <int Reach>
void SchurApproximation<Dim>::add_surface(const From& from, const Tile& tile, Lanes* sum) const {
  const TileEntries<Dim>& gradient = from.schur.gradient_entries();
  for (std::size_t line = 0; line < StencilTiles<Dim>::lines; ++line) {
    const std::uint32_t base = tile.beside[line];
    if (StencilTiles<Dim>::is_outside(base)) continue;
    const auto weight = surface_weights(from, tile, line);
    const double* of_line = gradient.at(base);
    for (std::size_t on = 0; on < StencilTiles<Dim>::lines; ++on) {
      const auto begin = line_in<Dim, Reach>(line, on);
      if (!begin) continue;
      std::array<Lanes, 2 * Reach + 1> sum_of_line;
      sum_of_line.fill(Lanes::Zero());
      for (std::size_t d = 0; d < Dim; ++d) {
        add_line<Reach>(weight[d], of_line + (5 * on * Dim + d) * tile_width, Dim * tile_width, gradient.to_next(),
                        sum_of_line);
      }
      for (std::size_t x = 0; x < sum_of_line.size(); ++x) sum[*begin + x] += sum_of_line[x];
    }
  }
}

template <int Dim>
void SchurApproximation<Dim>::fill_tile(const From& from, const Tile& tile) {
  const Operators<Dim>& t = from.terms;
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto of_row = [](std::int32_t row) { return static_cast<std::size_t>(row); };
  const bool reaches_far = std::any_of(tile.row.begin(), tile.row.end(),
                                       [&](std::int32_t row) { return row >= 0 && is_partially_filled_[of_row(row)]; });
  std::array<Lanes, stencil_size<Dim>> sum;
  if (reaches_far) {
    std::array<Lanes, power(std::size_t{9}, Dim)> wide;
    wide.fill(Lanes::Zero());
    add_surface<4>(from, tile, wide.data());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = wide[wider<Dim, 4>(k)];
    fill_far_entries(from, tile, wide.data());
  } else {
    sum.fill(Lanes::Zero());
    add_surface<2>(from, tile, sum.data());
  }
  const double* pressure = from.schur.divergence_entries().at(tile.lane) + Dim * tile_width;
  double* entry = entries_.at(tile.lane);
  for (std::size_t k = 0; k < sum.size(); ++k) {
    store(sum[k] + from.of_laplacian * load(pressure + (Dim + 1) * k * tile_width), entry + k * tile_width);
  }
  for (std::size_t i = 0; i < StencilTiles<Dim>::width; ++i) {
    if (tile.row[i] < 0) continue;
    const std::size_t r = of_row(tile.row[i]);
    entry[own * tile_width + i] += (1 - from.of_laplacian) * t.pressure_per_mass * t.m_i[t.node[r]];
    scale_[r] = 1 / std::sqrt(std::max(entry[own * tile_width + i], pressure[(Dim + 1) * own * tile_width + i]));
  }
}

namespace {

template <int Dim>
struct WidePlace {
  std::size_t number;
  Index<Dim> offset;
};

/// The places of the wide stencil that are not in the compact one.
template <int Dim>
const auto& far_places() {
  static const auto places = [] {
    std::array<WidePlace<Dim>, power(std::size_t{9}, Dim) - stencil_size<Dim>> made;
    std::size_t count = 0;
    for (std::size_t k = 0; k < power(std::size_t{9}, Dim); ++k) {
      Index<Dim> offset;
      for (std::size_t d = 0, rest = k; d < static_cast<std::size_t>(Dim); ++d, rest /= 9) {
        offset[d] = static_cast<int>(rest % 9) - 4;
      }
      if (std::any_of(offset.begin(), offset.end(), [](int o) { return std::abs(o) > 2; })) made[count++] = {k, offset};
    }
    return made;
  }();
  return places;
}

}  // namespace

/// Keeps of the wide stencil what lies beyond the compact one, in the rows of partially filled nodes.
template <int Dim>
void SchurApproximation<Dim>::fill_far_entries(const From& from, const Tile& tile, const Lanes* wide) {
  for (std::size_t i = 0; i < StencilTiles<Dim>::width; ++i) {
    if (tile.row[i] < 0 || !is_partially_filled_[static_cast<std::size_t>(tile.row[i])]) continue;
    auto& far = far_entries_[static_cast<std::size_t>(tile.row[i])];
    WideStencil<Dim> stencil(from.terms, from.grid, static_cast<std::size_t>(tile.row[i]));
    for (const auto& [number, offset] : far_places<Dim>()) {
      const double value = wide[number][static_cast<Eigen::Index>(i)];
      if (value == 0) continue;
      const std::int32_t there = stencil.row(offset);
      if (there >= 0) far.push_back({static_cast<std::uint32_t>(there), value});
    }
  }
}

template <int Dim>
void SchurApproximation<Dim>::fill_rows(const From& from, const Fluid& fluid) {
  const Operators<Dim>& t = from.terms;
  const StencilTiles<Dim>& tiles = from.schur.tiles();
  const bool may_be_whole = wide_stencil_fits(from.grid);
  per_mass_.assign(Dim * tiles.lanes(), 0.0);
  for_each_row(tiles.rows(), [&](std::size_t r) {
    const std::uint32_t i = t.node[r];
    is_partially_filled_[r] = may_be_whole && t.m_i[i] < full * fluid.density * full_volume<Dim>(from.grid, t.site[i]);
    far_entries_[r].clear();
    for (std::size_t d = 0; d < Dim; ++d) {
      const bool held = t.fixed[i] >> d & 1;
      per_mass_[d * tiles.lanes() + tiles.lane(r)] = held ? 0 : t.c_v / (t.c_a * t.m_i[i]);
    }
  });
  for (std::size_t d = 0; d < Dim; ++d) tiles.fill_ghosts(per_mass_.data() + d * tiles.lanes());
}

template <int Dim>
void SchurApproximation<Dim>::assemble(const Operators<Dim>& t, const Grid<Dim>& grid, const Fluid& fluid,
                                       double of_laplacian, const SchurOperator<Dim>& schur) {
  const From from{t, grid, schur, of_laplacian};
  entries_.resize(schur.tiles(), stencil_size<Dim>);
  scale_.resize(schur.rows());
  is_partially_filled_.resize(schur.rows());
  far_entries_.resize(schur.rows());
  fill_rows(from, fluid);
  const auto& tiles = schur.tiles().tiles();
  for_each_row(
      tiles.size(), [&](std::size_t b) { fill_tile(from, tiles[b]); }, tiles_per_task);
}

template class SchurApproximation<2>;
template class SchurApproximation<3>;

}  // namespace minamo
