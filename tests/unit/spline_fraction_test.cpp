#include "support/extremes.hpp"

#include "systems/liquid/cell_integrals.hpp"
#include "systems/liquid/spline_fraction.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace minamo;

namespace {

/// A box of 6 cells of side 1.
template <int Dim>
struct FractionBox {
  Grid<Dim> grid;
  Splines<Dim> splines;
  explicit FractionBox(int degree) {
    for (std::size_t d = 0; d < Dim; ++d) grid.cells[d] = 6;
    grid.spacing = 1;
    splines = make_splines(grid, degree);
  }
  Vec<Dim> place(const Index<Dim>& site) const {
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] = splines.axis[d].place(site[d]);
    return x;
  }
};

template <int Dim>
Vec<Dim> fraction_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Vec<Dim> n;
  for (int d = 0; d < Dim; ++d) n[d] = normal(random);
  return n.normalized();
}

/// use(x, volume of the sample) in the middle of `per_axis`^Dim parts of a cell.
template <int Dim, class Use>
void for_each_sample(const Index<Dim>& cell, int per_axis, const Use& use) {
  const double part = 1.0 / per_axis;
  for (std::size_t k = 0; k < power(static_cast<std::size_t>(per_axis), Dim); ++k) {
    Vec<Dim> xi;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= static_cast<std::size_t>(per_axis))
      xi[static_cast<Eigen::Index>(d)] = part * (static_cast<double>(rest % static_cast<std::size_t>(per_axis)) + 0.5);
    Vec<Dim> low;
    for (std::size_t d = 0; d < Dim; ++d) low[static_cast<Eigen::Index>(d)] = cell[d];
    use(xi, Vec<Dim>(low + xi), Dim == 2 ? part * part : part * part * part);
  }
}

/// By samples, of the spline of a multiplier where y = n.(x - x_l) + psi > 0: its share there, and the mean of y_+.
struct SampledBelow {
  double share = 0;
  double depth = 0;
};
template <int Dim, int K>
SampledBelow sampled_below(const FractionBox<Dim>& box, const Index<Dim>& site, const Vec<Dim>& n, double psi,
                           int per_axis) {
  SampledBelow mean;
  const double of_all = box.splines.widths(site);
  for (std::size_t k = 0; k < power(6, Dim); ++k) {
    Index<Dim> cell;
    Index<Dim> offset;
    bool reaches = true;
    std::size_t rest = k;
    for (std::size_t d = 0; d < Dim; ++d, rest /= 6) {
      cell[d] = static_cast<int>(rest % 6);
      offset[d] = site[d] - cell[d];
      reaches = reaches && offset[d] >= 0 && offset[d] < K;
    }
    if (!reaches) continue;
    const CellFrame<Dim> frame(box.grid, box.splines, cell);
    for_each_sample<Dim>(cell, per_axis, [&](const Vec<Dim>& xi, const Vec<Dim>& x, double volume) {
      const double y = n.dot(x - box.place(site)) + psi;
      if (y <= 0) return;
      const double weight = volume * SplineWeights<Dim, K>(frame, xi).multiplier(offset) / of_all;
      mean.share += weight;
      mean.depth += weight * y;
    });
  }
  return mean;
}

template <int Dim, int K>
void check_shares(int per_axis, double tolerance) {
  const FractionBox<Dim> box(K);
  std::mt19937 random(K);
  for (const int at : {0, 1, 2, 4 + K}) {
    Index<Dim> site;
    site.fill(3);
    site[0] = at;
    const Vec<Dim> n = fraction_direction<Dim>(random);
    const SplineFraction<Dim> fraction(box.splines, site, n);
    for (const double psi : {-0.6, -0.1, 0.25, 0.7}) {
      CAPTURE(Dim, K, at, n.transpose(), psi);
      const auto value = fraction(psi);
      const SampledBelow sampled = sampled_below<Dim, K>(box, site, n, psi, per_axis);
      CHECK(value.share == Approx(sampled.share).margin(tolerance));
      CHECK(fraction.mean_depth(psi) == Approx(sampled.depth).margin(tolerance));
      constexpr double step = 1e-5;
      CHECK(value.slope == Approx((fraction(psi + step).share - fraction(psi - step).share) / (2 * step)).margin(1e-6));
      if (value.share > 1e-6 && value.share < 1 - 1e-6) {
        CHECK(fraction.inverse(value.share, 0) == Approx(psi).margin(1e-6));
      }
    }
  }
}

