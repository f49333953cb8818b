#include "systems/solve/monolithic.hpp"

#include "engine/parallel.hpp"
#include "systems/solve/stencil.hpp"

namespace minamo {

namespace {

/// What (E25)-(E27) are made of.
template <int Dim>
struct Terms {
  double c_v;
  double c_a;
  double pressure_per_mass;  ///< e_I/m_I of (E27)
  std::span<const std::int32_t> row;
  std::span<const std::uint8_t> fixed;
  std::span<const double> m_i;
  std::span<const Vec<Dim>> b_i;
  std::span<const Vec<Dim>> v_known;
  std::span<const Vec<Dim>> a_known;
  std::span<const Vec<Dim>> u_i;
  std::span<const std::uint32_t> node;
  std::span<const typename matrix::Divergence<Dim>::value_type> divergence;
  std::span<const typename matrix::Stabilization<Dim>::value_type> stabilization;
  std::span<const double> source;
  std::span<const typename matrix::Viscosity<Dim>::value_type> viscosity;  ///< empty if inviscid

  /// Whether node I of row r_i and node J at place `to_j` of its stencil share a particle: only then has an entry a
  /// value. The pressure term alone does not tell: one particle in the middle of every cell makes it cancel for
  /// neighbours along an axis.
  bool coupled(std::size_t r_i, std::size_t to_j, std::size_t r_j) const {
    if (stabilization[r_i][(Dim + 1) * to_j + Dim] != 0) return true;
    const std::size_t to_i = stencil_size<Dim> - 1 - to_j;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (divergence[r_i][Dim * to_j + d] != 0 || divergence[r_j][Dim * to_i + d] != 0) return true;
    }
    return false;
  }
  bool is_fixed(std::uint32_t i, std::size_t d) const { return fixed[i] >> d & 1; }
  /// D_IJ . q with J at place k of the stencil of row r.
  double dot_divergence(std::size_t r, std::size_t k, const Vec<Dim>& q) const {
    double sum = 0;
    for (std::size_t d = 0; d < Dim; ++d) sum += divergence[r][Dim * k + d] * q[static_cast<Eigen::Index>(d)];
    return sum;
  }
};

constexpr std::size_t unknowns_per_row(int dim) { return static_cast<std::size_t>(dim) + 1; }

/// Calls emit(row, value) for the entries of the column of a displacement component, rows rising.
template <int Dim, class Emit>
void displacement_column(const Terms<Dim>& t, const Stencil<Dim>& stencil, std::size_t r_j, std::size_t d,
                         const Emit& emit) {
  const std::uint32_t j = t.node[r_j];
  const std::size_t column = unknowns_per_row(Dim) * r_j + d;
  if (t.is_fixed(j, d)) return emit(column, 1.0);
  stencil.for_each_neighbour(j, [&](std::size_t to_i, std::uint32_t i) {
    const std::int32_t row = t.row[i];
    if (row < 0) return;
    const auto r_i = static_cast<std::size_t>(row);
    const std::size_t to_j = stencil_size<Dim> - 1 - to_i;
    if (!t.coupled(r_i, to_j, r_j)) return;
    const std::size_t first = unknowns_per_row(Dim) * r_i;
    for (std::size_t e = 0; e < Dim; ++e) {
      const bool diagonal = i == j && e == d;
      if (t.is_fixed(i, e) || (t.viscosity.empty() && !diagonal)) continue;
      const double inertia = diagonal ? t.m_i[i] * t.c_a : 0;
      const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r_i][Dim * (Dim * to_j + e) + d];
      emit(first + e, inertia + friction);
    }
    emit(first + Dim, t.c_v * t.divergence[r_i][Dim * to_j + d] + t.c_a * t.stabilization[r_i][(Dim + 1) * to_j + d]);
  });
}

