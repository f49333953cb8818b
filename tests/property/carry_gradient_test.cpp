#include "support/factorizations.hpp"
#include "support/kernels.hpp"

#include "systems/transfer/carry_gradient.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// The gradient of the linear field that velocities at places come from, by least squares.
template <int Dim>
Mat<Dim> gradient_over(const std::vector<Vec<Dim>>& places, const std::vector<Vec<Dim>>& velocities) {
  const auto rows = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd x(rows, Dim + 1);
  Eigen::MatrixXd v(rows, Dim);
  for (Eigen::Index r = 0; r < rows; ++r) {
    x.row(r) << places[static_cast<std::size_t>(r)].transpose(), 1;
    v.row(r) = velocities[static_cast<std::size_t>(r)].transpose();
  }
  return dense::least_squares(x, v).topRows(Dim).transpose();
}

template <int Dim>
Mat<Dim> carried(World& world, double share, const Mat<Dim>& before) {
  fill<Dim>(world, 20, 1);
  world.resource<Clock>().step = 0.1;
  for (double& w_c : world.column<cell::LiquidIndicator>()) w_c = share;
  for (Mat<Dim>& grad_v : world.column<particle::VelocityGradient<Dim>>()) grad_v = before;
  run<CarryGradient<Dim>>(world);
  return world.column<particle::VelocityGradient<Dim>>()[7];
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a carried gradient is that of the same velocities where the particles are now", "[property]",
                       ((int Dim), Dim), 2, 3) {
  const double share = GENERATE(0.0, 0.4, 1.0);
  CAPTURE(share);
  Random random(3);
  const Mat<Dim> before = random.matrix<Dim>(-0.3, 0.3);
  std::vector<Vec<Dim>> places;
  std::vector<Vec<Dim>> velocities;
  for (int p = 0; p < 10; ++p) {
    const Vec<Dim> y = random.vector<Dim>(-1, 1);
    velocities.push_back(before * y);
    places.push_back(y + 0.05 * share * velocities.back());
  }
  const Mat<Dim> expected = gradient_over<Dim>(places, velocities);
  World world;
  // Of 0.3, by a least-squares solution with a condition below 10: 7e-17 measured.
  CHECK((carried(world, share, before) - expected).norm() < 6e-16);
}

TEST_CASE("a gradient that a step does not resolve stays behind", "[property]") {
  const double strain = GENERATE(0.07, 0.2, 1.0);
  CAPTURE(strain);
  World world;
  const Mat<2> before = -strain / 0.05 / std::sqrt(2.0) * Mat<2>::Identity();
  const Mat<2> after = carried(world, 1.0, before);
  const double share = strain < 0.1 ? (0.1 - strain) / 0.05 : 0;
  // A rounding of numbers of size 1 to 20.
  CHECK((after - before / (1 - share * strain / std::sqrt(2.0))).norm() < 3e-15);
}
