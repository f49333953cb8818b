#include "systems/solve/pressure_schur.hpp"

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

}  // namespace

template <int Dim>
void PressureSchur<Dim>::fill_mobility(const EquationTerms<Dim>& t) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const std::size_t slots = blocks_.slots();
  mobility_.resize(Dim * rows());
  for (Values* v : {&velocity_, &slot_mobility_, &per_mass_}) v->assign(Dim * slots, 0.0);
  pressure_.assign(slots, 0.0);
  for_each_row(rows(), [&](std::size_t r) {
    const std::uint32_t i = t.node[r];
    for (std::size_t d = 0; d < Dim; ++d) {
      const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r][Dim * (Dim * own + d) + d];
      const bool held = t.fixed[i] >> d & 1;
      mobility_[Dim * r + d] = held ? 0 : 1 / (t.c_a * t.m_i[i] + friction);
      slot_mobility_[d * slots + blocks_.slot(r)] = mobility_[Dim * r + d];
      per_mass_[d * slots + blocks_.slot(r)] = held ? 0 : t.c_v / (t.c_a * t.m_i[i]);
    }
  });
  for (std::size_t d = 0; d < Dim; ++d) blocks_.fill_images(per_mass_.data() + d * slots);
}

template <int Dim>
void PressureSchur<Dim>::fill_block(const EquationTerms<Dim>& t, const Block& block) {
  double* push = push_.at(block.slot);
  double* spread = spread_.at(block.slot);
  const std::size_t stride = push_.stride(block.slot);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::size_t back = stencil_size<Dim> - 1 - k;
    for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
      const std::int32_t row = block.row[lane];
      const std::int32_t other = row < 0 ? -1 : blocks_.row(block.at(k) + lane);
      if (other < 0) {
        for (std::size_t d = 0; d < Dim; ++d) push[(Dim * k + d) * stride + lane] = 0;
        for (std::size_t d = 0; d <= Dim; ++d) spread[((Dim + 1) * k + d) * stride + lane] = 0;
        continue;
      }
      const auto r = static_cast<std::size_t>(row);
      const auto& to_other = t.divergence[r];
      const auto& from_other = t.divergence[static_cast<std::size_t>(other)];
      const auto& stabilization = t.stabilization[r];
      for (std::size_t d = 0; d < Dim; ++d) {
        push[(Dim * k + d) * stride + lane] = from_other[Dim * back + d];
        spread[((Dim + 1) * k + d) * stride + lane] =
            t.c_v * to_other[Dim * k + d] + t.c_a * stabilization[(Dim + 1) * k + d];
      }
      const double e = k == back ? t.pressure_per_mass * t.m_i[t.node[r]] : 0;
      spread[((Dim + 1) * k + Dim) * stride + lane] = stabilization[(Dim + 1) * k + Dim] + e;
    }
  }
}

template <int Dim>
void PressureSchur<Dim>::fill_margins() {
  constexpr std::size_t entries = Dim * stencil_size<Dim>;
  blocks_.for_each_margin([&](std::uint32_t slot) {
    for (std::size_t e = 0; e < entries; ++e) store(Lanes::Zero(), push_.at(slot) + e * push_.stride(slot));
  });
  blocks_.for_each_image([&](std::uint32_t from, std::uint32_t to) {
    for (std::size_t e = 0; e < entries; ++e) {
      push_.at(to)[e * push_.stride(to)] = push_.at(from)[e * push_.stride(from)];
    }
  });
}

