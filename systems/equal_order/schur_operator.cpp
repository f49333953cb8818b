#include "systems/equal_order/schur_operator.hpp"

#include "engine/schedule/parallel.hpp"

#include <algorithm>

namespace minamo {

namespace {

constexpr std::size_t table_rows_per_task = 128;

/// The sum over a stencil, in five parts: no addition waits for many others.
template <int Dim, class Term>
[[gnu::always_inline]] inline Four stencil_sum(const Term& term) {
  std::array<Four, 5> part{};
  for (std::size_t line = 0; line < stencil_size<Dim>; line += 5) {
    for (std::size_t x = 0; x < 5; ++x) part[x] += term(line + x);
  }
  return ((part[0] + part[1]) + (part[3] + part[4])) + part[2];
}

}  // namespace

template <int Dim>
void SchurOperator<Dim>::fill_row(const Operators<Dim>& t, std::size_t r) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  Neighbours& neighbours = neighbours_[r];
  Entries& gradient = gradient_[r];
  Entries& divergence = divergence_[r];
  neighbours.fill(static_cast<std::uint32_t>(rows()));
  gradient.fill(Four{});
  divergence.fill(Four{});
  t.for_each_neighbour(r, [&](std::size_t k, std::size_t other) {
    neighbours[k] = static_cast<std::uint32_t>(other);
    for (std::size_t d = 0; d < Dim; ++d) {
      gradient[k][d] = t.divergence[other][Dim * (stencil_size<Dim> - 1 - k) + d];
      divergence[k][d] = t.c_v * t.divergence[r][Dim * k + d] + t.c_a * t.stabilization[r][(Dim + 1) * k + d];
    }
    divergence[k][Dim] = t.stabilization[r][(Dim + 1) * k + Dim];
  });
  pressure_of_mass_[r] = t.pressure_per_mass * t.m_i[t.node[r]];
  for (std::size_t d = 0; d < Dim; ++d) {
    const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r][Dim * (Dim * own + d) + d];
    inverse_diagonal_[Dim * r + d] = t.is_fixed(r, d) ? 0 : 1 / (t.c_a * t.m_i[t.node[r]] + friction);
  }
}

template <int Dim>
void SchurOperator<Dim>::assemble(const Operators<Dim>& t) {
  coefficients_ = t;
  neighbours_.resize(t.node.size());
  gradient_.resize(rows());
  divergence_.resize(rows());
  pressure_of_mass_.resize(rows());
  inverse_diagonal_.resize(Dim * rows());
  for_each_row(
      rows(), [&](std::size_t r) { fill_row(t, r); }, table_rows_per_task);
}

template <int Dim>
void SchurOperator<Dim>::take_pressure(const Values& p, SchurVectors& work) const {
  work.pressure.resize(rows() + 1);
  work.velocity_and_pressure.resize(rows() + 1);
  work.pressure.back() = 0;
  work.velocity_and_pressure.back() = Four{};
  std::copy(p.begin(), p.end(), work.pressure.begin());
}

template <int Dim>
Four SchurOperator<Dim>::gradient_at(std::size_t r, const SchurVectors& work) const {
  const Entries& entries = gradient(r);
  return stencil_sum<Dim>([&](std::size_t k) { return entries[k] * work.pressure[neighbours_[r][k]]; });
}

template <int Dim>
void SchurOperator<Dim>::find_divergence(const SchurVectors& work, Values& out) const {
  for_each_row(
      rows(),
      [&](std::size_t r) {
        const Entries& entries = divergence(r);
        const Four sum =
            stencil_sum<Dim>([&](std::size_t k) { return entries[k] * work.velocity_and_pressure[neighbours_[r][k]]; });
        out[r] = (sum[0] + sum[1]) + (sum[2] + sum[3]) + pressure_of_mass_[r] * work.pressure[r];
      },
      table_rows_per_task);
}

template <int Dim>
void SchurOperator<Dim>::apply_gradient(const Values& p, SchurVectors& work, Values& out) const {
  take_pressure(p, work);
  for_each_row(
      rows(),
      [&](std::size_t r) {
        const Four sum = gradient_at(r, work);
        for (std::size_t d = 0; d < Dim; ++d) out[Dim * r + d] = sum[d];
      },
      table_rows_per_task);
}

template <int Dim>
void SchurOperator<Dim>::apply_divergence(const Values& w, const Values& p, SchurVectors& work, Values& out) const {
  take_pressure(p, work);
  for_each_row(rows(), [&](std::size_t r) {
    Four& x = work.velocity_and_pressure[r];
    for (std::size_t d = 0; d < Dim; ++d) x[d] = w[Dim * r + d];
    x[Dim] = p[r];
  });
  find_divergence(work, out);
}

template <int Dim>
void SchurOperator<Dim>::apply_with_diagonal(const Values& p, SchurVectors& work, Values& out) const {
  take_pressure(p, work);
  for_each_row(
      rows(),
      [&](std::size_t r) {
        Four sum = gradient_at(r, work);
        for (std::size_t d = 0; d < Dim; ++d) sum[d] *= inverse_diagonal_[Dim * r + d];
        sum[Dim] = p[r];
        work.velocity_and_pressure[r] = sum;
      },
      table_rows_per_task);
  find_divergence(work, out);
}

template class SchurOperator<2>;
template class SchurOperator<3>;

}  // namespace minamo
