#include "systems/viscosity/coarse_axis.hpp"

#include <algorithm>

namespace minamo {

namespace {

/// The next row of the triangle of B-splines: from those of degree k - 1 in the cell [t_mu, t_mu+1) to those of degree
/// k. \param knot  knot(m) = t_{mu + m}
template <class Knot>
void raise_degree(int k, double x, const Knot& knot, std::array<double, CoarseAxis::most>& b) {
  double left = 0;
  for (int j = 0; j < k; ++j) {
    const double low = knot(j + 1 - k);
    const double high = knot(j + 1);
    const double share = b[static_cast<std::size_t>(j)] / (high - low);
    b[static_cast<std::size_t>(j)] = left + (high - x) * share;
    left = (x - low) * share;
  }
  b[static_cast<std::size_t>(k)] = left;
}

struct GaussPoint {
  double x, weight;
};
/// Gauss's rule of four points on 0 ... 1, exact up to degree 7.
constexpr std::array<GaussPoint, 4> gauss{{{0.06943184420297371, 0.17392742256872693},
                                           {0.33000947820757187, 0.32607257743127307},
                                           {0.66999052179242813, 0.32607257743127307},
                                           {0.93056815579702629, 0.17392742256872693}}};

std::vector<double> counted(int cells) {
  std::vector<double> ends(static_cast<std::size_t>(cells) + 1);
  for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = static_cast<double>(k);
  return ends;
}

}  // namespace

CoarseAxis::CoarseAxis(int degree, int cells, bool periodic) : CoarseAxis(degree, periodic, counted(cells)) {}

CoarseAxis CoarseAxis::coarser() const {
  const bool is_odd = cells() % 2 != 0;
  const bool halves = periodic_ ? !is_odd && cells() / 2 >= degree_ + 2 : cells() >= 4;
  std::vector<double> ends;
  if (halves) {
    for (std::size_t k = 0; k < ends_.size(); k += 2) ends.push_back(ends_[k]);
    ends.back() = ends_.back();
  } else {
    ends = ends_;
  }
  CoarseAxis coarse(degree_, periodic_, std::move(ends));
  for (int cell = 0; cell < cells(); ++cell)
    coarse.parent_of_cell_.push_back(halves ? std::min(cell / 2, coarse.cells() - 1) : cell);
  for (const Family family : {Family::along, Family::across}) {
    coarse.find_parents(family, *this);
    coarse.find_squares(family);
  }
  return coarse;
}

double CoarseAxis::end(int k) const {
  const int n = cells();
  if (!periodic_) return ends_[static_cast<std::size_t>(std::clamp(k, 0, n))];
  const int around = k >= 0 ? k / n : -((n - 1 - k) / n);
  return ends_[static_cast<std::size_t>(k - around * n)] + around * ends_.back();
}

std::array<double, CoarseAxis::most> CoarseAxis::values(int degree, int cell, double x) const {
  std::array<double, most> b{1};
  for (int k = 1; k <= degree; ++k)
    raise_degree(
        k, x, [&](int m) { return end(cell + m); }, b);
  return b;
}

std::array<double, CoarseAxis::most> CoarseAxis::slopes(int degree, int cell, double x) const {
  const std::array<double, most> lower = values(degree - 1, cell, x);
  std::array<double, most> slope{};
  // Of the splines of the lower degree every one falls to one spline and rises to the next.
  for (int a = 0; a < degree; ++a) {
    const double change =
        degree * lower[static_cast<std::size_t>(a)] / (end(cell + a + 1) - end(cell + a + 1 - degree));
    slope[static_cast<std::size_t>(a)] -= change;
    slope[static_cast<std::size_t>(a) + 1] += change;
  }
  return slope;
}

void CoarseAxis::find_squares(Family family) {
  const int degree = degree_of(family);
  for (int cell = 0; cell < cells(); ++cell) {
    Squares squares{};
    for (const GaussPoint& point : gauss) {
      const double weight = point.weight * width_of_cell(cell);
      const double x = end(cell) + point.x * width_of_cell(cell);
      const auto value = values(degree, cell, x);
      const auto slope = slopes(degree, cell, x);
      for (std::size_t a = 0; a <= static_cast<std::size_t>(degree); ++a) {
        squares[a][0] += weight * value[a] * value[a];
        squares[a][1] += weight * slope[a] * slope[a];
      }
    }
    squares_[static_cast<std::size_t>(family)].push_back(squares);
  }
}

/// The weights of coarse splines in the coefficient of a finer one, whose inner knots take the place of x.
CoarseAxis::Parents CoarseAxis::insert_knots(int degree, const CoarseAxis& fine, int spline) const {
  const double begin = fine.end(spline - degree);
  int cell = periodic_ ? -degree : 0;
  while (end(cell + 1) <= begin) ++cell;
  Parents parents{.first = wrapped(cell), .weight = {1}};
  for (int k = 1; k <= degree; ++k)
    raise_degree(
        k, fine.end(spline - degree + k), [&](int m) { return end(cell + m); }, parents.weight);
  return parents;
}

void CoarseAxis::find_parents(Family family, const CoarseAxis& fine) {
  const int degree = degree_of(family);
  const int splines = periodic_ ? fine.cells() : fine.cells() + degree;
  std::vector<Parents>& parents = parents_[static_cast<std::size_t>(family)];
  for (int k = 0; k < splines; ++k) parents.push_back(insert_knots(degree, fine, k));
}

}  // namespace minamo
