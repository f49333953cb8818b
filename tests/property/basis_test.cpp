#include "support/extremes.hpp"
#include "support/factorizations.hpp"
#include "support/kernels.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// S_I and gradients as the kernels see them, spread over all nodes.
template <int Dim>
PlainWeights<Dim> kernel_weights(const Grid<Dim>& grid, const Vec<Dim>& x) {
  PlainWeights<Dim> all(grid, x);
  all.value.assign(grid.node_count(), 0);
  all.gradient.assign(grid.node_count(), Vec<Dim>::Zero());
  const SupportBox<Dim> support(grid, dual_cell<Dim>(grid, x));
  const Weights<Dim> weights(support, x);
  for_each_support<Dim>([&](std::size_t, const Index<Dim>& offset) {
    const std::size_t i = grid.row(support.site(grid, offset));
    all.value[i] += weights(offset);
    all.gradient[i] += weights.gradient(offset);
  });
  return all;
}

template <int Dim>
Vec<Dim> some_place(const Grid<Dim>& grid) {
  const auto number = static_cast<std::size_t>(GENERATE(range(0, 200)));
  Random random(100 + number);
  return random_place<Dim>(random, grid, number);
}

double plain_spline(double r) {
  r = std::abs(r);
  if (r <= 0.5) return 0.75 - r * r;
  return r <= 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0;
}

/// 1 and the products of the components of `x`: what a multilinear correction reproduces.
template <int Dim>
Eigen::VectorXd multilinear(const Vec<Dim>& x) {
  Eigen::VectorXd terms(1 << Dim);
  for (int k = 0; k < 1 << Dim; ++k) {
    terms[k] = 1;
    for (int d = 0; d < Dim; ++d) terms[k] *= (k >> d & 1) ? x[d] : 1;
  }
  return terms;
}

/// The correction of Nakamura et al. (2023) as they write it: the splines of the nodes inside the box, times
/// P(x_I - x) M^-1 P(0), M = sum_I N_I P P^T, with a moment matrix M per point.
template <int Dim>
std::vector<double> moment_matrix_weights(const Grid<Dim>& grid, const Vec<Dim>& x) {
  std::vector<double> spline;
  std::vector<Eigen::VectorXd> terms;
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(1 << Dim, 1 << Dim);
  for (std::size_t i = 0; i < grid.node_count(); ++i) {
    const Vec<Dim> r = (node_position<Dim>(grid, i) - x) / grid.spacing;
    double n = 1;
    for (int d = 0; d < Dim; ++d) n *= plain_spline(r[d]);
    spline.push_back(n);
    terms.push_back(multilinear<Dim>(r));
    moments += n * terms.back() * terms.back().transpose();
  }
  const Eigen::VectorXd correction = dense::solve(moments, multilinear<Dim>(Vec<Dim>::Zero()));
  for (std::size_t i = 0; i < spline.size(); ++i) spline[i] *= terms[i].dot(correction);
  return spline;
}

// Sums of up to 27 products of 3 weights, of size 1: 6e-16 measured.
constexpr double rounding = 5e-15;

}  // namespace

TEMPLATE_TEST_CASE_SIG("weights sum to one everywhere in the box", "[property]", ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const Vec<Dim> x = some_place<Dim>(grid);
  const auto weights = kernel_weights<Dim>(grid, x);
  double sum = 0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
  for (std::size_t i = 0; i < weights.value.size(); ++i) {
    sum += weights.value[i];
    gradient += weights.gradient[i];
  }
  CHECK(std::abs(sum - 1) < rounding);
  CHECK(gradient.norm() < rounding);
}

TEMPLATE_TEST_CASE_SIG("weights reproduce the place everywhere in the box", "[property]", ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const Vec<Dim> x = some_place<Dim>(grid);
  const auto weights = kernel_weights<Dim>(grid, x);
  Vec<Dim> place = Vec<Dim>::Zero();
  Mat<Dim> gradient = Mat<Dim>::Zero();
  for (std::size_t i = 0; i < weights.value.size(); ++i) {
    const Vec<Dim> from_x = node_position<Dim>(grid, i) - x;
    place += weights.value[i] * from_x;
    gradient += from_x * weights.gradient[i].transpose();
  }
  CHECK(place.norm() < 0.1 * rounding);  // a sum of distances that cancel
  CHECK((gradient - Mat<Dim>::Identity()).norm() < rounding);
}

TEMPLATE_TEST_CASE_SIG("weights are not negative", "[property]", ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const auto weights = kernel_weights<Dim>(grid, some_place<Dim>(grid));
  Smallest least;
  for (const double weight : weights.value) least.add(weight);
  CHECK(least.value() >= -1e-16);  // rounding of 1/8 - xi/2 + xi^2/2
}

TEMPLATE_TEST_CASE_SIG("the corrected kernel is the moment-matrix correction of the cut B-spline", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const Vec<Dim> x = some_place<Dim>(grid);
  CAPTURE(x.transpose());
  const auto weights = kernel_weights<Dim>(grid, x);
  const std::vector<double> expected = moment_matrix_weights<Dim>(grid, x);
  Largest worst;
  for (std::size_t i = 0; i < expected.size(); ++i) worst.add(std::abs(weights.value[i] - expected[i]));
  // 2e-16 measured, though the moment matrix has a condition number of up to 1e3 (its smallest entries are products of
  // m2 >= 1/8).
  CHECK(worst.value() < 2e-15);
}

TEMPLATE_TEST_CASE_SIG("the gradient of a weight is its finite difference", "[property]", ((int Dim), Dim), 2, 3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const double step = 1e-5 * grid.spacing;
  const Vec<Dim> x = some_place<Dim>(grid)
                         .cwiseMax(grid.low + Vec<Dim>::Constant(step))
                         .cwiseMin(grid.high - Vec<Dim>::Constant(step));
  CAPTURE(x.transpose());
  const auto weights = kernel_weights<Dim>(grid, x);
  Largest worst;
  for (int d = 0; d < Dim; ++d) {
    const Vec<Dim> aside = step * Vec<Dim>::Unit(d);
    const auto ahead = kernel_weights<Dim>(grid, x + aside);
    const auto behind = kernel_weights<Dim>(grid, x - aside);
    for (std::size_t i = 0; i < weights.value.size(); ++i) {
      const double difference = (ahead.value[i] - behind.value[i]) / (2 * step);
      worst.add(std::abs(difference - weights.gradient[i][d]));
    }
  }
  // Roundings of 1e-16/step = 2e-11: 8e-11 measured. No second derivative jumps within a step of one of the places.
  CHECK(worst.value() < 8e-10);
}

TEMPLATE_TEST_CASE_SIG("the kernels' weights are those of the formula node by node", "[property]", ((int Dim), Dim), 2,
                       3) {
  const Grid<Dim> grid = small_grid<Dim>();
  const Vec<Dim> x = some_place<Dim>(grid);
  CAPTURE(x.transpose());
  const auto weights = kernel_weights<Dim>(grid, x);
  const PlainWeights<Dim> plain(grid, x);
  Largest worst;
  for (std::size_t i = 0; i < plain.value.size(); ++i) {
    worst.add(std::abs(weights.value[i] - plain.value[i]));
    worst.add((weights.gradient[i] - plain.gradient[i]).norm() * grid.spacing);
  }
  CHECK(worst.value() < rounding);
}
