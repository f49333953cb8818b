#include "systems/solve/pressure_schur.hpp"

#include "engine/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

constexpr std::size_t blocks_per_task = 32;

constexpr std::size_t lanes = RowBlocks<2>::width;

/// Rows of liquid that fills its cells are sums of the same numbers, in orders of their own: what they may differ by,
/// of the largest entry of their kind.
constexpr double roundings = 1e-14;

/// Entries of a block in memory, and those that are alike in all rows of a kind.
struct Stored {
  const double* first;
  Lanes operator()(std::size_t entry) const { return load(first + entry * lanes); }
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
void PressureSchur<Dim>::fill_mobility(const Operators<Dim>& t) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const std::size_t slots = blocks_.slots();
  mobility_.resize(Dim * rows());
  slot_mobility_.assign(Dim * slots, 0.0);
  for_each_row(rows(), [&](std::size_t r) {
    const std::uint32_t i = t.node[r];
    for (std::size_t d = 0; d < Dim; ++d) {
      const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r][Dim * (Dim * own + d) + d];
      const bool held = t.fixed[i] >> d & 1;
      mobility_[Dim * r + d] = held ? 0 : 1 / (t.c_a * t.m_i[i] + friction);
      slot_mobility_[d * slots + blocks_.slot(r)] = mobility_[Dim * r + d];
    }
  });
}

template <int Dim>
auto PressureSchur<Dim>::entries(const Operators<Dim>& t, const Block& block, std::size_t k) const -> Entries {
  const std::size_t back = stencil_size<Dim> - 1 - k;
  std::array<const double*, RowBlocks<Dim>::width> to_other, from_other, stabilization;
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    const std::int32_t row = block.row[lane];
    const std::int32_t other = blocks_.row(block.at(k) + lane);
    const bool is_there = row >= 0 && other >= 0;
    const auto r = static_cast<std::size_t>(row);
    to_other[lane] = is_there ? t.divergence[r].data() + Dim * k : no_row.data();
    stabilization[lane] = is_there ? t.stabilization[r].data() + (Dim + 1) * k : no_row.data();
    from_other[lane] = is_there ? t.divergence[static_cast<std::size_t>(other)].data() + Dim * back : no_row.data();
  }
  Entries found;
  for (std::size_t d = 0; d < Dim; ++d) {
    found.push[d] = take(from_other, d);
    found.spread[d] = t.c_v * take(to_other, d) + t.c_a * take(stabilization, d);
  }
  found.spread[Dim] = take(stabilization, Dim);
  return found;
}

/// Whether the rows of a block have all their neighbours and are alike. If so, inner_ becomes what they have.
template <int Dim>
bool PressureSchur<Dim>::take_inner(const Operators<Dim>& t, const Block& block) {
  if (!blocks_.is_whole(block)) return false;
  inner_.push_tolerance.fill(0);
  inner_.spread_tolerance.fill(0);
  const auto first = static_cast<std::size_t>(block.row[0]);
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const double divergence = roundings * std::abs(t.divergence[first][Dim * k + d]);
      const double gradient = roundings * std::abs(t.stabilization[first][(Dim + 1) * k + d]);
      inner_.push_tolerance[d] = std::max(inner_.push_tolerance[d], divergence);
      inner_.spread_tolerance[d] = std::max(inner_.spread_tolerance[d], t.c_v * divergence + t.c_a * gradient);
    }
    inner_.spread_tolerance[Dim] =
        std::max(inner_.spread_tolerance[Dim], roundings * std::abs(t.stabilization[first][(Dim + 1) * k + Dim]));
  }
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const Entries found = entries(t, block, k);
    for (std::size_t d = 0; d < Dim; ++d) inner_.push[Dim * k + d] = found.push[d][0];
    for (std::size_t d = 0; d <= Dim; ++d) inner_.spread[(Dim + 1) * k + d] = found.spread[d][0];
    if (!is_inner(found, k)) return false;
  }
  return true;
}

