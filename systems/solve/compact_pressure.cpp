#include "systems/solve/compact_pressure.hpp"

#include "engine/parallel.hpp"
#include "systems/grid/node_volume.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

constexpr std::size_t blocks_per_task = 32;

/// A row is cut where at least so much of the volume around its node is filled. Fewer whole rows save less in the
/// factorization than they cost in iterations.
constexpr double full = 0.9;

constexpr std::ptrdiff_t signed_size(std::size_t n) { return static_cast<std::ptrdiff_t>(n); }

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

/// sum[J] += weight from[J - K] for the J within reach of I and two nodes of K; `to_k` from I to K.
template <int Dim, int Reach, int Axis = Dim - 1>
inline void add_shifted(const Index<Dim>& to_k, const Lanes& weight, const double* from, std::size_t stride,
                        Lanes* sum) {
  constexpr std::size_t size = 2 * Reach + 1;
  constexpr auto step_to = signed_size(power(size, Axis));
  const auto step_from = signed_size(power(std::size_t{5}, Axis) * stride);
  const int shift = to_k[static_cast<std::size_t>(Axis)];
  for (int j = std::max(-2, -Reach - shift); j <= std::min(2, Reach - shift); ++j) {
    const double* there = from + (j + 2) * step_from;
    Lanes* to = sum + (j + shift + Reach) * step_to;
    if constexpr (Axis == 0) {
      *to += weight * load(there);
    } else {
      add_shifted<Dim, Reach, Axis - 1>(to_k, weight, there, stride, to);
    }
  }
}

template <int Dim>
Index<Dim> offset_of(std::size_t place, int size) {
  Index<Dim> offset;
  for (std::size_t d = 0; d < static_cast<std::size_t>(Dim); ++d) {
    offset[d] = static_cast<int>(place % static_cast<std::size_t>(size)) - size / 2;
    place /= static_cast<std::size_t>(size);
  }
  return offset;
}

/// Finds rows of nodes up to four nodes away from one.
template <int Dim>
class WideStencil {
 public:
  WideStencil(const EquationTerms<Dim>& t, const Grid<Dim>& grid, std::size_t row) : t_(t), find_(*t.rows_of_sites) {
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
  const EquationTerms<Dim>& t_;
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

/// Adds c_v N (c_a m)^-1 D^T to the rows of a block, J at its place in a stencil of (2 Reach + 1)^d.
template <int Dim>
template <int Reach>
void CompactPressure<Dim>::add_surface(const From& from, const Block& block, Lanes* sum) const {
  const BlockEntries<Dim>& push = from.schur.push_entries();
  const double* to_block = push.at(block.slot);
  const std::size_t stride = push.stride(block.slot);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::uint32_t base = block.beside[k / 5];
    if (RowBlocks<Dim>::is_beyond(base)) continue;
    const std::size_t there = block.at(k);
    const Index<Dim> to_k = offset_of<Dim>(k, 5);
    for (std::size_t d = 0; d < Dim; ++d) {
      Lanes n = load(to_block + (Dim * k + d) * stride);
      for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
        const std::int32_t row = block.row[lane];
        if (row >= 0)
          n[static_cast<Eigen::Index>(lane)] += from.terms.divergence[static_cast<std::size_t>(row)][Dim * k + d];
      }
      const Lanes weight = n * load(per_mass_.data() + d * from.schur.blocks().slots() + there);
      const std::size_t stride_k = push.stride(base);
      add_shifted<Dim, Reach>(to_k, weight, push.at(there, base) + d * stride_k, Dim * stride_k, sum);
    }
  }
}