/// The same for the column of a pressure.
template <int Dim, class Emit>
void pressure_column(const Terms<Dim>& t, const Stencil<Dim>& stencil, std::size_t r_j, const Emit& emit) {
  const std::uint32_t j = t.node[r_j];
  stencil.for_each_neighbour(j, [&](std::size_t to_i, std::uint32_t i) {
    const std::int32_t row = t.row[i];
    if (row < 0) return;
    const auto r_i = static_cast<std::size_t>(row);
    const std::size_t to_j = stencil_size<Dim> - 1 - to_i;
    if (!t.coupled(r_i, to_j, r_j)) return;
    const std::size_t first = unknowns_per_row(Dim) * r_i;
    for (std::size_t e = 0; e < Dim; ++e) {
      if (!t.is_fixed(i, e)) emit(first + e, -t.divergence[r_j][Dim * to_i + e]);
    }
    emit(first + Dim, t.stabilization[r_i][(Dim + 1) * to_j + Dim] + (i == j ? t.pressure_per_mass * t.m_i[i] : 0));
  });
}

template <int Dim, class Emit>
void column(const Terms<Dim>& t, const Stencil<Dim>& stencil, std::size_t column, const Emit& emit) {
  const std::size_t r = column / unknowns_per_row(Dim);
  const std::size_t d = column % unknowns_per_row(Dim);
  if (d < Dim) {
    displacement_column<Dim>(t, stencil, r, d, emit);
  } else {
    pressure_column<Dim>(t, stencil, r, emit);
  }
}

/// Fills pattern and values; tells a new pattern by its revision.
template <int Dim>
void fill_matrix(const Terms<Dim>& t, const Stencil<Dim>& stencil, matrix::Pattern& pattern,
                 std::vector<double>& values) {
  const std::size_t columns = unknowns_per_row(Dim) * t.node.size();
  pattern.next_outer.assign(columns + 1, 0);
  constexpr std::size_t columns_per_task = 256;
  for_each_row(
      columns,
      [&](std::size_t c) { column<Dim>(t, stencil, c, [&](std::size_t, double) { ++pattern.next_outer[c + 1]; }); },
      columns_per_task);
  for (std::size_t c = 0; c < columns; ++c) pattern.next_outer[c + 1] += pattern.next_outer[c];
  const auto entries = static_cast<std::size_t>(pattern.next_outer.back());
  pattern.next_inner.resize(entries);
  values.resize(entries);
  for_each_row(
      columns,
      [&](std::size_t c) {
        const auto first = static_cast<std::size_t>(pattern.next_outer[c]);
        auto at = first;
        column<Dim>(t, stencil, c, [&](std::size_t row, double value) {
          // Neighbours come with rising rows but across the ends of periodic axes.
          auto place = at++;
          for (; place > first && pattern.next_inner[place - 1] > static_cast<int>(row); --place) {
            pattern.next_inner[place] = pattern.next_inner[place - 1];
            values[place] = values[place - 1];
          }
          pattern.next_inner[place] = static_cast<int>(row);
          values[place] = value;
        });
      },
      columns_per_task);
  if (pattern.next_outer == pattern.outer && pattern.next_inner == pattern.inner) return;
  pattern.outer.swap(pattern.next_outer);
  pattern.inner.swap(pattern.next_inner);
  ++pattern.revision;
}

/// Right-hand sides of (E25) and (E26) for one row.
template <int Dim>
void fill_right_hand_side(const Terms<Dim>& t, const Stencil<Dim>& stencil, std::size_t r, double* out) {
  const std::uint32_t i = t.node[r];
  Vec<Dim> momentum = t.m_i[i] * (t.b_i[i] - t.a_known[i]);
  double mass = t.source[r];
  stencil.for_each_neighbour(i, [&](std::size_t to_j, std::uint32_t j) {
    const Vec<Dim> v = t.v_known[j] + t.c_v * t.u_i[j];
    mass -= t.dot_divergence(r, to_j, v);
    if (!t.viscosity.empty()) {
      for (std::size_t e = 0; e < Dim; ++e) {
        for (std::size_t d = 0; d < Dim; ++d) {
          momentum[static_cast<Eigen::Index>(e)] -=
              t.viscosity[r][Dim * (Dim * to_j + e) + d] * v[static_cast<Eigen::Index>(d)];
        }
      }
    }
  });
  for (std::size_t d = 0; d < Dim; ++d) out[d] = t.is_fixed(i, d) ? 0 : momentum[static_cast<Eigen::Index>(d)];
  out[Dim] = mass;
}

