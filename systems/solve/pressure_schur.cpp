#include "systems/solve/pressure_schur.hpp"

#include "systems/grid/node_volume.hpp"
#include "systems/solve/stencil.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

constexpr std::size_t rows_per_task = 128;

template <int Dim>
using StencilArray = Eigen::Array<double, static_cast<int>(stencil_size<Dim>), 1>;

constexpr Eigen::Index at(std::size_t k) { return static_cast<Eigen::Index>(k); }

/// A sum that is vectorized: Eigen adds in the order of its packets, the same on every call.
template <int Dim>
double weighted_sum(const StencilRow<Dim>& weight, const StencilArray<Dim>& value) {
  return (Eigen::Map<const StencilArray<Dim>>(weight.data()) * value).sum();
}

/// Fills neighbours, push, spread, T + e without scales, and the mobility of a row.
template <int Dim>
void fill_row(const EquationTerms<Dim>& t, const Stencil<Dim>& stencil, std::size_t r, PressureSchur<Dim>& s) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const std::uint32_t i = t.node[r];
  s.neighbour[r].fill(static_cast<std::uint32_t>(r));
  s.push[r] = {};
  s.spread[r] = {};
  s.pressure[r].fill(0);
  stencil.for_each_neighbour(i, [&](std::size_t k, std::uint32_t j) {
    if (t.row[j] < 0) return;
    const auto r_j = static_cast<std::size_t>(t.row[j]);
    s.neighbour[r][k] = static_cast<std::uint32_t>(r_j);
    for (std::size_t d = 0; d < Dim; ++d) {
      s.push[r][d][k] = t.divergence[r_j][Dim * (stencil_size<Dim> - 1 - k) + d];
      s.spread[r][d][k] = t.c_v * t.divergence[r][Dim * k + d] + t.c_a * t.stabilization[r][(Dim + 1) * k + d];
    }
    s.pressure[r][k] = t.stabilization[r][(Dim + 1) * k + Dim];
  });
  s.pressure[r][own] += t.pressure_per_mass * t.m_i[i];
  for (std::size_t d = 0; d < Dim; ++d) {
    const double friction = t.viscosity.empty() ? 0 : t.c_v * t.viscosity[r][Dim * (Dim * own + d) + d];
    s.mobility[Dim * r + d] = t.fixed[i] >> d & 1 ? 0 : 1 / (t.c_a * t.m_i[i] + friction);
  }
}

/// sum[place of J from I] += weight times row[place of J from K] for the J that both see, K at `to_k` from I.
template <int Dim, int Axis = Dim - 1>
void add_shifted(const Index<Dim>& to_k, double weight, const double* row, double* sum) {
  constexpr std::ptrdiff_t stride = power(5, Axis);
  const int shift = to_k[static_cast<std::size_t>(Axis)];
  for (int j = std::max(0, shift); j < std::min(5, 5 + shift); ++j) {
    if constexpr (Axis == 0) {
      sum[j] += weight * row[j - shift];
    } else {
      add_shifted<Dim, Axis - 1>(to_k, weight, row + (j - shift) * stride, sum + j * stride);
    }
  }
}

/// Calls add(way to K, c_v N_IK (c_a m_K)^-1, D^T of K) for the neighbours K of a row, per direction.
template <int Dim, class Add>
void for_each_surface_term(const EquationTerms<Dim>& t, std::size_t r, const PressureSchur<Dim>& s, const Add& add) {
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const std::size_t r_k = s.neighbour[r][k];
    if (r_k == r && k != stencil_size<Dim> / 2) continue;  // a light node, or none
    const std::uint32_t node = t.node[r_k];
    const double per_mass = t.c_v / (t.c_a * t.m_i[node]);
    Index<Dim> to_k;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= 5) to_k[d] = static_cast<int>(rest % 5) - 2;
    for (std::size_t d = 0; d < Dim; ++d) {
      const double both = t.divergence[r][Dim * k + d] + s.push[r][d][k];
      if (both != 0 && (t.fixed[node] >> d & 1) == 0) add(to_k, per_mass * both, s.push[r_k][d].data());
    }
  }
}

/// Row of (E56) within the stencil, without scales.
template <int Dim>
void fill_compact(const EquationTerms<Dim>& t, double of_laplacian, std::size_t r, PressureSchur<Dim>& s) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  StencilRow<Dim>& sum = s.compact[r];
  const double e_i = t.pressure_per_mass * t.m_i[t.node[r]];
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = of_laplacian * s.pressure[r][k];
  sum[own] += (1 - of_laplacian) * e_i;
  for_each_surface_term<Dim>(t, r, s, [&](const Index<Dim>& to_k, double weight, const double* row) {
    add_shifted<Dim>(to_k, weight, row, sum.data());
  });
}

/// sum[place in the stencil of 9^d] += weight row[place in that of K].
template <int Dim, int Axis = Dim - 1>
void add_wide(const Index<Dim>& to_k, double weight, const double* row, double* sum) {
  constexpr std::ptrdiff_t from = power(5, Axis);
  constexpr std::ptrdiff_t to = power(9, Axis);
  for (int j = 0; j < 5; ++j) {
    const std::ptrdiff_t at = j + to_k[static_cast<std::size_t>(Axis)] + 2;
    if constexpr (Axis == 0) {
      sum[at] += weight * row[j];
    } else {
      add_wide<Dim, Axis - 1>(to_k, weight, row + j * from, sum + at * to);
    }
  }
}

