#include "systems/solve/moments.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// 1, xi, ..., xi^4.
std::array<double, product_powers> powers(double xi) {
  const double xi2 = xi * xi;
  return {1, xi, xi2, xi2 * xi, xi2 * xi2};
}

/// out[N g + q][r] = sum_k factor(q, k) in[g][k rest + r]: contracts the slowest direction of every group.
template <std::size_t Rest, std::size_t N, std::size_t In = product_powers, class Factor>
void contract(std::size_t groups, const Factor& factor, const double* in, double* out) {
  for (std::size_t g = 0; g < groups; ++g, in += In * Rest) {
    for (std::size_t q = 0; q < N; ++q, out += Rest) {
      for (std::size_t r = 0; r < Rest; ++r) {
        double sum = 0;
        for (std::size_t k = 0; k < In; ++k) sum += factor(q, k) * in[k * Rest + r];
        out[r] = sum;
      }
    }
  }
}

using Pairs = Eigen::Array<double, 4, 1, Eigen::DontAlign>;

/// sum_k factor[k][q ... q + 3] in[k step]
[[gnu::always_inline]] inline Pairs contract_pairs(const AxisBasis::PairProducts& factor, std::size_t q,
                                                   const double* in, std::size_t step) {
  const auto term = [&](std::size_t k) -> Pairs {
    return Eigen::Map<const Pairs>(factor[k].data() + q) * in[k * step];
  };
  return ((term(0) + term(1)) + (term(2) + term(3))) + term(4);
}

/// The pairs of two directions from the moments of a plane, y first: out[padded_pairs (pair of y) + pair of x].
/// Vectorized over pairs.
void contract_plane(const AxisBasis::PairProducts& factor_x, const AxisBasis::PairProducts& factor_y, const double* in,
                    double* out) {
  std::array<double, product_powers * padded_pairs> y_done;  // by power of x, then pair of y
  for (std::size_t x = 0; x < product_powers; ++x) {
    for (std::size_t q = 0; q < padded_pairs; q += 4) {
      double* to = y_done.data() + padded_pairs * x + q;
      Eigen::Map<Pairs>{to} = contract_pairs(factor_y, q, in + x, product_powers);
    }
  }
  for (std::size_t y = 0; y < 9; ++y, out += padded_pairs) {
    for (std::size_t q = 0; q < padded_pairs; q += 4) {
      Eigen::Map<Pairs>{out + q} = contract_pairs(factor_x, q, y_done.data() + y, padded_pairs);
    }
  }
}

}  // namespace

namespace {

/// Adds V xi^a eta^b zeta^c.
template <int Dim>
[[gnu::always_inline]] inline void add_point(const Vec<Dim>& xi, double volume, CellMoments<Dim>& sum) {
  const auto x = powers(xi[0]);
  const auto y = powers(xi[1]);
  std::array<double, 25> xy;
  for (std::size_t b = 0; b < 5; ++b) {
    for (std::size_t a = 0; a < 5; ++a) xy[5 * b + a] = volume * y[b] * x[a];
  }
  if constexpr (Dim == 3) {
    const auto z = powers(xi[2]);
    for (std::size_t c = 0; c < 5; ++c) {
      for (std::size_t ab = 0; ab < 25; ++ab) sum[25 * c + ab] += z[c] * xy[ab];
    }
  } else {
    for (std::size_t ab = 0; ab < 25; ++ab) sum[ab] += xy[ab];
  }
}

/// The part of (E68) that the particles of a cell bring.
template <int Dim>
CellMoments<Dim> sum_beside(const Support<Dim>& support, const std::array<double, support_size<Dim>>& theta,
                            const typename OccupiedCells<Dim>::Cell& cell, double per_density,
                            std::span<const Vec<Dim>> y_p, std::span<const double> m_p) {
  CellMoments<Dim> sum{};
  for (std::size_t p = cell.begin; p < cell.end; ++p) {
    const Weights<Dim> weights(support, y_p[p]);
    double share = 1;
    for_each_support<Dim>([&](std::size_t k, const Index<Dim>& offset) { share -= theta[k] * weights(offset); });
    add_point<Dim>((y_p[p] - support.centre) * support.per_spacing, share * m_p[p] * per_density, sum);
  }
  return sum;
}

}  // namespace

template <int Dim>
void GatherMoments<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                    Read<particle::Configuration<Dim>> y_p, Read<particle::Mass> m_p,
                                    Write<Moments<Dim>> moments) const {
  moments->of_cell.resize(cells->cells.size());
  moments->is_full.assign(cells->cells.size(), 0);
  const double per_density = 1 / fluid->density;
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Vec<Dim> centre = grid->position(cell.node);
    CellMoments<Dim> sum{};
    for (std::size_t p = cell.begin; p < cell.end; ++p) {
      add_point<Dim>((y_p[p] - centre) / grid->spacing, m_p[p] * per_density, sum);
    }
    moments->of_cell[c] = sum;
  });
}

