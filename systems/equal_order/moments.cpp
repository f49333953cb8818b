#include "systems/equal_order/moments.hpp"

#include "systems/grid/contract.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

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

/// sum V xi^a eta^b zeta^c, four powers of xi in the lanes of a vector: left to the compiler it takes twice as long.
template <int Dim>
class MomentSum {
 public:
  [[gnu::always_inline]] void add(double volume, const Vec<Dim>& xi) {
    const double x2 = xi[0] * xi[0];
    const double y2 = xi[1] * xi[1];
    const Four x{1, xi[0], x2, x2 * xi[0]};
    const Four y{1, xi[1], y2, y2 * xi[1]};
    const Plane xy{{volume * x, (volume * xi[1]) * x, (volume * y2) * x, (volume * y[3]) * x, (volume * (y2 * y2)) * x},
                   (volume * (x2 * x2)) * y,
                   volume * (y2 * y2) * (x2 * x2)};
    add_plane(1, xy, planes_[0]);
    if constexpr (Dim == 3) {
      const double z2 = xi[2] * xi[2];
      add_plane(xi[2], xy, planes_[1]);
      add_plane(z2, xy, planes_[2]);
      add_plane(z2 * xi[2], xy, planes_[3]);
      add_plane(z2 * z2, xy, planes_[4]);
    }
  }
  CellMoments<Dim> sum() const {
    CellMoments<Dim> sum;
    double* to = sum.data();
    for (const Plane& plane : planes_) {
      for (std::size_t b = 0; b < product_powers; ++b, to += product_powers) {
        for (std::size_t a = 0; a < 4; ++a) to[a] = plane.low[b][a];
        to[4] = b < 4 ? plane.last[b] : plane.corner;
      }
    }
    return sum;
  }

 private:
  struct Plane {
    std::array<Four, product_powers> low;  ///< of 1 ... xi^3, by power of eta
    Four last;                             ///< of xi^4, by 1 ... eta^3
    double corner;                         ///< of xi^4 eta^4
  };
  [[gnu::always_inline]] static void add_plane(double factor, const Plane& of, Plane& sum) {
    for (std::size_t b = 0; b < product_powers; ++b) sum.low[b] += factor * of.low[b];
    sum.last += factor * of.last;
    sum.corner += factor * of.corner;
  }

  std::array<Plane, power(product_powers, Dim - 2)> planes_{};  ///< by power of zeta
};

/// theta = sum_J theta_J S_J within a dual cell, as a polynomial.
template <int Dim>
class IndicatorWithin {
 public:
  IndicatorWithin(const CellBasis<Dim>& basis, const std::array<double, support_size<Dim>>& theta)
      : coefficient_(contract_axes<Dim, 3, weight_powers>(theta, [&](std::size_t d) {
          return [&w = basis[d]->weight](std::size_t q, std::size_t k) { return w[k][q]; };
        })) {}

  double at(const Vec<Dim>& xi) const {
    const auto line = [&](std::size_t k) {
      return coefficient_[k] + xi[0] * (coefficient_[k + 1] + xi[0] * coefficient_[k + 2]);
    };
    const auto plane = [&](std::size_t k) { return line(k) + xi[1] * (line(k + 3) + xi[1] * line(k + 6)); };
    if constexpr (Dim == 2) {
      return plane(0);
    } else {
      return plane(0) + xi[2] * (plane(9) + xi[2] * plane(18));
    }
  }

 private:
  std::array<double, support_size<Dim>> coefficient_;
};

/// The sum over the particles of a cell of V_p share(xi) xi^a eta^b zeta^c.
template <int Dim, class Share>
CellMoments<Dim> sum_over_particles(const Support<Dim>& support, const typename OccupiedCells<Dim>::Cell& cell,
                                    std::span<const Vec<Dim>> y_p, std::span<const double> V_p, const Share& share) {
  MomentSum<Dim> moments;
  for (std::size_t p = cell.begin; p < cell.end; ++p) {
    const Vec<Dim> xi = (y_p[p] - support.centre) * support.per_spacing;
    moments.add(share(xi) * V_p[p], xi);
  }
  return moments.sum();
}

}  // namespace

