#include "systems/solve/schur_operator.hpp"

#include "engine/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Rows of liquid that fills its cells are sums of the same numbers, in orders of their own: what they may differ by,
/// of the largest entry of their kind.
constexpr double roundings = 1e-14;

/// Entries of a tile in memory, and those that are alike in all rows of a kind.
struct Stored {
  const double* first;
  Lanes operator()(std::size_t entry) const { return load(first + entry * tile_width); }
};
struct Alike {
  const double* entries;
  Lanes operator()(std::size_t entry) const { return Lanes::Constant(entries[entry]); }
};

/// The sum over the five neighbours in a line of the stencil, as a tree: no addition waits for many others.
template <class Entries>
[[gnu::always_inline]] inline Lanes line_sum(const Entries& entries, std::size_t first, std::size_t step,
                                             const double* x) {
  const auto term = [&](std::size_t k) -> Lanes { return entries(first + k * step) * load(x + k); };
  return ((term(0) + term(1)) + (term(3) + term(4))) + term(2);
}

template <std::size_t N>
bool are_near(const std::array<Lanes, N>& values, const double* there, const std::array<double, N>& tolerance) {
  for (std::size_t e = 0; e < N; ++e) {
    if (((values[e] - there[e]).abs() > tolerance[e]).any()) return false;
  }
  return true;
}

}  // namespace

template <int Dim>
void SchurOperator<Dim>::fill_inverse_diagonal(const Operators<Dim>& t) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const std::size_t lanes = tiles_.lanes();
  inverse_diagonal_.resize(Dim * rows());
  lane_inverse_diagonal_.assign(Dim * lanes, 0.0);
  for_each_row(rows(), [&](std::size_t r) {
    const std::uint32_t i = t.node[r];
    for (std::size_t d = 0; d < Dim; ++d) {
      const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r][Dim * (Dim * own + d) + d];
      const bool held = t.fixed[i] >> d & 1;
      inverse_diagonal_[Dim * r + d] = held ? 0 : 1 / (t.c_a * t.m_i[i] + friction);
      lane_inverse_diagonal_[d * lanes + tiles_.lane(r)] = inverse_diagonal_[Dim * r + d];
    }
  });
}

template <int Dim>
auto SchurOperator<Dim>::entries(const Operators<Dim>& t, const Tile& tile, std::size_t k) const -> Entries {
  const std::size_t back = stencil_size<Dim> - 1 - k;
  std::array<const double*, StencilTiles<Dim>::width> to_other, from_other, stabilization;
  for (std::size_t i = 0; i < StencilTiles<Dim>::width; ++i) {
    const std::int32_t row = tile.row[i];
    const std::int32_t other = tiles_.row(tile.at(k) + i);
    const bool is_there = row >= 0 && other >= 0;
    const auto r = static_cast<std::size_t>(row);
    to_other[i] = is_there ? t.divergence[r].data() + Dim * k : no_row.data();
    stabilization[i] = is_there ? t.stabilization[r].data() + (Dim + 1) * k : no_row.data();
    from_other[i] = is_there ? t.divergence[static_cast<std::size_t>(other)].data() + Dim * back : no_row.data();
  }
  Entries found;
  for (std::size_t d = 0; d < Dim; ++d) {
    found.gradient[d] = take(from_other, d);
    found.divergence[d] = t.c_v * take(to_other, d) + t.c_a * take(stabilization, d);
  }
  found.divergence[Dim] = take(stabilization, Dim);
  return found;
}

/// Whether the rows of a tile have all their neighbours and are alike. If so, inner_ becomes what they have.
template <int Dim>
bool SchurOperator<Dim>::take_inner(const Operators<Dim>& t, const Tile& tile) {
  if (!tiles_.is_whole(tile)) return false;
  inner_.gradient_tolerance.fill(0);
  inner_.divergence_tolerance.fill(0);
  const auto first = static_cast<std::size_t>(tile.row[0]);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const double divergence = roundings * std::abs(t.divergence[first][Dim * k + d]);
      const double gradient = roundings * std::abs(t.stabilization[first][(Dim + 1) * k + d]);
      inner_.gradient_tolerance[d] = std::max(inner_.gradient_tolerance[d], divergence);
      inner_.divergence_tolerance[d] = std::max(inner_.divergence_tolerance[d], t.c_v * divergence + t.c_a * gradient);
    }
    inner_.divergence_tolerance[Dim] =
        std::max(inner_.divergence_tolerance[Dim], roundings * std::abs(t.stabilization[first][(Dim + 1) * k + Dim]));
  }
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const Entries found = entries(t, tile, k);
    for (std::size_t d = 0; d < Dim; ++d) inner_.gradient[Dim * k + d] = found.gradient[d][0];
    for (std::size_t d = 0; d <= Dim; ++d) inner_.divergence[(Dim + 1) * k + d] = found.divergence[d][0];
    if (!is_inner(found, k)) return false;
  }
  return true;
}

