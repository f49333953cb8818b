#include "systems/equal_order/monolithic.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// Whether node I of row r_i and node J at place `to_j` of its stencil share a particle: only then has an entry a
/// value. The pressure term alone does not tell: one particle in the middle of every cell makes it cancel for
/// neighbours along an axis.
template <int Dim>
bool coupled(const Operators<Dim>& t, std::size_t r_i, std::size_t to_j, std::size_t r_j) {
  if (t.stabilization[r_i][(Dim + 1) * to_j + Dim] != 0) return true;
  const std::size_t to_i = stencil_size<Dim> - 1 - to_j;
  for (std::size_t d = 0; d < Dim; ++d) {
    if (t.divergence[r_i][Dim * to_j + d] != 0 || t.divergence[r_j][Dim * to_i + d] != 0) return true;
  }
  return false;
}

/// Calls emit(row, value) for the entries of the column of a displacement component, rows rising.
template <int Dim, class Emit>
void displacement_column(const Operators<Dim>& t, std::size_t r_j, std::size_t d, const Emit& emit) {
  const std::size_t column = unknowns_per_row(Dim) * r_j + d;
  if (t.is_fixed(r_j, d)) return emit(column, 1.0);
  t.for_each_neighbour(r_j, [&](std::size_t to_i, std::size_t r_i) {
    const std::size_t to_j = stencil_size<Dim> - 1 - to_i;
    if (!coupled<Dim>(t, r_i, to_j, r_j)) return;
    const std::size_t first = unknowns_per_row(Dim) * r_i;
    for (std::size_t e = 0; e < Dim; ++e) {
      const bool diagonal = r_i == r_j && e == d;
      if (t.is_fixed(r_i, e) || (t.viscosity.empty() && !diagonal)) continue;
      const double inertia = diagonal ? t.m_i[t.node[r_i]] * t.c_a : 0;
      const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r_i][Dim * (Dim * to_j + e) + d];
      emit(first + e, inertia + friction);
    }
    emit(first + Dim, t.c_v * t.divergence[r_i][Dim * to_j + d] + t.c_a * t.stabilization[r_i][(Dim + 1) * to_j + d]);
  });
}

/// The same for the column of a pressure.
template <int Dim, class Emit>
void pressure_column(const Operators<Dim>& t, std::size_t r_j, const Emit& emit) {
  t.for_each_neighbour(r_j, [&](std::size_t to_i, std::size_t r_i) {
    const std::size_t to_j = stencil_size<Dim> - 1 - to_i;
    if (!coupled<Dim>(t, r_i, to_j, r_j)) return;
    const std::size_t first = unknowns_per_row(Dim) * r_i;
    for (std::size_t e = 0; e < Dim; ++e) {
      if (!t.is_fixed(r_i, e)) emit(first + e, -t.divergence[r_j][Dim * to_i + e]);
    }
    emit(first + Dim,
         t.stabilization[r_i][(Dim + 1) * to_j + Dim] + (r_i == r_j ? t.pressure_per_mass * t.m_i[t.node[r_i]] : 0));
  });
}

template <int Dim, class Emit>
void column(const Operators<Dim>& t, std::size_t column, const Emit& emit) {
  const std::size_t r = column / unknowns_per_row(Dim);
  const std::size_t d = column % unknowns_per_row(Dim);
  if (d < Dim) {
    displacement_column<Dim>(t, r, d, emit);
  } else {
    pressure_column<Dim>(t, r, emit);
  }
}

}  // namespace

template <int Dim>
void fill_monolithic(const Operators<Dim>& t, matrix::Monolithic& matrix) {
  std::vector<int>& outer = matrix.outer;
  std::vector<int>& inner = matrix.inner;
  std::vector<double>& values = matrix.values;
  outer.assign(1, 0);
  inner.clear();
  values.clear();
  for (std::size_t c = 0; c < unknowns_per_row(Dim) * t.node.size(); ++c) {
    column<Dim>(t, c, [&](std::size_t row, double value) {
      // Neighbours come with rising rows but across the ends of periodic axes.
      const auto at = std::upper_bound(inner.begin() + outer.back(), inner.end(), static_cast<int>(row));
      values.insert(values.begin() + (at - inner.begin()), value);
      inner.insert(at, static_cast<int>(row));
    });
    outer.push_back(static_cast<int>(inner.size()));
  }
}

template <int Dim>
void AssembleMonolithic<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                                         Read<node::Row> row, Read<node::Constraint> fixed, Read<node::Mass> m_i,
                                         Read<matrix::Node> node, Read<matrix::Neighbour<Dim>> neighbour,
                                         Read<matrix::Divergence<Dim>> divergence,
                                         Read<matrix::Stabilization<Dim>> stabilization,
                                         Optional<Read<matrix::Viscosity<Dim>>> viscosity,
                                         Write<matrix::Monolithic> matrix) const {
  const double e = pressure_per_mass(clock->step, fluid->density, grid->spacing);
  fill_monolithic<Dim>({{rates->velocity, rates->acceleration, e},
                        row.span(),
                        fixed.span(),
                        m_i.span(),
                        node.span(),
                        neighbour.span(),
                        divergence.span(),
                        stabilization.span(),
                        viscosity.span()},
                       *matrix);
}

template void fill_monolithic(const Operators<2>&, matrix::Monolithic&);
template void fill_monolithic(const Operators<3>&, matrix::Monolithic&);
template struct AssembleMonolithic<2>;
template struct AssembleMonolithic<3>;

}  // namespace minamo