/// Integrals over what of a cell is below a plane against samples.
template <int Dim, int K>
void check_integrals(const Index<Dim>& cell, int per_axis, double tolerance) {
  using Integrals = CellIntegrals<Dim, K>;
  const FractionBox<Dim> box(K);
  const CellFrame<Dim> frame(box.grid, box.splines, cell);
  std::mt19937 random(7);
  const Vec<Dim> n = fraction_direction<Dim>(random);
  const Vec<Dim> through = frame.low + Vec<Dim>::Constant(0.45);
  const auto distance = [&](const Vec<Dim>& x) { return n.dot(x - through); };
  std::array<double, Integrals::multipliers> psi;
  std::size_t m = 0;
  for_each_multiplier<Dim, K>(
      [&](std::size_t, const Index<Dim>& offset) { psi[m++] = distance(box.place(box.splines.site(cell, offset))); });
  std::array<double, Integrals::faces> sum{};
  Integrals(frame, psi).add_faces(sum);
  std::array<double, Integrals::faces> sampled{};
  for_each_sample<Dim>(cell, per_axis, [&](const Vec<Dim>& xi, const Vec<Dim>& x, double volume) {
    if (distance(x) <= 0) return;
    const SplineWeights<Dim, K> weights(frame, xi);
    std::size_t f = 0;
    for_each_direction<Dim>([&](auto direction) {
      constexpr int D = direction();
      for_each_face<Dim, K, D>(
          [&](std::size_t, const Index<Dim>& offset) { sampled[f++] += volume * weights.template face<D>(offset); });
    });
  });
  Largest worst;
  for (std::size_t f = 0; f < sum.size(); ++f) worst.add(std::abs(sum[f] - sampled[f]));
  CAPTURE(Dim, K, n.transpose());
  CHECK(worst.value() < tolerance);
}

}  // namespace

// Samples err by the share of parts that the plane cuts, at random signs.
TEST_CASE("the share of a spline below a plane is that of its integral", "[unit]") {
  check_shares<2, 2>(200, 1e-4);
  check_shares<2, 3>(200, 1e-4);
  check_shares<3, 2>(24, 2e-3);
  check_shares<3, 3>(24, 2e-3);
}

TEST_CASE("the share of a spline keeps its digits next to a plane along the grid", "[unit]") {
  // A symmetric spline: as much is below a plane as above its image. By differences of powers 5e-10 was lost in
  // 2-D, 2e-5 in 3-D.
  const double off = GENERATE(1e-1, 1e-2, 5e-3, 1e-4);
  const int degree = GENERATE(2, 3);
  CAPTURE(off, degree);
  const FractionBox<2> plane(degree);
  const FractionBox<3> space(degree);
  const SplineFraction<2> in_plane(plane.splines, {3, 3}, Vec<2>(off, 1).normalized());
  const SplineFraction<3> in_space(space.splines, {3, 3, 3}, Vec<3>(off, 1, -0.7 * off).normalized());
  for (const double psi : {0.003, 0.2, 0.6}) {
    CAPTURE(psi);
    CHECK(std::abs(in_plane(psi).share + in_plane(-psi).share - 1) < 1e-14);
    CHECK(std::abs(in_space(psi).share + in_space(-psi).share - 1) < 1e-14);
    CHECK(in_plane.inverse(in_plane(psi).share, 0) == Approx(psi).epsilon(1e-12));
  }
}

TEST_CASE("integrals of splines over the liquid in a cell are exact below a plane", "[unit]") {
  check_integrals<2, 2>({2, 3}, 400, 3e-5);
  check_integrals<2, 2>({0, 5}, 400, 3e-5);
  check_integrals<2, 3>({0, 3}, 400, 3e-5);
  check_integrals<3, 2>({2, 0, 3}, 60, 1e-4);
  check_integrals<3, 3>({1, 5, 3}, 60, 1e-4);
}