template <int Dim>
void CompactPressure<Dim>::fill_block(const From& from, const Block& block) {
  const EquationTerms<Dim>& t = from.terms;
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto of_row = [](std::int32_t row) { return static_cast<std::size_t>(row); };
  const bool reaches_beyond =
      std::any_of(block.row.begin(), block.row.end(), [&](std::int32_t row) { return row >= 0 && thin_[of_row(row)]; });
  std::array<Lanes, stencil_size<Dim>> sum;
  if (reaches_beyond) {
    std::array<Lanes, power(std::size_t{9}, Dim)> wide;
    wide.fill(Lanes::Zero());
    add_surface<4>(from, block, wide.data());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = wide[wider<Dim, 4>(k)];
    fill_beyond(from, block, wide.data());
  } else {
    sum.fill(Lanes::Zero());
    add_surface<2>(from, block, sum.data());
  }
  const std::size_t stride = entries_.stride(block.slot);
  const double* pressure = from.schur.spread_entries().at(block.slot) + Dim * stride;
  double* entry = entries_.at(block.slot);
  for (std::size_t k = 0; k < sum.size(); ++k) {
    store(sum[k] + from.of_laplacian * load(pressure + (Dim + 1) * k * stride), entry + k * stride);
  }
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    if (block.row[lane] < 0) continue;
    const std::size_t r = of_row(block.row[lane]);
    entry[own * stride + lane] += (1 - from.of_laplacian) * t.pressure_per_mass * t.m_i[t.node[r]];
    scale_[r] = 1 / std::sqrt(std::max(entry[own * stride + lane], pressure[(Dim + 1) * own * stride + lane]));
  }
}

/// Keeps of the wide stencil what lies beyond the compact one, in the rows of thin nodes.
template <int Dim>
void CompactPressure<Dim>::fill_beyond(const From& from, const Block& block, const Lanes* wide) {
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    if (block.row[lane] < 0 || !thin_[static_cast<std::size_t>(block.row[lane])]) continue;
    auto& beyond = beyond_[static_cast<std::size_t>(block.row[lane])];
    WideStencil<Dim> stencil(from.terms, from.grid, static_cast<std::size_t>(block.row[lane]));
    for (std::size_t k = 0; k < power(std::size_t{9}, Dim); ++k) {
      const double value = wide[k][static_cast<Eigen::Index>(lane)];
      if (value == 0) continue;
      const Index<Dim> offset = offset_of<Dim>(k, 9);
      if (std::all_of(offset.begin(), offset.end(), [](int o) { return std::abs(o) <= 2; })) continue;
      const std::int32_t there = stencil.row(offset);
      if (there < 0) continue;
      beyond.push_back({static_cast<std::uint32_t>(there), value});
    }
  }
}

template <int Dim>
void CompactPressure<Dim>::fill_rows(const From& from, const Fluid& fluid) {
  const EquationTerms<Dim>& t = from.terms;
  const RowBlocks<Dim>& blocks = from.schur.blocks();
  const bool may_be_whole = wide_stencil_fits(from.grid);
  per_mass_.assign(Dim * blocks.slots(), 0.0);
  for_each_row(blocks.rows(), [&](std::size_t r) {
    const std::uint32_t i = t.node[r];
    thin_[r] = may_be_whole && t.m_i[i] < full * fluid.density * full_volume<Dim>(from.grid, t.site[i]);
    beyond_[r].clear();
    for (std::size_t d = 0; d < Dim; ++d) {
      const bool held = t.fixed[i] >> d & 1;
      per_mass_[d * blocks.slots() + blocks.slot(r)] = held ? 0 : t.c_v / (t.c_a * t.m_i[i]);
    }
  });
  for (std::size_t d = 0; d < Dim; ++d) blocks.fill_images(per_mass_.data() + d * blocks.slots());
}

template <int Dim>
void CompactPressure<Dim>::assemble(const EquationTerms<Dim>& t, const Grid<Dim>& grid, const Fluid& fluid,
                                    double of_laplacian, const PressureSchur<Dim>& schur) {
  const From from{t, grid, schur, of_laplacian};
  entries_.resize(schur.blocks(), stencil_size<Dim>);
  scale_.resize(schur.rows());
  thin_.resize(schur.rows());
  beyond_.resize(schur.rows());
  fill_rows(from, fluid);
  const auto& blocks = schur.blocks().blocks();
  for_each_row(
      blocks.size(), [&](std::size_t b) { fill_block(from, blocks[b]); }, blocks_per_task);
}

template class CompactPressure<2>;
template class CompactPressure<3>;

}  // namespace minamo
