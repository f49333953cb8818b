#include "systems/grid/basis.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;

namespace {

constexpr int last = 7;

/// Weight and slope of a node, from the dual cell of another node.
double value(int cell, int node, double r) {
  const AxisBasis& basis = axis_basis(cell, last);
  const int a = node - cell - basis.first;
  return a < 0 || a > 2 ? 0 : basis.value(static_cast<std::size_t>(a), r - cell);
}
double slope(int cell, int node, double r) {
  const AxisBasis& basis = axis_basis(cell, last);
  const int a = node - cell - basis.first;
  return a < 0 || a > 2 ? 0 : basis.derivative(static_cast<std::size_t>(a), r - cell);
}

}  // namespace

TEST_CASE("a weight inside is the quadratic B-spline", "[unit]") {
  // N(0) = 3/4, N(1/2) = 1/2, N(1) = 1/8, N(1/4) = 11/16: exact in binary.
  CHECK(value(3, 3, 3.0) == 0.75);
  CHECK(value(3, 3, 3.5) == 0.5);
  CHECK(value(3, 4, 3.0) == 0.125);
  CHECK(value(3, 2, 3.0) == 0.125);
  CHECK(value(3, 3, 3.25) == 0.6875);
}

TEST_CASE("a weight in a wall half cell is linear, and one at the wall", "[unit]") {
  const double s = GENERATE(0.0, 0.125, 0.5);
  CAPTURE(s);
  CHECK(value(0, 0, s) == 1 - s);
  CHECK(value(0, 1, s) == s);
  CHECK(value(0, 2, s) == 0);
  CHECK(value(last, last, last - s) == 1 - s);
  CHECK(value(last, last - 1, last - s) == s);
  CHECK(value(last, last - 2, last - s) == 0);
}

TEST_CASE("weights and slopes are continuous from dual cell to dual cell", "[unit]") {
  const int cell = GENERATE(range(0, last));
  const int node = GENERATE(range(0, last + 1));
  CAPTURE(cell, node);
  const double between = cell + 0.5;
  // Polynomials with dyadic coefficients at a dyadic place: exact.
  CHECK(value(cell, node, between) == value(cell + 1, node, between));
  CHECK(slope(cell, node, between) == slope(cell + 1, node, between));
}

TEST_CASE("the slope is the derivative of the weight", "[unit]") {
  const int cell = GENERATE(0, 1, 4, last);
  const auto a = GENERATE(range(std::size_t{0}, std::size_t{3}));
  CAPTURE(cell, a);
  const AxisBasis& basis = axis_basis(cell, last);
  // The central difference of a quadratic is its derivative; all numbers are dyadic.
  const double difference = (basis.value(a, 0.375) - basis.value(a, 0.125)) / 0.25;
  CHECK(basis.derivative(a, 0.25) == difference);
}

TEST_CASE("products of weights and slopes are the products", "[unit]") {
  const int cell = GENERATE(0, 3, last);
  const auto a = GENERATE(range(std::size_t{0}, std::size_t{3}));
  const auto b = GENERATE(range(std::size_t{0}, std::size_t{3}));
  CAPTURE(cell, a, b);
  const AxisBasis& basis = axis_basis(cell, last);
  const double xi = 0.25;
  const auto polynomial = [&](const AxisBasis::PairProducts& c) {
    const std::size_t ab = 3 * a + b;
    return c[0][ab] + xi * (c[1][ab] + xi * (c[2][ab] + xi * (c[3][ab] + xi * c[4][ab])));
  };
  // Dyadic numbers: exact.
  CHECK(polynomial(basis.weight_weight) == basis.value(a, xi) * basis.value(b, xi));
  CHECK(polynomial(basis.slope_weight) == basis.derivative(a, xi) * basis.value(b, xi));
  CHECK(polynomial(basis.weight_slope) == basis.value(a, xi) * basis.derivative(b, xi));
  CHECK(polynomial(basis.slope_slope) == basis.derivative(a, xi) * basis.derivative(b, xi));
}

TEST_CASE("the integral of a weight is that of a quadrature", "[unit]") {
  const int node = GENERATE(range(0, last + 1));
  CAPTURE(node);
  // Three-point Gauss is exact for the quadratics on both halves of every dual cell.
  double sum = 0;
  for (int half = 0; half < 2 * last; ++half) {
    const int cell = (half + 1) / 2;
    const double middle = 0.5 * half + 0.25;
    const double apart = 0.25 * std::sqrt(0.6);
    sum += (5 * value(cell, node, middle - apart) + 8 * value(cell, node, middle) +
            5 * value(cell, node, middle + apart)) /
           36;
  }
  CHECK(sum == Approx(axis_integral(node, last)).epsilon(2e-15));  // 2e-16 measured
}
