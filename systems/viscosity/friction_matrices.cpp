#include "systems/viscosity/friction_matrices.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace minamo {

namespace {

using Polynomial = CellSplines::Polynomial;

Polynomial slope(const Polynomial& p) {
  Polynomial q{};
  for (std::size_t k = 1; k < p.size(); ++k) q[k - 1] = static_cast<double>(k) * p[k];
  return q;
}

/// Integral of the product over the cell, in units of its width.
double integral(const Polynomial& p, const Polynomial& q) {
  double sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) sum += p[i] * q[j] / static_cast<double>(i + j + 1);
  }
  return sum;
}

/// Value at the low (end 0) or the high end of the cell.
double at_end(const Polynomial& p, std::size_t end) {
  return end == 0 ? p[0] : std::accumulate(p.begin(), p.end(), 0.0);
}

/// Integrals of products of the splines of a cell and of their slopes along an axis: splines of degree K come first,
/// those of degree K - 1 after them. A matrix in 3-D takes each of them a thousand times.
class AxisIntegrals {
 public:
  explicit AxisIntegrals(const CellSplines& splines) {
    std::array<std::array<Polynomial, 2>, count> all;  // the spline, its slope
    for (std::size_t a = 0; a < CellSplines::most; ++a) {
      all[along(a)] = {splines.along[a], slope(splines.along[a])};
      all[across(a)] = {splines.across[a], slope(splines.across[a])};
    }
    for (std::size_t p = 0; p < count; ++p) {
      for (std::size_t end = 0; end < 2; ++end) ends_[p][end] = at_end(all[p][0], end);
      for (std::size_t q = 0; q < count; ++q) {
        for (std::size_t i = 0; i < 2; ++i) {
          for (std::size_t j = 0; j < 2; ++j) integrals_[p][q][i][j] = integral(all[p][i], all[q][j]);
        }
      }
    }
  }

  static constexpr std::size_t along(std::size_t a) { return a; }
  static constexpr std::size_t across(std::size_t a) { return CellSplines::most + a; }

  /// Of spline p, or of its slope, times spline q, or its slope.
  double operator()(std::size_t p, bool slope_of_p, std::size_t q, bool slope_of_q) const {
    return integrals_[p][q][slope_of_p][slope_of_q];
  }
  /// The product of both at an end of the cell.
  double at(std::size_t end, std::size_t p, std::size_t q) const { return ends_[p][end] * ends_[q][end]; }

 private:
  static constexpr std::size_t count = 2 * CellSplines::most;
  std::array<std::array<std::array<std::array<double, 2>, 2>, count>, count> integrals_;
  std::array<std::array<double, 2>, count> ends_;
};

/// The function of a face: a spline per axis, as AxisIntegrals counts them.
template <int Dim>
struct Product {
  int direction;
  std::array<std::size_t, static_cast<std::size_t>(Dim)> factor;
};

template <int Dim>
using CellIntegrals = std::array<const AxisIntegrals*, static_cast<std::size_t>(Dim)>;

/// Integral of d_i f d_j g.
template <int Dim>
double slopes(const CellIntegrals<Dim>& axes, const Product<Dim>& f, int i, const Product<Dim>& g, int j) {
  double product = 1;
  for (int d = 0; d < Dim; ++d) {
    const auto e = static_cast<std::size_t>(d);
    product *= (*axes[e])(f.factor[e], d == i, g.factor[e], d == j);
  }
  return product;
}

/// 2 D(N_f):D(N_g) = delta_de grad N_f . grad N_g + d_e N_f d_d N_g for faces of directions d and e.
template <int Dim>
double friction(const CellIntegrals<Dim>& axes, const Product<Dim>& f, const Product<Dim>& g) {
  double sum = slopes<Dim>(axes, f, g.direction, g, f.direction);
  if (f.direction != g.direction) return sum;
  for (int i = 0; i < Dim; ++i) sum += slopes<Dim>(axes, f, i, g, i);
  return sum;
}

/// Integral of f g over the low (end 0) or the high side of the cell across an axis.
template <int Dim>
double over_side(const CellIntegrals<Dim>& axes, const Product<Dim>& f, const Product<Dim>& g, std::size_t axis,
                 std::size_t end) {
  double product = 1;
  for (std::size_t e = 0; e < Dim; ++e) {
    product *=
        e == axis ? axes[e]->at(end, f.factor[e], g.factor[e]) : (*axes[e])(f.factor[e], false, g.factor[e], false);
  }
  return product;
}