template <int Dim>
bool PressureSchur<Dim>::is_inner(const Entries& found, std::size_t k) const {
  return are_near(found.push, inner_.push.data() + Dim * k, inner_.push_tolerance) &&
         are_near(found.spread, inner_.spread.data() + (Dim + 1) * k, inner_.spread_tolerance);
}

template <int Dim>
void PressureSchur<Dim>::fill_block(const Operators<Dim>& t, std::size_t b) {
  const Block& block = blocks_.blocks()[b];
  double* push = push_.at(block.slot);
  double* spread = spread_.at(block.slot);
  bool inner = has_inner_;
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const Entries found = entries(t, block, k);
    for (std::size_t d = 0; d < Dim; ++d) store(found.push[d], push + (Dim * k + d) * lanes);
    for (std::size_t d = 0; d <= Dim; ++d) store(found.spread[d], spread + ((Dim + 1) * k + d) * lanes);
    inner = inner && is_inner(found, k);
  }
  is_inner_[b] = inner;
  double* own = spread + own_pressure * lanes;
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    if (block.row[lane] < 0) continue;
    own[lane] += t.pressure_per_mass * t.m_i[t.node[static_cast<std::size_t>(block.row[lane])]];
  }
}

template <int Dim>
void PressureSchur<Dim>::fill_margins() {
  constexpr std::size_t entries = Dim * stencil_size<Dim>;
  blocks_.for_each_margin([&](std::uint32_t slot) {
    for (std::size_t e = 0; e < entries; ++e) store(Lanes::Zero(), push_.at(slot) + e * lanes);
  });
  blocks_.for_each_image([&](std::uint32_t from, std::uint32_t to) {
    for (std::size_t e = 0; e < entries; ++e) {
      push_.at(to)[e * lanes] = push_.at(from)[e * lanes];
    }
  });
}

template <int Dim>
void PressureSchur<Dim>::assemble(const Operators<Dim>& t, const Grid<Dim>& grid) {
  coefficients_ = t;
  blocks_.build(grid, t.site, t.node);
  push_.resize(blocks_, Dim * stencil_size<Dim>);
  spread_.resize(blocks_, (Dim + 1) * stencil_size<Dim>);
  fill_mobility(t);
  const auto& blocks = blocks_.blocks();
  has_inner_ = std::any_of(blocks.begin(), blocks.end(), [&](const Block& block) { return take_inner(t, block); });
  is_inner_.resize(blocks.size());
  for_each_row(
      blocks.size(), [&](std::size_t b) { fill_block(t, b); }, blocks_per_task);
  fill_margins();
}

template <int Dim>
std::size_t PressureSchur<Dim>::inner_blocks() const {
  return static_cast<std::size_t>(std::count(is_inner_.begin(), is_inner_.end(), 1));
}

template <int Dim>
void PressureSchur<Dim>::start(SlotValues& work) const {
  work.pressure.assign(blocks_.slots(), 0.0);
  work.velocity.assign(Dim * blocks_.slots(), 0.0);
}

template <int Dim>
void PressureSchur<Dim>::take_pressure(const Values& p, SlotValues& work) const {
  for_each_row(rows(), [&](std::size_t r) { work.pressure[blocks_.slot(r)] = p[r]; });
  blocks_.fill_images(work.pressure.data());
}

template <int Dim>
template <class Source>
auto PressureSchur<Dim>::push_lines(const Block& block, const Source& entries, const SlotValues& work) const
    -> std::array<Lanes, Dim> {
  std::array<Lanes, Dim> sum;
  sum.fill(Lanes::Zero());
  for (std::size_t line = 0; line < RowBlocks<Dim>::lines; ++line) {
    if (blocks_.is_beyond(block.beside[line])) continue;
    const double* p = work.pressure.data() + block.line(line);
    for (std::size_t d = 0; d < Dim; ++d) sum[d] += line_sum(entries, 5 * Dim * line + d, Dim, p);
  }
  return sum;
}