template <int Dim>
bool SchurOperator<Dim>::is_inner(const Entries& found, std::size_t k) const {
  return are_near(found.gradient, inner_.gradient.data() + Dim * k, inner_.gradient_tolerance) &&
         are_near(found.divergence, inner_.divergence.data() + (Dim + 1) * k, inner_.divergence_tolerance);
}

template <int Dim>
void SchurOperator<Dim>::fill_tile(const Operators<Dim>& t, std::size_t b) {
  const Tile& tile = tiles_.tiles()[b];
  double* gradient = gradient_.at(tile.lane);
  double* divergence = divergence_.at(tile.lane);
  bool inner = has_inner_;
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const Entries found = entries(t, tile, k);
    for (std::size_t d = 0; d < Dim; ++d) store(found.gradient[d], gradient + (Dim * k + d) * tile_width);
    for (std::size_t d = 0; d <= Dim; ++d) store(found.divergence[d], divergence + ((Dim + 1) * k + d) * tile_width);
    inner = inner && is_inner(found, k);
  }
  is_inner_[b] = inner;
  double* own = divergence + own_pressure * tile_width;
  for (std::size_t i = 0; i < StencilTiles<Dim>::width; ++i) {
    if (tile.row[i] < 0) continue;
    own[i] += t.pressure_per_mass * t.m_i[t.node[static_cast<std::size_t>(tile.row[i])]];
  }
}

template <int Dim>
void SchurOperator<Dim>::fill_padding() {
  constexpr std::size_t entries = Dim * stencil_size<Dim>;
  tiles_.for_each_padding([&](std::uint32_t lane) {
    for (std::size_t e = 0; e < entries; ++e) store(Lanes::Zero(), gradient_.at(lane) + e * tile_width);
  });
  tiles_.for_each_ghost([&](std::uint32_t from, std::uint32_t to) {
    for (std::size_t e = 0; e < entries; ++e) {
      gradient_.at(to)[e * tile_width] = gradient_.at(from)[e * tile_width];
    }
  });
}

template <int Dim>
void SchurOperator<Dim>::assemble(const Operators<Dim>& t, const Grid<Dim>& grid) {
  coefficients_ = t;
  tiles_.build(grid, t.site, t.node);
  gradient_.resize(tiles_, Dim * stencil_size<Dim>);
  divergence_.resize(tiles_, (Dim + 1) * stencil_size<Dim>);
  fill_inverse_diagonal(t);
  const auto& tiles = tiles_.tiles();
  has_inner_ = std::any_of(tiles.begin(), tiles.end(), [&](const Tile& tile) { return take_inner(t, tile); });
  is_inner_.resize(tiles.size());
  for_each_row(
      tiles.size(), [&](std::size_t b) { fill_tile(t, b); }, tiles_per_task);
  fill_padding();
}

template <int Dim>
std::size_t SchurOperator<Dim>::inner_tiles() const {
  return static_cast<std::size_t>(std::count(is_inner_.begin(), is_inner_.end(), 1));
}

template <int Dim>
void SchurOperator<Dim>::start(TileVectors& work) const {
  work.pressure.assign(tiles_.lanes(), 0.0);
  work.velocity.assign(Dim * tiles_.lanes(), 0.0);
}

template <int Dim>
void SchurOperator<Dim>::take_pressure(const Values& p, TileVectors& work) const {
  for_each_row(rows(), [&](std::size_t r) { work.pressure[tiles_.lane(r)] = p[r]; });
  tiles_.fill_ghosts(work.pressure.data());
}

template <int Dim>
template <class Source>
auto SchurOperator<Dim>::gradient_in_lines(const Tile& tile, const Source& entries, const TileVectors& work) const
    -> std::array<Lanes, Dim> {
  std::array<Lanes, Dim> sum;
  sum.fill(Lanes::Zero());
  for (std::size_t line = 0; line < StencilTiles<Dim>::lines; ++line) {
    if (tiles_.is_outside(tile.beside[line])) continue;
    const double* p = work.pressure.data() + tile.line(line);
    for (std::size_t d = 0; d < Dim; ++d) sum[d] += line_sum(entries, 5 * Dim * line + d, Dim, p);
  }
  return sum;
}