template <int Dim>
void assemble(const Terms<Dim>& t, const Grid<Dim>& grid, matrix::Pattern& pattern, std::vector<double>& values,
              std::vector<double>& right_hand_side) {
  const Stencil<Dim> stencil(grid);
  fill_matrix<Dim>(t, stencil, pattern, values);
  right_hand_side.resize(unknowns_per_row(Dim) * t.node.size());
  constexpr std::size_t rows_per_task = 256;
  for_each_row(
      t.node.size(),
      [&](std::size_t r) {
        fill_right_hand_side<Dim>(t, stencil, r, right_hand_side.data() + unknowns_per_row(Dim) * r);
      },
      rows_per_task);
}

/// (E27): the rate of volume change that this allows in a column of water of 1 kPa is 5e-6 1/s.
double pressure_per_mass(double dt, double density, double spacing) {
  constexpr double eps = 1e-6;
  return eps * dt / (density * density * spacing * spacing);
}

}  // namespace

template <int Dim>
void AssembleMonolithic<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates,
                                         Read<node::Row> row, Read<node::Fixed> fixed, Read<node::Mass> m_i,
                                         Read<node::BodyForce<Dim>> b_i, Read<node::KnownVelocity<Dim>> v_known,
                                         Read<node::KnownAcceleration<Dim>> a_known, Read<node::Displacement<Dim>> u_i,
                                         Read<matrix::Node> node, Read<matrix::Divergence<Dim>> divergence,
                                         Read<matrix::Stabilization<Dim>> stabilization,
                                         Read<matrix::StabilizationSource> source, Update<matrix::Pattern> pattern,
                                         Write<matrix::Values> values,
                                         Write<matrix::RightHandSide> right_hand_side) const {
  const Terms<Dim> terms{
      rates->velocity,      rates->acceleration, pressure_per_mass(clock->step, fluid->density, grid->spacing),
      row.span(),           fixed.span(),        m_i.span(),
      b_i.span(),           v_known.span(),      a_known.span(),
      u_i.span(),           node.span(),         divergence.span(),
      stabilization.span(), source.span(),       {}};
  assemble<Dim>(terms, *grid, *pattern, values->values, right_hand_side->values);
}

template <int Dim>
void AssembleMonolithicViscous<Dim>::operator()(
    Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid, Read<Rates> rates, Read<node::Row> row,
    Read<node::Fixed> fixed, Read<node::Mass> m_i, Read<node::BodyForce<Dim>> b_i,
    Read<node::KnownVelocity<Dim>> v_known, Read<node::KnownAcceleration<Dim>> a_known,
    Read<node::Displacement<Dim>> u_i, Read<matrix::Node> node, Read<matrix::Divergence<Dim>> divergence,
    Read<matrix::Stabilization<Dim>> stabilization, Read<matrix::StabilizationSource> source,
    Read<matrix::Viscosity<Dim>> viscosity, Update<matrix::Pattern> pattern, Write<matrix::Values> values,
    Write<matrix::RightHandSide> right_hand_side) const {
  const Terms<Dim> terms{
      rates->velocity,      rates->acceleration, pressure_per_mass(clock->step, fluid->density, grid->spacing),
      row.span(),           fixed.span(),        m_i.span(),
      b_i.span(),           v_known.span(),      a_known.span(),
      u_i.span(),           node.span(),         divergence.span(),
      stabilization.span(), source.span(),       viscosity.span()};
  assemble<Dim>(terms, *grid, *pattern, values->values, right_hand_side->values);
}

template struct AssembleMonolithic<2>;
template struct AssembleMonolithic<3>;
template struct AssembleMonolithicViscous<2>;
template struct AssembleMonolithicViscous<3>;

}  // namespace minamo
