#include "systems/solve/pressure_schur.hpp"

#include "engine/parallel.hpp"

namespace minamo {

namespace {

constexpr std::size_t blocks_per_task = 32;

/// The sum over the five neighbours in a line of the stencil, as a tree: no addition waits for many others.
[[gnu::always_inline]] inline Lanes line_sum(const double* entry, std::size_t step, const double* x) {
  const auto term = [&](std::size_t k) -> Lanes { return load(entry + k * step) * load(x + k); };
  return ((term(0) + term(1)) + (term(3) + term(4))) + term(2);
}

}  // namespace

template <int Dim>
void PressureSchur<Dim>::fill_mobility(const EquationTerms<Dim>& t) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const std::size_t slots = blocks_.slots();
  mobility_.resize(Dim * rows());
  for (Values* v : {&velocity_, &slot_mobility_}) v->assign(Dim * slots, 0.0);
  pressure_.assign(slots, 0.0);
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
void PressureSchur<Dim>::fill_block(const EquationTerms<Dim>& t, const Block& block) {
  double* push = push_.at(block.slot);
  double* spread = spread_.at(block.slot);
  const std::size_t stride = push_.stride(block.slot);
  std::array<const double*, RowBlocks<Dim>::width> to_other, from_other, stabilization;
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::size_t back = stencil_size<Dim> - 1 - k;
    for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
      const std::int32_t row = block.row[lane];
      const std::int32_t other = blocks_.row(block.at(k) + lane);
      const bool is_there = row >= 0 && other >= 0;
      const auto r = static_cast<std::size_t>(row);
      to_other[lane] = is_there ? t.divergence[r].data() + Dim * k : no_row.data();
      stabilization[lane] = is_there ? t.stabilization[r].data() + (Dim + 1) * k : no_row.data();
      from_other[lane] = is_there ? t.divergence[static_cast<std::size_t>(other)].data() + Dim * back : no_row.data();
    }
    for (std::size_t d = 0; d < Dim; ++d) {
      store(take(from_other, d), push + (Dim * k + d) * stride);
      store(t.c_v * take(to_other, d) + t.c_a * take(stabilization, d), spread + ((Dim + 1) * k + d) * stride);
    }
    store(take(stabilization, Dim), spread + ((Dim + 1) * k + Dim) * stride);
  }
  double* own = spread + ((Dim + 1) * (stencil_size<Dim> / 2) + Dim) * stride;
  for (std::size_t lane = 0; lane < RowBlocks<Dim>::width; ++lane) {
    if (block.row[lane] < 0) continue;
    own[lane] += t.pressure_per_mass * t.m_i[t.node[static_cast<std::size_t>(block.row[lane])]];
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

template <int Dim>
void PressureSchur<Dim>::assemble(const EquationTerms<Dim>& t, const Grid<Dim>& grid) {
  blocks_.build(grid, t.site, t.node);
  push_.resize(blocks_, Dim * stencil_size<Dim>);
  spread_.resize(blocks_, (Dim + 1) * stencil_size<Dim>);
  fill_mobility(t);
  const auto& blocks = blocks_.blocks();
  for_each_row(
      blocks.size(), [&](std::size_t b) { fill_block(t, blocks[b]); }, blocks_per_task);
  fill_margins();
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
    const double* p = pressure_.data() + block.line(line);
    for (std::size_t d = 0; d < Dim; ++d) sum[d] += line_sum(entry + d * stride, Dim * stride, p);
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
          const std::size_t there = block.line(line);
          for (std::size_t d = 0; d < Dim; ++d) {
            sum += line_sum(entry + d * stride, (Dim + 1) * stride, velocity(d) + there);
          }
          sum += line_sum(entry + Dim * stride, (Dim + 1) * stride, pressure_.data() + there);
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