/// D^T p for the rows of a tile.
template <int Dim>
auto SchurOperator<Dim>::gradient_in_tile(std::size_t b, const TileVectors& work) const -> std::array<Lanes, Dim> {
  const Tile& tile = tiles_.tiles()[b];
  if (is_inner_[b]) return gradient_in_lines(tile, Alike{inner_.gradient.data()}, work);
  return gradient_in_lines(tile, Stored{gradient_.at(tile.lane)}, work);
}

template <int Dim>
template <class Source>
Lanes SchurOperator<Dim>::divergence_in_lines(const Tile& tile, const Source& entries, const TileVectors& work) const {
  Lanes sum = Lanes::Zero();
  for (std::size_t line = 0; line < StencilTiles<Dim>::lines; ++line) {
    if (tiles_.is_outside(tile.beside[line])) continue;
    const std::size_t there = tile.line(line);
    const std::size_t first = 5 * (Dim + 1) * line;
    for (std::size_t d = 0; d < Dim; ++d) sum += line_sum(entries, first + d, Dim + 1, velocity(work, d) + there);
    sum += line_sum(entries, first + Dim, Dim + 1, work.pressure.data() + there);
  }
  return sum;
}

/// B w + (T + e) p of the pressure and velocity in the lanes of a tile.
template <int Dim>
Lanes SchurOperator<Dim>::divergence_in_tile(std::size_t b, const TileVectors& work) const {
  const Tile& tile = tiles_.tiles()[b];
  const Stored stored{divergence_.at(tile.lane)};
  if (!is_inner_[b]) return divergence_in_lines(tile, stored, work);
  // e goes with the mass of a node, which is its own.
  const Lanes e = stored(own_pressure) - inner_.divergence[own_pressure];
  return divergence_in_lines(tile, Alike{inner_.divergence.data()}, work) + e * load(work.pressure.data() + tile.lane);
}

template <int Dim>
void SchurOperator<Dim>::divergence_in_tiles(TileVectors& work, Values& out) const {
  for (std::size_t d = 0; d < Dim; ++d) tiles_.fill_ghosts(velocity(work, d));
  const auto& tiles = tiles_.tiles();
  for_each_row(
      tiles.size(),
      [&](std::size_t b) {
        const Lanes sum = divergence_in_tile(b, work);
        for (std::size_t i = 0; i < StencilTiles<Dim>::width; ++i) {
          if (tiles[b].row[i] >= 0) out[static_cast<std::size_t>(tiles[b].row[i])] = sum[static_cast<Eigen::Index>(i)];
        }
      },
      tiles_per_task);
}

template <int Dim>
void SchurOperator<Dim>::apply_gradient(const Values& p, TileVectors& work, Values& out) const {
  take_pressure(p, work);
  const auto& tiles = tiles_.tiles();
  for_each_row(
      tiles.size(),
      [&](std::size_t b) {
        const auto sum = gradient_in_tile(b, work);
        for (std::size_t i = 0; i < StencilTiles<Dim>::width; ++i) {
          if (tiles[b].row[i] < 0) continue;
          double* row = out.data() + Dim * static_cast<std::size_t>(tiles[b].row[i]);
          for (std::size_t d = 0; d < Dim; ++d) row[d] = sum[d][static_cast<Eigen::Index>(i)];
        }
      },
      tiles_per_task);
}

template <int Dim>
void SchurOperator<Dim>::apply_divergence(const Values& w, const Values& p, TileVectors& work, Values& out) const {
  take_pressure(p, work);
  for_each_row(rows(), [&](std::size_t r) {
    for (std::size_t d = 0; d < Dim; ++d) velocity(work, d)[tiles_.lane(r)] = w[Dim * r + d];
  });
  divergence_in_tiles(work, out);
}

template <int Dim>
void SchurOperator<Dim>::apply_with_diagonal(const Values& p, TileVectors& work, Values& out) const {
  take_pressure(p, work);
  const auto& tiles = tiles_.tiles();
  for_each_row(
      tiles.size(),
      [&](std::size_t b) {
        const auto sum = gradient_in_tile(b, work);
        for (std::size_t d = 0; d < Dim; ++d) {
          store(sum[d] * load(lane_inverse_diagonal_.data() + d * tiles_.lanes() + tiles[b].lane),
                velocity(work, d) + tiles[b].lane);
        }
      },
      tiles_per_task);
  divergence_in_tiles(work, out);
}

template class SchurOperator<2>;
template class SchurOperator<3>;

}  // namespace minamo