template <int Dim>
void GatherMoments<Dim>::operator()(Read<Grid<Dim>> grid, Read<OccupiedCells<Dim>> cells,
                                    Read<particle::QuadraturePosition<Dim>> y_p, Read<particle::Volume> V_p,
                                    Optional<Read<node::FilledIndicator>> theta_i, Write<Moments<Dim>> moments) const {
  moments->of_cell.resize(cells->cells.size());
  moments->is_filled.resize(cells->cells.size());
  const double cell_volume = std::pow(grid->spacing, Dim);
  for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
    const Support<Dim> support(*grid, cell);
    std::array<double, support_size<Dim>> theta{};
    if (theta_i) {
      for (std::size_t k = 0; k < theta.size(); ++k) theta[k] = theta_i[support.node[k]];
    }
    const auto [least, most] = std::minmax_element(theta.begin(), theta.end());
    moments->is_filled[c] = *least == 1;
    CellMoments<Dim>& sum = moments->of_cell[c];
    if (*most == 0) {
      sum = sum_over_particles<Dim>(support, cell, y_p.span(), V_p.span(), [](const Vec<Dim>&) { return 1.0; });
      return;
    }
    sum.fill(0);
    if (*least < 1) {
      const IndicatorWithin<Dim> indicator(support.basis, theta);
      sum = sum_over_particles<Dim>(support, cell, y_p.span(), V_p.span(),
                                    [&](const Vec<Dim>& xi) { return 1 - indicator.at(xi); });
    }
    const CellMoments<Dim> inside = integrate_theta<Dim>(support.basis, theta);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += cell_volume * inside[k];
  });
}

template <int Dim>
CellMoments<Dim> integrate_theta(const CellBasis<Dim>& basis, const std::array<double, support_size<Dim>>& theta) {
  return contract_axes<Dim, 3, product_powers>(theta, [&](std::size_t d) {
    return [&f = basis[d]->integral](std::size_t q, std::size_t k) { return f[k][q]; };
  });
}

template <int Dim>
void cell_matrix(const CellMoments<Dim>& moments, const PairFactors<Dim>& factors, CellMatrix<Dim>& done) {
  if constexpr (Dim == 2) {
    contract_plane(*factors[0], *factors[1], moments.data(), done.data());
  } else {
    constexpr std::size_t plane = stencil_size<2>;
    std::array<double, 9 * plane> z_done;
    contract<plane, product_powers, 9>(
        1, [&f = *factors[2]](std::size_t q, std::size_t k) { return f[k][q]; }, moments.data(), z_done.data());
    for (std::size_t z = 0; z < 9; ++z) {
      contract_plane(*factors[0], *factors[1], z_done.data() + plane * z, done.data() + 9 * padded_pairs * z);
    }
  }
}

template <int Dim>
CellVector<Dim> cell_vector(const CellMoments<Dim>& moments, const NodeFactors<Dim>& factors) {
  return contract_axes<Dim, product_powers, 3>(
      moments, [&](std::size_t d) { return [&f = *factors[d]](std::size_t q, std::size_t k) { return f[q][k]; }; });
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
template CellMoments<2> integrate_theta<2>(const CellBasis<2>&, const std::array<double, 9>&);
template CellMoments<3> integrate_theta<3>(const CellBasis<3>&, const std::array<double, 27>&);
template void cell_matrix<2>(const CellMoments<2>&, const PairFactors<2>&, CellMatrix<2>&);
template void cell_matrix<3>(const CellMoments<3>&, const PairFactors<3>&, CellMatrix<3>&);
template CellVector<2> cell_vector<2>(const CellMoments<2>&, const NodeFactors<2>&);
template CellVector<3> cell_vector<3>(const CellMoments<3>&, const NodeFactors<3>&);
template const PairPlaces<2>& pair_places<2>();
template const PairPlaces<3>& pair_places<3>();

}  // namespace minamo
