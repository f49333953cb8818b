#include "systems/conforming/splines.hpp"

#include <algorithm>

namespace minamo {

namespace {

using Polynomial = CellSplines::Polynomial;

/// (a + b xi) p, of which the highest power vanishes.
Polynomial times_linear(double a, double b, const Polynomial& p) {
  Polynomial product{};
  for (std::size_t k = 0; k < p.size(); ++k) {
    product[k] += a * p[k];
    if (k + 1 < p.size()) product[k + 1] += b * p[k];
  }
  return product;
}

/// Knots around the cell from 0 to 1, those beyond the ends of the axis moved onto the ends.
struct Knots {
  int from_low;   ///< cells between the cell and the low end
  int from_high;  ///< and the high end
  double operator()(int m) const { return std::clamp(m, -from_low, from_high + 1); }
};

/// The spline of a degree whose support begins at knot m, within the cell. C. de Boor, A Practical Guide to Splines,
/// Springer (1978), chapter X, eq. (4).
Polynomial spline(const Knots& knots, int m, int degree) {
  if (degree == 0) return m == 0 ? Polynomial{1} : Polynomial{};
  Polynomial sum{};
  const auto add = [&](double from, double to, int first) {
    if (to == from) return;  // no support: the spline of lower degree is zero
    const double slope = 1 / (to - from);
    const Polynomial part = times_linear(-from * slope, slope, spline(knots, first, degree - 1));
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
  };
  add(knots(m), knots(m + degree), m);
  add(knots(m + degree + 1), knots(m + 1), m + 1);
  return sum;
}

/// Mean of the inner knots of a spline.
double greville(const Knots& knots, int m, int degree) {
  double sum = 0;
  for (int k = 1; k <= degree; ++k) sum += knots(m + k);
  return sum / degree;
}

/// Variance of the inner knots over degree - 1.
double spread(const Knots& knots, int m, int degree) {
  if (degree == 1) return 0;
  const double middle = greville(knots, m, degree);
  double sum = 0;
  for (int k = 1; k <= degree; ++k) sum += (knots(m + k) - middle) * (knots(m + k) - middle);
  return sum / (degree * (degree - 1));
}

CellSplines make_cell(int degree, const Knots& knots) {
  CellSplines cell;
  for (int a = 0; a <= degree; ++a) {
    cell.along[static_cast<std::size_t>(a)] = spline(knots, a - degree, degree);
    cell.along_place[static_cast<std::size_t>(a)] = greville(knots, a - degree, degree);
    cell.along_spread[static_cast<std::size_t>(a)] = spread(knots, a - degree, degree);
  }
  for (int a = 0; a < degree; ++a) {
    cell.across[static_cast<std::size_t>(a)] = spline(knots, a - degree + 1, degree - 1);
    cell.across_place[static_cast<std::size_t>(a)] = greville(knots, a - degree + 1, degree - 1);
    cell.across_spread[static_cast<std::size_t>(a)] = spread(knots, a - degree + 1, degree - 1);
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(degree); ++a) {
    const double square = cell.across_place[a] * cell.across_place[a];
    for (std::size_t k = 0; k < CellSplines::most; ++k) cell.across_moment[k] += square * cell.across[a][k];
  }
  cell.across_moment[2] -= 1;
  return cell;
}

}  // namespace

SplineAxis::SplineAxis(int degree, int cells, bool periodic) : degree_(degree), cells_(cells), periodic_(periodic) {
  if (periodic) {
    kinds_ = {make_cell(degree, {degree, degree})};
    return;
  }
  for (int from_low = 0; from_low < degree; ++from_low) {
    for (int from_high = 0; from_high < degree; ++from_high) {
      kinds_.push_back(make_cell(degree, {from_low, from_high}));
    }
  }
}

}  // namespace minamo
