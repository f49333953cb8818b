#include "support/extremes.hpp"
#include "support/staggered.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::kernels;

namespace {

/// Few cells and many, between walls and around.
struct Case {
  int degree;
  int cells;
  bool periodic;
};
Case any_axis() {
  const int degree = GENERATE(2, 3);
  const bool periodic = GENERATE(false, true);
  const int cells = periodic ? GENERATE(0, 3) + degree + 2 : GENERATE(1, 2, 3, 4, 8);
  UNSCOPED_INFO("degree " << degree << ", " << cells << " cells, " << (periodic ? "periodic" : "walls"));
  return {degree, cells, periodic};
}

double value(const CellSplines::Polynomial& c, double x) { return ((c[3] * x + c[2]) * x + c[1]) * x + c[0]; }
double slope(const CellSplines::Polynomial& c, double x) { return (3 * c[3] * x + 2 * c[2]) * x + c[1]; }

/// use(cell, xi, splines of the cell) at places all over the axis, ends of cells included.
template <class Use>
void for_each_place(const SplineAxis& axis, const Use& use) {
  for (int cell = 0; cell < axis.cells(); ++cell) {
    for (const double xi : {0.0, 0.1, 0.37, 0.5, 0.92, 1.0}) use(cell, xi, axis.of_cell(cell));
  }
}

constexpr double rounding = 1e-15;  // of a few products of size 1; times the place, up to 8

}  // namespace

TEST_CASE("splines of a cell add up to one, and their Greville points to the place", "[unit]") {
  const auto [degree, cells, periodic] = any_axis();
  const SplineAxis axis(degree, cells, periodic);
  Largest worst;
  for_each_place(axis, [&](int, double xi, const CellSplines& of) {
    for (const bool along : {true, false}) {
      const auto& spline = along ? of.along : of.across;
      const auto& place = along ? of.along_place : of.across_place;
      double sum = 0;
      double first = 0;
      for (std::size_t a = 0; a < spline.size(); ++a) {
        sum += value(spline[a], xi);
        first += value(spline[a], xi) * place[a];
      }
      worst.add(std::abs(sum - 1));
      worst.add(std::abs(first - xi));
    }
  });
  CHECK(worst.value() < 2 * rounding);
}

TEST_CASE("squares of Greville points less the spread of knots add up to the square of the place", "[unit]") {
  const auto [degree, cells, periodic] = any_axis();
  const SplineAxis axis(degree, cells, periodic);
  Largest worst;
  for_each_place(axis, [&, degree = degree](int, double xi, const CellSplines& of) {
    double along = 0;
    double across = 0;
    for (std::size_t a = 0; a < of.along.size(); ++a) {
      along += value(of.along[a], xi) * (of.along_place[a] * of.along_place[a] - of.along_spread[a]);
      across += value(of.across[a], xi) * (of.across_place[a] * of.across_place[a] - of.across_spread[a]);
    }
    worst.add(std::abs(along - xi * xi));
    if (degree == 3) worst.add(std::abs(across - xi * xi));  // hats hold no square
  });
  CHECK(worst.value() < 4 * rounding);
}

TEST_CASE("splines of a cell are those of the recursion", "[unit]") {
  const auto [degree, cells, periodic] = any_axis();
  const SplineAxis axis(degree, cells, periodic);
  Largest worst;
  for_each_place(axis,
                 [&, degree = degree, cells = cells, periodic = periodic](int cell, double xi, const CellSplines& of) {
                   if (xi == 1 && cell + 1 < cells) return;  // belongs to the next cell
                   if (xi == 1 && periodic) return;
                   for (int a = 0; a <= degree; ++a) {
                     const double plain = plain_spline(cells, periodic, degree, axis.wrapped(cell + a), cell + xi);
                     worst.add(std::abs(value(of.along[static_cast<std::size_t>(a)], xi) - plain));
                   }
                   for (int a = 0; a < degree; ++a) {
                     // Between walls the recursion for a degree less counts the same splines.
                     const double plain = plain_spline(cells, periodic, degree - 1, axis.wrapped(cell + a), cell + xi);
                     worst.add(std::abs(value(of.across[static_cast<std::size_t>(a)], xi) - plain));
                   }
                 });
  CHECK(worst.value() < 10 * rounding);  // differences of places up to 8
}

TEST_CASE("the derivative of a spline sum has the differences of its coefficients over the widths", "[unit]") {
  const auto [degree, cells, periodic] = any_axis();
  const SplineAxis axis(degree, cells, periodic);
  Random random(5);
  std::vector<double> u;
  for (int i = 0; i < axis.sites(); ++i) u.push_back(random(-1, 1));
  const auto at = [&](int i) { return u[static_cast<std::size_t>(axis.wrapped(i))]; };
  Largest worst;
  for_each_place(axis, [&, degree = degree](int cell, double xi, const CellSplines& of) {
    double derivative = 0;
    double sum = 0;
    for (int a = 0; a <= degree; ++a) derivative += at(cell + a) * slope(of.along[static_cast<std::size_t>(a)], xi);
    for (int a = 0; a < degree; ++a) {
      const double difference = at(cell + a + 1) - at(cell + a);
      sum += difference / axis.width(axis.wrapped(cell + a)) * value(of.across[static_cast<std::size_t>(a)], xi);
    }
    worst.add(std::abs(derivative - sum));
  });
  CHECK(worst.value() < 20 * rounding);  // differences of size 1 over widths of 1/3 and more
}

TEST_CASE("widths and integrals of splines are what Gauss quadrature gives", "[unit]") {
  const auto [degree, cells, periodic] = any_axis();
  const SplineAxis axis(degree, cells, periodic);
  // Two points, exact to degree 3.
  const double away = 0.5 / std::sqrt(3.0);
  std::vector<double> along(static_cast<std::size_t>(axis.sites()), 0.0);
  std::vector<double> across(static_cast<std::size_t>(axis.multipliers()), 0.0);
  for (int cell = 0; cell < cells; ++cell) {
    const CellSplines& of = axis.of_cell(cell);
    for (const double xi : {0.5 - away, 0.5 + away}) {
      for (int a = 0; a <= degree; ++a) {
        along[static_cast<std::size_t>(axis.wrapped(cell + a))] +=
            0.5 * value(of.along[static_cast<std::size_t>(a)], xi);
      }
      for (int a = 0; a < degree; ++a) {
        across[static_cast<std::size_t>(axis.wrapped(cell + a))] +=
            0.5 * value(of.across[static_cast<std::size_t>(a)], xi);
      }
    }
  }
  Largest worst;
  for (std::size_t i = 0; i < along.size(); ++i) worst.add(std::abs(along[i] - axis.integral(static_cast<int>(i))));
  for (std::size_t i = 0; i < across.size(); ++i) worst.add(std::abs(across[i] - axis.width(static_cast<int>(i))));
  CHECK(worst.value() < 3 * rounding);
}
