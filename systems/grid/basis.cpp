#include "systems/grid/basis.hpp"

#include <algorithm>

namespace minamo {

namespace {

using WeightPowers = std::array<std::array<double, weight_powers>, 3>;

template <std::size_t N, std::size_t M>
constexpr std::array<double, product_powers> product(const std::array<double, N>& x, const std::array<double, M>& y) {
  std::array<double, product_powers> xy{};
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < M; ++j) xy[i + j] += x[i] * y[j];
  }
  return xy;
}

/// Puts the product of polynomials where pair `place` has its coefficients.
template <std::size_t N, std::size_t M>
constexpr void set_product(const std::array<double, N>& x, const std::array<double, M>& y, std::size_t place,
                           AxisBasis::PairProducts& pairs) {
  const auto xy = product(x, y);
  for (std::size_t k = 0; k < xy.size(); ++k) pairs[k][place] = xy[k];
}

/// Integrals from low to high of w xi^k, k = 0 ... 4.
constexpr std::array<double, product_powers> integrals(const std::array<double, weight_powers>& w, double low,
                                                       double high) {
  std::array<double, product_powers> sum{};
  for (std::size_t k = 0; k < sum.size(); ++k) {
    for (std::size_t i = 0; i < w.size(); ++i) {
      double at_high = 1;
      double at_low = 1;
      for (std::size_t n = 0; n <= k + i; ++n) {
        at_high *= high;
        at_low *= low;
      }
      sum[k] += w[i] * (at_high - at_low) / static_cast<double>(k + i + 1);
    }
  }
  return sum;
}

/// The dual cell goes from `low` to `high`.
constexpr AxisBasis make_basis(int first, double low, double high, const WeightPowers& weight) {
  AxisBasis basis{};
  basis.first = first;
  basis.weight = weight;
  for (std::size_t a = 0; a < 3; ++a) {
    basis.slope[a] = {weight[a][1], 2 * weight[a][2]};
    basis.of_weight[a] = product(weight[a], std::array{1.0});
    basis.of_slope[a] = product(basis.slope[a], std::array{1.0});
    basis.of_distance[a] = product(weight[a], std::array{static_cast<double>(first) + static_cast<double>(a), -1.0});
    basis.integral[a] = integrals(weight[a], low, high);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b < 3; ++b) {
      set_product(weight[a], weight[b], 3 * a + b, basis.weight_weight);
      set_product(basis.slope[a], weight[b], 3 * a + b, basis.slope_weight);
      set_product(weight[a], basis.slope[b], 3 * a + b, basis.weight_slope);
      set_product(basis.slope[a], basis.slope[b], 3 * a + b, basis.slope_slope);
    }
  }
  return basis;
}

}  // namespace

constinit const AxisBasis low_wall_basis = make_basis(0, 0, 0.5, {{{1, -1, 0}, {0, 1, 0}, {0, 0, 0}}});
constinit const AxisBasis high_wall_basis = make_basis(-2, -0.5, 0, {{{0, 0, 0}, {0, -1, 0}, {1, 1, 0}}});
constinit const AxisBasis inner_basis =
    make_basis(-1, -0.5, 0.5, {{{1. / 8, -1. / 2, 1. / 2}, {3. / 4, 0, -1}, {1. / 8, 1. / 2, 1. / 2}}});

}  // namespace minamo
