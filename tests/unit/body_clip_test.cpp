#include "support/kernels.hpp"
#include "systems/bodies/geometry/clip.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

/// Share of a simplex where a linear function is positive, by many points: barycentric coordinates of a lattice.
template <std::size_t N>
double share_by_counting(const std::array<double, N>& value, kernels::Random& random, int count) {
  int positive = 0;
  for (int k = 0; k < count; ++k) {
    // Uniform in the simplex: gaps between sorted numbers.
    std::array<double, N + 1> cut{};
    cut[N] = 1;
    for (std::size_t i = 1; i < N; ++i) cut[i] = random(0, 1);
    std::sort(cut.begin(), cut.end());
    double at = 0;
    for (std::size_t i = 0; i < N; ++i) at += (cut[i + 1] - cut[i]) * value[i];
    positive += at > 0;
  }
  return static_cast<double>(positive) / count;
}

template <std::size_t N>
void check_against_counting() {
  kernels::Random random(17);
  constexpr int count = 20000;
  for (int k = 0; k < 40; ++k) {
    std::array<double, N> value;
    for (double& v : value) v = random(-1, 1);
    const double counted = share_by_counting<N>(value, random, count);
    const double sigma = std::sqrt(0.25 / count);
    CHECK(std::abs(positive_share<N>(value) - counted) < 5 * sigma);
  }
}

}  // namespace

TEST_CASE("the positive share of segments, triangles and tetrahedra is what points tell", "[unit]") {
  check_against_counting<2>();
  check_against_counting<3>();
  check_against_counting<4>();
}

TEST_CASE("the positive shares of a function and of its negative are one together", "[unit]") {
  kernels::Random random(3);
  for (int k = 0; k < 100; ++k) {
    std::array<double, 4> value;
    std::array<double, 4> opposite;
    for (std::size_t i = 0; i < 4; ++i) {
      value[i] = random(-1, 1);
      opposite[i] = -value[i];
    }
    CHECK(positive_share<4>(value) + positive_share<4>(opposite) == Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("what a plane leaves open of a face is exact", "[unit]") {
  // x + 2 y > 0.7 over the side x = 0.3 of a unit cell: y > 0.2.
  const auto plane = [](const Vec<2>& x) { return x[0] + 2 * x[1] - 0.7; };
  CHECK(open_share<2>({0.3, 0}, {0.3, 1}, 0, plane) == Approx(0.8).epsilon(1e-14));
  // x + y > 0.5 over the square z = 0: all but a triangle of 1/8.
  const auto corner = [](const Vec<3>& x) { return x[0] + x[1] - 0.5; };
  CHECK(open_share<3>({0, 0, 0}, {1, 1, 0}, 2, corner) == Approx(1 - 0.125).epsilon(1e-14));
}