/// (E83) What walls with slip lengths add, faces along the wall alone.
template <int Dim, class PerLength>
double wall_friction(const CellIntegrals<Dim>& axes, const Product<Dim>& f, const Product<Dim>& g,
                     const PerLength& per_slip_length) {
  if (f.direction != g.direction) return 0;
  double sum = 0;
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    if (static_cast<int>(axis) == f.direction) continue;
    for (std::size_t end = 0; end < 2; ++end) {
      const double per_length = per_slip_length[axis][end];
      if (per_length > 0) sum += per_length * over_side<Dim>(axes, f, g, axis, end);
    }
  }
  return sum;
}

/// Cells of an axis with the same splines and the same ends of the axis next to them.
struct Kind {
  std::size_t number;
  AxisIntegrals integrals;
  std::array<bool, 2> at_end;
};

/// Kinds of the cells of an axis, each once.
std::vector<Kind> kinds_of(const SplineAxis& axis) {
  std::vector<Kind> kinds;
  for (int cell = 0; cell < axis.cells(); ++cell) {
    const std::size_t number = axis.kind_of(cell);
    const auto is_same = [&](const Kind& other) { return other.number == number; };
    if (std::any_of(kinds.begin(), kinds.end(), is_same)) continue;
    const bool ends = !axis.periodic();
    kinds.push_back({number, AxisIntegrals(axis.of_cell(cell)), {ends && cell == 0, ends && cell == axis.cells() - 1}});
  }
  return kinds;
}

}  // namespace

/// The splines of a cell, and 1/b of the walls next to it in units of 1/h, 0 where there is none.
template <int Dim>
struct FrictionMatrices<Dim>::Cell {
  CellIntegrals<Dim> axes{};
  std::array<std::array<double, 2>, static_cast<std::size_t>(Dim)> per_slip_length{};
};

template <int Dim>
template <int K>
void FrictionMatrices<Dim>::add(double scale, const Cell& cell) {
  std::vector<Product<Dim>> faces;
  for_each_direction<Dim>([&](auto d) {
    constexpr int D = d();
    for_each_face<Dim, K, D>([&](std::size_t, const Index<Dim>& offset) {
      Product<Dim> face{D, {}};
      for (std::size_t e = 0; e < Dim; ++e) {
        const auto a = static_cast<std::size_t>(offset[e]);
        face.factor[e] = e == D ? AxisIntegrals::along(a) : AxisIntegrals::across(a);
      }
      faces.push_back(face);
    });
  });
  faces_ = faces.size();
  for (const Product<Dim>& f : faces) {
    double bound = 0;
    for (const Product<Dim>& g : faces) {
      // In one order, so that the matrix is symmetric to the last digit.
      const auto& [first, second] = &f < &g ? std::tie(f, g) : std::tie(g, f);
      const double entry = scale * (friction<Dim>(cell.axes, first, second) +
                                    wall_friction<Dim>(cell.axes, first, second, cell.per_slip_length));
      entries_.push_back(entry);
      bound += std::abs(entry);
    }
    bounds_.push_back(bound);
  }
}

template <int Dim>
FrictionMatrices<Dim>::FrictionMatrices(const Grid<Dim>& grid, const Splines<Dim>& splines, const Walls<Dim>& walls) {
  const double scale = std::pow(grid.spacing, Dim - 2);
  std::size_t count = 1;
  std::array<std::vector<Kind>, static_cast<std::size_t>(Dim)> kinds;
  for (std::size_t d = 0; d < Dim; ++d) {
    count *= splines.axis[d].kinds();
    kinds[d] = kinds_of(splines.axis[d]);
    for (std::size_t end = 0; end < 2; ++end)
      per_slip_length_[d][end] = grid.periodic[d] ? 0 : grid.spacing * walls.per_slip_length[d][end];
  }
  place_.assign(count, 0);
  Cell cell;
  std::size_t next = 0;
  const auto add_all = [&](auto&& self, std::size_t d, std::size_t number) -> void {
    for (const Kind& kind : kinds[d]) {
      cell.axes[d] = &kind.integrals;
      for (std::size_t end = 0; end < 2; ++end) {
        cell.per_slip_length[d][end] = kind.at_end[end] ? grid.spacing * walls.per_slip_length[d][end] : 0;
      }
      const std::size_t within = number * splines.axis[d].kinds() + kind.number;
      if (d > 0) {
        self(self, d - 1, within);
        continue;
      }
      place_[within] = next++;
      with_degree(splines.degree, [&](auto degree) { this->template add<degree()>(scale, cell); });
    }
  };
  add_all(add_all, Dim - 1, 0);
}

template class FrictionMatrices<2>;
template class FrictionMatrices<3>;

}  // namespace minamo
