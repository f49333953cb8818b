#include "systems/grid/splines.hpp"

#include <algorithm>
#include <cmath>

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

double integral_of(const Polynomial& p) {
  double sum = 0;
  for (std::size_t k = 0; k < p.size(); ++k) sum += p[k] / static_cast<double>(k + 1);
  return sum;
}

/// Derivative of an order, 0 or more, at xi.
double derivative_of(const Polynomial& p, int order, double xi) {
  double sum = 0;
  for (int k = static_cast<int>(p.size()) - 1; k >= order; --k) {
    double factor = p[static_cast<std::size_t>(k)];
    for (int m = 0; m < order; ++m) factor *= k - m;
    sum = sum * xi + factor;
  }
  return sum;
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
  for (std::size_t a = 0; a < CellSplines::most; ++a) {
    cell.along_integral[a] = integral_of(cell.along[a]);
    cell.across_integral[a] = integral_of(cell.across[a]);
  }
  return cell;
}

/// Term by term up to the last knot L: int_at^L (x - at)^p/p! x^k/k! dx, with x^k by powers of x - at and of at.
void set_moments(TruncatedPowers& powers) {
  double last = powers.terms[0].at;
  for (std::size_t t = 1; t < powers.count; ++t) last = std::max(last, powers.terms[t].at);
  for (std::size_t t = 0; t < powers.count; ++t) {
    const TruncatedPowers::Term& term = powers.terms[t];
    double of_length = term.jump;  // (L - at)^(p + j + 1)/(p! j!)
    for (int p = 1; p <= term.power; ++p) of_length *= (last - term.at) / p;
    for (std::size_t j = 0; j < powers.moments.size(); ++j) {
      of_length *= (last - term.at) / (j == 0 ? 1 : static_cast<double>(j));
      double share = of_length / (term.power + static_cast<double>(j) + 1);
      for (std::size_t k = j; k < powers.moments.size(); ++k) {
        powers.moments[k] += share;
        share *= term.at / static_cast<double>(k - j + 1);
      }
    }
  }
}

}  // namespace

SplineAxis::SplineAxis(int degree, int cells, bool periodic) : degree_(degree), cells_(cells), periodic_(periodic) {
  if (periodic) {
    kinds_ = {make_cell(degree, {degree, degree})};
    powers_ = {truncated_powers(degree - 1)};
    return;
  }
  for (int from_low = 0; from_low < degree; ++from_low) {
    for (int from_high = 0; from_high < degree; ++from_high) {
      kinds_.push_back(make_cell(degree, {from_low, from_high}));
    }
  }
  powers_.resize(static_cast<std::size_t>(degree * degree));
  for (int j = 0; j < multipliers(); ++j) powers_[multiplier_kind(j)] = truncated_powers(j);
}

TruncatedPowers SplineAxis::truncated_powers(int j) const {
  constexpr double rounding = 1e-12;
  const double origin = place(j);
  TruncatedPowers powers;
  // The polynomial of the spline in a cell, zero where it does not reach.
  const auto in_cell = [&](int cell) {
    const int a = j - cell;
    const bool reaches = a >= 0 && a < degree_ && (periodic_ || (cell >= 0 && cell < cells_));
    return reaches ? of_cell(cell).across[static_cast<std::size_t>(a)] : Polynomial{};
  };
  for (int knot = j - degree_ + 1; knot <= j + 1; ++knot) {
    for (int order = 0; order < degree_; ++order) {
      const double jump = derivative_of(in_cell(knot), order, 0) - derivative_of(in_cell(knot - 1), order, 1);
      if (std::abs(jump) > rounding) powers.terms[powers.count++] = {knot - origin, jump / width(j), order};
    }
  }
  set_moments(powers);
  return powers;
}

}  // namespace minamo