template <int Dim>
void GatherMomentsMixed<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells, Read<Fluid> fluid,
                                         Read<particle::Configuration<Dim>> y_p, Read<particle::Mass> m_p,
                                         Read<node::Fullness> theta_i, Write<Moments<Dim>> moments) const {
  moments->of_cell.resize(cells->cells.size());
  moments->is_full.resize(cells->cells.size());
  const double cell_volume = std::pow(grid->spacing, Dim);
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    std::array<double, support_size<Dim>> theta;
    for (std::size_t k = 0; k < theta.size(); ++k) theta[k] = theta_i[support.node[k]];
    const auto [least, most] = std::minmax_element(theta.begin(), theta.end());
    moments->is_full[c] = *least == 1;
    CellMoments<Dim> sum{};
    if (*least < 1) sum = sum_beside<Dim>(support, theta, cell, 1 / fluid->density, y_p.span(), m_p.span());
    if (*most > 0) {
      const CellMoments<Dim> inside = integrate_theta<Dim>(support.basis, theta);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += cell_volume * inside[k];
    }
    moments->of_cell[c] = sum;
  });
}

template <int Dim>
CellMoments<Dim> integrate_theta(const CellBasis<Dim>& basis, const std::array<double, support_size<Dim>>& theta) {
  const auto factor_of = [&](std::size_t d) {
    return [&f = basis[d]->integral](std::size_t q, std::size_t k) { return f[k][q]; };
  };
  CellMoments<Dim> done;
  if constexpr (Dim == 2) {
    std::array<double, 5 * 3> y_done;
    contract<3, 5, 3>(1, factor_of(1), theta.data(), y_done.data());
    contract<1, 5, 3>(5, factor_of(0), y_done.data(), done.data());
  } else {
    std::array<double, 5 * 9> z_done;
    std::array<double, 25 * 3> y_done;
    contract<9, 5, 3>(1, factor_of(2), theta.data(), z_done.data());
    contract<3, 5, 3>(5, factor_of(1), z_done.data(), y_done.data());
    contract<1, 5, 3>(25, factor_of(0), y_done.data(), done.data());
  }
  return done;
}

template <int Dim>
void integrate(const CellMoments<Dim>& moments, const PairFactors<Dim>& factors, CellMatrix<Dim>& done) {
  if constexpr (Dim == 2) {
    contract_plane(*factors[0], *factors[1], moments.data(), done.data());
  } else {
    constexpr std::size_t plane = stencil_size<2>;
    std::array<double, 9 * plane> z_done;
    contract<plane, 9>(
        1, [&f = *factors[2]](std::size_t q, std::size_t k) { return f[k][q]; }, moments.data(), z_done.data());
    for (std::size_t z = 0; z < 9; ++z) {
      contract_plane(*factors[0], *factors[1], z_done.data() + plane * z, done.data() + 9 * padded_pairs * z);
    }
  }
}

template <int Dim>
CellVector<Dim> integrate(const CellMoments<Dim>& moments, const NodeFactors<Dim>& factors) {
  const auto factor_of = [&](std::size_t d) {
    return [&f = *factors[d]](std::size_t q, std::size_t k) { return f[q][k]; };
  };
  CellVector<Dim> done;
  if constexpr (Dim == 2) {
    std::array<double, 3 * 5> y_done;
    contract<5, 3>(1, factor_of(1), moments.data(), y_done.data());
    contract<1, 3>(3, factor_of(0), y_done.data(), done.data());
  } else {
    std::array<double, 3 * 25> z_done;
    std::array<double, 9 * 5> y_done;
    contract<25, 3>(1, factor_of(2), moments.data(), z_done.data());
    contract<5, 3>(3, factor_of(1), z_done.data(), y_done.data());
    contract<1, 3>(9, factor_of(0), y_done.data(), done.data());
  }
  return done;
}

template <int Dim>
const PairPlaces<Dim>& pair_places() {
  static const PairPlaces<Dim> places = [] {
    PairPlaces<Dim> made;
    for_each_support<Dim>([&](std::size_t i, const Index<Dim>& at_i) {
      for_each_support<Dim>([&](std::size_t j, const Index<Dim>& at_j) {
        int in_cell = 0;
        int in_stencil = 0;
        for (std::size_t d = Dim; d-- > 0;) {
          in_cell = (d == 0 ? static_cast<int>(padded_pairs) : 9) * in_cell + 3 * at_i[d] + at_j[d];
          in_stencil = 5 * in_stencil + at_j[d] - at_i[d] + 2;
        }
        made.in_cell[i][j] = static_cast<std::uint16_t>(in_cell);
        made.in_stencil[i][j] = static_cast<std::uint16_t>(in_stencil);
      });
    });
    return made;
  }();
  return places;
}

template struct GatherMoments<2>;
template struct GatherMoments<3>;
template struct GatherMomentsMixed<2>;
template struct GatherMomentsMixed<3>;
template CellMoments<2> integrate_theta<2>(const CellBasis<2>&, const std::array<double, 9>&);
template CellMoments<3> integrate_theta<3>(const CellBasis<3>&, const std::array<double, 27>&);
template void integrate<2>(const CellMoments<2>&, const PairFactors<2>&, CellMatrix<2>&);
template void integrate<3>(const CellMoments<3>&, const PairFactors<3>&, CellMatrix<3>&);
template CellVector<2> integrate<2>(const CellMoments<2>&, const NodeFactors<2>&);
template CellVector<3> integrate<3>(const CellMoments<3>&, const NodeFactors<3>&);
template const PairPlaces<2>& pair_places<2>();
template const PairPlaces<3>& pair_places<3>();

}  // namespace minamo