/// The row of the node at an offset from another, -1 if there is none.
template <int Dim>
std::int32_t row_at(const EquationTerms<Dim>& t, const Grid<Dim>& grid, const Index<Dim>& node,
                    const Index<Dim>& offset) {
  Index<Dim> there;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    there[axis] = grid.wrapped(d, node[axis] + offset[axis]);
    if (there[axis] < 0 || there[axis] >= grid.nodes(d)) return -1;
  }
  const auto i = t.rows_of_sites->find(there);
  return i ? t.row[*i] : -1;
}

/// Entries of (E56) beyond the stencil, without scales. \pre the node is thin.
template <int Dim>
void fill_beyond(const EquationTerms<Dim>& t, const Grid<Dim>& grid, const std::vector<char>& thin, std::size_t r,
                 PressureSchur<Dim>& s) {
  std::array<double, power(9, Dim)> sum{};
  for_each_surface_term<Dim>(t, r, s, [&](const Index<Dim>& to_k, double weight, const double* row) {
    add_wide<Dim>(to_k, weight, row, sum.data());
  });
  const Index<Dim> node = t.site[t.node[r]];
  for (std::size_t k = 0; k < sum.size(); ++k) {
    if (sum[k] == 0) continue;
    Index<Dim> offset;
    std::size_t rest = k;
    bool near = true;
    for (std::size_t d = 0; d < Dim; ++d, rest /= 9) {
      offset[d] = static_cast<int>(rest % 9) - 4;
      near = near && std::abs(offset[d]) <= 2;
    }
    if (near) continue;
    const std::int32_t r_j = row_at<Dim>(t, grid, node, offset);
    if (r_j < 0 || !thin[static_cast<std::size_t>(r_j)]) continue;
    s.beyond[r].push_back({static_cast<std::uint32_t>(r_j), sum[k]});
  }
}

template <int Dim>
void apply_scales(std::size_t r, PressureSchur<Dim>& s) {
  for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
    const double of_column = s.scale[s.neighbour[r][k]];
    for (std::size_t d = 0; d < Dim; ++d) {
      s.push[r][d][k] *= of_column;
      s.spread[r][d][k] *= s.scale[r];
    }
    s.pressure[r][k] *= s.scale[r] * of_column;
    s.compact[r][k] *= s.scale[r] * of_column;
  }
  for (auto& entry : s.beyond[r]) entry.value *= s.scale[r] * s.scale[entry.row];
}

}  // namespace

template <int Dim>
void PressureSchur<Dim>::assemble(const EquationTerms<Dim>& t, const Grid<Dim>& grid, const Fluid& fluid,
                                  double of_laplacian) {
  constexpr std::size_t own = stencil_size<Dim> / 2;
  const Stencil<Dim> stencil(grid, *t.rows_of_sites, t.site);
  const std::size_t n = t.node.size();
  neighbour.resize(n);
  push.resize(n);
  spread.resize(n);
  pressure.resize(n);
  compact.resize(n);
  beyond.resize(n);
  std::vector<char> thin(n);
  scale.resize(n);
  mobility.resize(Dim * n);
  for_each_row(
      n,
      [&](std::size_t r) {
        fill_row<Dim>(t, stencil, r, *this);
        thin[r] = t.m_i[t.node[r]] < 0.5 * fluid.density * full_volume<Dim>(grid, t.site[t.node[r]]);
      },
      rows_per_task);
  for_each_row(
      n,
      [&](std::size_t r) {
        fill_compact<Dim>(t, of_laplacian, r, *this);
        beyond[r].clear();
        if (thin[r]) fill_beyond<Dim>(t, grid, thin, r, *this);
        scale[r] = 1 / std::sqrt(std::max(pressure[r][own], compact[r][own]));
      },
      rows_per_task);
  for_each_row(
      n, [&](std::size_t r) { apply_scales<Dim>(r, *this); }, rows_per_task);
}

template <int Dim>
void PressureSchur<Dim>::push_all(const Values& p, Values& out) const {
  for_each_row(
      rows(),
      [&](std::size_t r) {
        StencilArray<Dim> of_neighbour;
        for (std::size_t k = 0; k < stencil_size<Dim>; ++k) of_neighbour[at(k)] = p[neighbour[r][k]];
        for (std::size_t d = 0; d < Dim; ++d) out[Dim * r + d] = weighted_sum<Dim>(push[r][d], of_neighbour);
      },
      rows_per_task);
}

template <int Dim>
void PressureSchur<Dim>::spread_all(const Values& w, const Values& p, Values& out) const {
  for_each_row(
      rows(),
      [&](std::size_t r) {
        StencilArray<Dim> p_of_neighbour;
        std::array<StencilArray<Dim>, Dim> w_of_neighbour;
        for (std::size_t k = 0; k < stencil_size<Dim>; ++k) {
          const std::size_t r_j = neighbour[r][k];
          p_of_neighbour[at(k)] = p[r_j];
          for (std::size_t d = 0; d < Dim; ++d) w_of_neighbour[d][at(k)] = w[Dim * r_j + d];
        }
        double sum = weighted_sum<Dim>(pressure[r], p_of_neighbour);
        for (std::size_t d = 0; d < Dim; ++d) sum += weighted_sum<Dim>(spread[r][d], w_of_neighbour[d]);
        out[r] = sum;
      },
      rows_per_task);
}

template struct PressureSchur<2>;
template struct PressureSchur<3>;

}  // namespace minamo