/// D^T p for the rows of a block.
template <int Dim>
auto PressureSchur<Dim>::push_block(std::size_t b, const SlotValues& work) const -> std::array<Lanes, Dim> {
  const Block& block = blocks_.blocks()[b];
  if (is_inner_[b]) return push_lines(block, Alike{inner_.push.data()}, work);
  return push_lines(block, Stored{push_.at(block.slot)}, work);
}

template <int Dim>
template <class Source>
Lanes PressureSchur<Dim>::spread_lines(const Block& block, const Source& entries, const SlotValues& work) const {
  Lanes sum = Lanes::Zero();
  for (std::size_t line = 0; line < RowBlocks<Dim>::lines; ++line) {
    if (blocks_.is_beyond(block.beside[line])) continue;
    const std::size_t there = block.line(line);
    const std::size_t first = 5 * (Dim + 1) * line;
    for (std::size_t d = 0; d < Dim; ++d) sum += line_sum(entries, first + d, Dim + 1, velocity(work, d) + there);
    sum += line_sum(entries, first + Dim, Dim + 1, work.pressure.data() + there);
  }
  return sum;
}

/// B w + (T + e) p of the pressure and velocity in the slots of a block.
template <int Dim>
Lanes PressureSchur<Dim>::spread_block(std::size_t b, const SlotValues& work) const {
  const Block& block = blocks_.blocks()[b];
  const Stored stored{spread_.at(block.slot)};
  if (!is_inner_[b]) return spread_lines(block, stored, work);
  // e goes with the mass of a node, which is its own.
  const Lanes e = stored(own_pressure) - inner_.spread[own_pressure];
  return spread_lines(block, Alike{inner_.spread.data()}, work) + e * load(work.pressure.data() + block.slot);
}

template <int Dim>
void PressureSchur<Dim>::spread_blocks(SlotValues& work, Values& out) const {
  for (std::size_t d = 0; d < Dim; ++d) blocks_.fill_images(velocity(work, d));
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(),
      [&](std::size_t b) {
        const Lanes sum = spread_block(b, work);
        for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
          if (blocks[b].row[lane] >= 0)
            out[static_cast<std::size_t>(blocks[b].row[lane])] = sum[static_cast<Eigen::Index>(lane)];
        }
      },
      blocks_per_task);
}

template <int Dim>
void PressureSchur<Dim>::apply_gradient(const Values& p, SlotValues& work, Values& out) const {
  take_pressure(p, work);
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(),
      [&](std::size_t b) {
        const auto sum = push_block(b, work);
        for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
          if (blocks[b].row[lane] < 0) continue;
          double* row = out.data() + Dim * static_cast<std::size_t>(blocks[b].row[lane]);
          for (std::size_t d = 0; d < Dim; ++d) row[d] = sum[d][static_cast<Eigen::Index>(lane)];
        }
      },
      blocks_per_task);
}

template <int Dim>
void PressureSchur<Dim>::apply_divergence(const Values& w, const Values& p, SlotValues& work, Values& out) const {
  take_pressure(p, work);
  for_each_row(rows(), [&](std::size_t r) {
    for (std::size_t d = 0; d < Dim; ++d) velocity(work, d)[blocks_.slot(r)] = w[Dim * r + d];
  });
  spread_blocks(work, out);
}

template <int Dim>
void PressureSchur<Dim>::apply_with_mobility(const Values& p, SlotValues& work, Values& out) const {
  take_pressure(p, work);
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(),
      [&](std::size_t b) {
        const auto sum = push_block(b, work);
        for (std::size_t d = 0; d < Dim; ++d) {
          store(sum[d] * load(slot_mobility_.data() + d * blocks_.slots() + blocks[b].slot),
                velocity(work, d) + blocks[b].slot);
        }
      },
      blocks_per_task);
  spread_blocks(work, out);
}

template class PressureSchur<2>;
template class PressureSchur<3>;

}  // namespace minamo