/// Adds c_v N (c_a m)^-1 D^T to the rows of a block, J at its place in a stencil of (2 Reach + 1)^d.
template <int Dim>
template <int Reach>
void PressureSchur<Dim>::add_surface(const EquationTerms<Dim>& t, const Block& block, Lanes* sum) const {
  const double* to_block = push_.at(block.slot);
  const std::size_t stride = push_.stride(block.slot);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::uint32_t base = block.beside[k / 5];
    if (blocks_.is_beyond(base)) continue;
    const std::size_t there = block.at(k);
    const Index<Dim> to_k = offset_of<Dim>(k, 5);
    for (std::size_t d = 0; d < Dim; ++d) {
      Lanes n = load(to_block + (Dim * k + d) * stride);
      for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
        const std::int32_t row = block.row[lane];
        if (row >= 0) n[static_cast<Eigen::Index>(lane)] += t.divergence[static_cast<std::size_t>(row)][Dim * k + d];
      }
      const Lanes weight = n * load(per_mass_.data() + d * blocks_.slots() + there);
      const std::size_t stride_k = push_.stride(base);
      add_shifted<Dim, Reach>(to_k, weight, push_.at(there, base) + d * stride_k, Dim * stride_k, sum);
    }
  }
}

template <int Dim>
void PressureSchur<Dim>::fill_compact(const EquationTerms<Dim>& t, const Grid<Dim>& grid, double of_laplacian,
                                      const Block& block) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const auto of_row = [](std::int32_t row) { return static_cast<std::size_t>(row); };
  const bool reaches_beyond =
      std::any_of(block.row.begin(), block.row.end(), [&](std::int32_t row) { return row >= 0 && thin_[of_row(row)]; });
  std::array<Lanes, stencil_size<Dim>> sum;
  if (reaches_beyond) {
    std::array<Lanes, power(std::size_t{9}, Dim)> wide;
    wide.fill(Lanes::Zero());
    add_surface<4>(t, block, wide.data());
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = wide[wider<Dim, 4>(k)];
    fill_beyond(t, grid, block, wide.data());
  } else {
    sum.fill(Lanes::Zero());
    add_surface<2>(t, block, sum.data());
  }
  const std::size_t stride = compact_.stride(block.slot);
  const double* pressure = spread_.at(block.slot) + Dim * stride;
  double* compact = compact_.at(block.slot);
  for (std::size_t k = 0; k < sum.size(); ++k) {
    store(sum[k] + of_laplacian * load(pressure + (Dim + 1) * k * stride), compact + k * stride);
  }
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    if (block.row[lane] < 0) continue;
    const std::size_t r = of_row(block.row[lane]);
    compact[own * stride + lane] += (1 - of_laplacian) * t.pressure_per_mass * t.m_i[t.node[r]];
    scale_[r] = 1 / std::sqrt(std::max(compact[own * stride + lane], pressure[(Dim + 1) * own * stride + lane]));
  }
}

/// Keeps of the wide stencil what lies beyond the compact one, in the rows of thin nodes.
template <int Dim>
void PressureSchur<Dim>::fill_beyond(const EquationTerms<Dim>& t, const Grid<Dim>& grid, const Block& block,
                                     const Lanes* wide) {
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    if (block.row[lane] < 0 || !thin_[static_cast<std::size_t>(block.row[lane])]) continue;
    auto& beyond = beyond_[static_cast<std::size_t>(block.row[lane])];
    WideStencil<Dim> stencil(t, grid, static_cast<std::size_t>(block.row[lane]));
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
void PressureSchur<Dim>::assemble(const EquationTerms<Dim>& t, const Grid<Dim>& grid, const Fluid& fluid,
                                  double of_laplacian) {
  blocks_.build(grid, t.site, t.node);
  push_.resize(blocks_, Dim * stencil_size<Dim>);
  spread_.resize(blocks_, (Dim + 1) * stencil_size<Dim>);
  compact_.resize(blocks_, stencil_size<Dim>);
  scale_.resize(rows());
  thin_.resize(rows());
  beyond_.resize(rows());
  for_each_row(rows(), [&](std::size_t r) {
    beyond_[r].clear();
    thin_[r] = t.m_i[t.node[r]] < full * fluid.density * full_volume<Dim>(grid, t.site[t.node[r]]);
  });
  fill_mobility(t);
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(), [&](std::size_t b) { fill_block(t, blocks[b]); }, blocks_per_task);
  fill_margins();
  for_each_row(
      blocks.size(), [&](std::size_t b) { fill_compact(t, grid, of_laplacian, blocks[b]); }, blocks_per_task);
}

