/// \file
/// (E119) Splines on coarser cells.

#include "support/extremes.hpp"

#include "systems/viscosity/coarse_axis.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;

namespace {

int splines_of(const CoarseAxis& axis, int degree, Family family) {
  if (axis.periodic()) return axis.cells();
  return family == Family::along ? axis.cells() + degree : axis.cells() + degree - 1;
}

/// Coefficients on the finer axis of a function with coefficients on the coarser one.
std::vector<double> refined(const CoarseAxis& coarse, Family family, const std::vector<double>& coefficients) {
  std::vector<double> fine;
  for (int k = 0; coarse.has_finer(family, k); ++k) {
    const CoarseAxis::Parents& parents = coarse.parents(family, k);
    double sum = 0;
    for (std::size_t a = 0; a < CoarseAxis::most; ++a) {
      if (parents.weight[a] == 0) continue;
      const int parent = coarse.wrapped(parents.first + static_cast<int>(a));
      sum += parents.weight[a] * coefficients[static_cast<std::size_t>(parent)];
    }
    fine.push_back(sum);
  }
  return fine;
}

/// Coefficients of the slope, by (E76).
std::vector<double> slope_of(const CoarseAxis& axis, int degree, const std::vector<double>& along) {
  std::vector<double> across;
  for (int j = 0; j < splines_of(axis, degree, Family::across); ++j) {
    const auto low = static_cast<std::size_t>(j);
    across.push_back((along[(low + 1) % along.size()] - along[low]) / axis.width(j));
  }
  return across;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = largest_of(largest, std::abs(a[k] - b[k]));
  return largest;
}

/// No two alike.
std::vector<double> some_coefficients(int count) {
  std::vector<double> c;
  for (int k = 0; k < count; ++k) c.push_back(std::sin(1 + 3.7 * k * k));
  return c;
}

}  // namespace

TEST_CASE("slopes of coarse splines are those of the finer ones that make them", "[unit]") {
  const int degree = GENERATE(2, 3);
  const auto [cells, periodic] = GENERATE(std::pair(16, false), std::pair(17, false), std::pair(5, false),
                                          std::pair(4, false), std::pair(20, true));
  CoarseAxis fine(degree, cells, periodic);
  for (int level = 0; level < 2; ++level) {
    const CoarseAxis coarse = fine.coarser();
    const auto along = some_coefficients(splines_of(coarse, degree, Family::along));
    const auto slope_then_fine = refined(coarse, Family::across, slope_of(coarse, degree, along));
    const auto fine_then_slope = slope_of(fine, degree, refined(coarse, Family::along, along));
    CHECK(difference(slope_then_fine, fine_then_slope) < 1e-12);
    const std::vector<double> ones(static_cast<std::size_t>(splines_of(coarse, degree, Family::across)), 1.0);
    for (const double one : refined(coarse, Family::across, ones)) CHECK(one == Approx(1).epsilon(1e-14));
    fine = coarse;
  }
}

TEST_CASE("an axis has half as many cells on the next level, or as many", "[unit]") {
  CHECK(CoarseAxis(2, 16, false).coarser().cells() == 8);
  const CoarseAxis odd = CoarseAxis(2, 17, false).coarser();
  CHECK(odd.cells() == 8);
  CHECK(odd.width_of_cell(0) == 2);
  CHECK(odd.width_of_cell(7) == 3);
  CHECK(odd.parent_of_cell(16) == 7);
  CHECK(CoarseAxis(2, 3, false).coarser().cells() == 3);
  CHECK(CoarseAxis(2, 9, true).coarser().cells() == 9);  // would not go around
  CHECK(CoarseAxis(3, 8, true).coarser().cells() == 8);  // a spline would meet itself
}

TEST_CASE("squares of coarse splines are those of splines on cells of that width", "[unit]") {
  const int degree = GENERATE(2, 3);
  const bool periodic = GENERATE(false, true);
  const CoarseAxis coarse = CoarseAxis(degree, 16, periodic).coarser();
  const SplineAxis wide(degree, 8, periodic);
  const auto integral = [](const CellSplines::Polynomial& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (std::size_t j = 0; j < p.size(); ++j) sum += p[i] * p[j] / static_cast<double>(i + j + 1);
    }
    return sum;
  };
  const auto slope = [](const CellSplines::Polynomial& p) {
    CellSplines::Polynomial q{};
    for (std::size_t k = 1; k < p.size(); ++k) q[k - 1] = static_cast<double>(k) * p[k];
    return q;
  };
  for (int cell = 0; cell < 8; ++cell) {
    for (std::size_t a = 0; a <= static_cast<std::size_t>(degree); ++a) {
      const auto& p = wide.of_cell(cell).along[a];
      CHECK(coarse.square(Family::along, cell, a, false) == Approx(2 * integral(p)));
      CHECK(coarse.square(Family::along, cell, a, true) == Approx(integral(slope(p)) / 2));
    }
    for (std::size_t a = 0; a < static_cast<std::size_t>(degree); ++a) {
      const auto& p = wide.of_cell(cell).across[a];
      CHECK(coarse.square(Family::across, cell, a, false) == Approx(2 * integral(p)));
      CHECK(coarse.square(Family::across, cell, a, true) == Approx(integral(slope(p)) / 2));
    }
  }
}