template <int Dim>
void PressureSchur<Dim>::take_pressure(const Values& p) {
  for_each_row(rows(), [&](std::size_t r) { pressure_[blocks_.slot(r)] = p[r]; });
  blocks_.fill_images(pressure_.data());
}

/// D^T p for the rows of a block.
template <int Dim>
auto PressureSchur<Dim>::push_block(const Block& block) const -> std::array<Lanes, Dim> {
  std::array<Lanes, Dim> sum;
  sum.fill(Lanes::Zero());
  const std::size_t stride = push_.stride(block.slot);
  const double* entry = push_.at(block.slot);
  for (std::size_t line = 0; line < RowBlocks<Dim>::lines; ++line, entry += 5 * Dim * stride) {
    if (blocks_.is_beyond(block.beside[line])) continue;
    const double* p = pressure_.data() + block.at(5 * line);
    for (std::size_t x = 0; x < 5; ++x) {
      for (std::size_t d = 0; d < Dim; ++d) sum[d] += load(entry + (Dim * x + d) * stride) * load(p + x);
    }
  }
  return sum;
}

/// B w + (T + e) p of the pressure and velocity in the slots.
template <int Dim>
void PressureSchur<Dim>::spread_blocks(Values& out) {
  for (std::size_t d = 0; d < Dim; ++d) blocks_.fill_images(velocity(d));
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(),
      [&](std::size_t b) {
        const Block& block = blocks[b];
        Lanes sum = Lanes::Zero();
        const std::size_t stride = spread_.stride(block.slot);
        const double* entry = spread_.at(block.slot);
        for (std::size_t line = 0; line < RowBlocks<Dim>::lines; ++line, entry += 5 * (Dim + 1) * stride) {
          if (blocks_.is_beyond(block.beside[line])) continue;
          const std::size_t there = block.at(5 * line);
          for (std::size_t x = 0; x < 5; ++x) {
            const double* of_x = entry + (Dim + 1) * x * stride;
            for (std::size_t d = 0; d < Dim; ++d) sum += load(of_x + d * stride) * load(velocity(d) + there + x);
            sum += load(of_x + Dim * stride) * load(pressure_.data() + there + x);
          }
        }
        for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
          if (block.row[lane] >= 0)
            out[static_cast<std::size_t>(block.row[lane])] = sum[static_cast<Eigen::Index>(lane)];
        }
      },
      blocks_per_task);
}

template <int Dim>
void PressureSchur<Dim>::push(const Values& p, Values& out) {
  take_pressure(p);
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(),
      [&](std::size_t b) {
        const auto sum = push_block(blocks[b]);
        for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
          if (blocks[b].row[lane] < 0) continue;
          double* row = out.data() + Dim * static_cast<std::size_t>(blocks[b].row[lane]);
          for (std::size_t d = 0; d < Dim; ++d) row[d] = sum[d][static_cast<Eigen::Index>(lane)];
        }
      },
      blocks_per_task);
}

template <int Dim>
void PressureSchur<Dim>::spread(const Values& w, const Values& p, Values& out) {
  take_pressure(p);
  for_each_row(rows(), [&](std::size_t r) {
    for (std::size_t d = 0; d < Dim; ++d) velocity(d)[blocks_.slot(r)] = w[Dim * r + d];
  });
  spread_blocks(out);
}

template <int Dim>
void PressureSchur<Dim>::apply_with_mobility(const Values& p, Values& out) {
  take_pressure(p);
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(),
      [&](std::size_t b) {
        const auto sum = push_block(blocks[b]);
        for (std::size_t d = 0; d < Dim; ++d) {
          store(sum[d] * load(slot_mobility_.data() + d * blocks_.slots() + blocks[b].slot),
                velocity(d) + blocks[b].slot);
        }
      },
      blocks_per_task);
  spread_blocks(out);
}

template class PressureSchur<2>;
template class PressureSchur<3>;

}  // namespace minamo
