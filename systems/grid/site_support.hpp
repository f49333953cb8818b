#pragma once
/// \file
/// The sites of a cell, the weights of a point on its faces and multipliers, and the loops that the kernels share. All
/// is a template in the dimension and the degree K: a cell has (K + 1)^d sites, of them (K + 1) K^(d-1) faces of every
/// direction and K^d multipliers.

#include "components/cells.hpp"
#include "components/staggered.hpp"
#include "systems/grid/node_support.hpp"
#include "systems/grid/splines.hpp"

#include <utility>

namespace minamo {

/// Sites of a cell.
template <int Dim, int K>
inline constexpr std::size_t cell_sites = power(K + 1, Dim);

/// Calls f(std::integral_constant<int, d>) for every direction.
template <int Dim, class F>
[[gnu::always_inline]] inline void for_each_direction(const F& f) {
  f(std::integral_constant<int, 0>());
  f(std::integral_constant<int, 1>());
  if constexpr (Dim == 3) f(std::integral_constant<int, 2>());
}

/// Calls body(k, offset) for the sites offset (0 ... n_d - 1 per direction) of a cell, k their place among all, x
/// fastest.
template <int Dim, int K, int Nx, int Ny, int Nz, class Body>
[[gnu::always_inline]] inline void for_each_offset(const Body& body) {
  constexpr int stride = K + 1;
  if constexpr (Dim == 3) {
    for (int c = 0; c < Nz; ++c) {
      for (int b = 0; b < Ny; ++b) {
        for (int a = 0; a < Nx; ++a) body(static_cast<std::size_t>(a + stride * (b + stride * c)), Index<3>{a, b, c});
      }
    }
  } else {
    for (int b = 0; b < Ny; ++b) {
      for (int a = 0; a < Nx; ++a) body(static_cast<std::size_t>(a + stride * b), Index<2>{a, b});
    }
  }
}

/// The same for the faces of direction D of a cell.
template <int Dim, int K, int D, class Body>
[[gnu::always_inline]] inline void for_each_face(const Body& body) {
  for_each_offset<Dim, K, D == 0 ? K + 1 : K, D == 1 ? K + 1 : K, D == 2 ? K + 1 : K>(body);
}

/// For its multipliers.
template <int Dim, int K, class Body>
[[gnu::always_inline]] inline void for_each_multiplier(const Body& body) {
  for_each_offset<Dim, K, K, K, K>(body);
}

/// The least of a column of multipliers over those of a cell, at most 1; `rows` are those of its sites.
template <int Dim, int K>
double least_of_multipliers(const std::uint32_t* rows, std::span<const double> phi) {
  double least = 1;
  for_each_multiplier<Dim, K>([&](std::size_t k, const Index<Dim>&) { least = std::min(least, phi[rows[k]]); });
  return least;
}

/// For all its sites.
template <int Dim, int K, class Body>
[[gnu::always_inline]] inline void for_each_site(const Body& body) {
  for_each_offset<Dim, K, K + 1, K + 1, K + 1>(body);
}

/// The cell of a point, and where in it the point is, 0 ... 1. Points outside the box count to the nearest cell.
struct AxisPlace {
  int cell;
  double xi;
};
inline AxisPlace axis_place(const SplineAxis& axis, double r) {
  int cell = static_cast<int>(r);
  if (r < cell) --cell;
  if (axis.periodic()) {
    const double xi = r - cell;
    const int wrapped = cell % axis.cells();
    return {wrapped < 0 ? wrapped + axis.cells() : wrapped, xi};
  }
  cell = std::clamp(cell, 0, axis.cells() - 1);
  return {cell, std::clamp(r - cell, 0.0, 1.0)};
}

template <int Dim>
Index<Dim> cell_around(const Grid<Dim>& grid, const Splines<Dim>& splines, const Vec<Dim>& x) {
  const double per_spacing = 1 / grid.spacing;
  Index<Dim> cell;
  for (int d = 0; d < Dim; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    cell[axis] = axis_place(splines.axis[axis], (x[d] - grid.low[d]) * per_spacing).cell;
  }
  return cell;
}

/// A coordinate of a place, be it a vector or one with a number per lane.
template <int Dim>
[[gnu::always_inline]] inline double coordinate(const Vec<Dim>& xi, std::size_t d) {
  return xi[static_cast<Eigen::Index>(d)];
}
template <class Real, std::size_t Dim>
[[gnu::always_inline]] inline const Real& coordinate(const std::array<Real, Dim>& xi, std::size_t d) {
  return xi[d];
}

/// A cell: the splines in it, and where it is.
template <int Dim>
struct CellFrame {
  std::array<const CellSplines*, static_cast<std::size_t>(Dim)> splines;
  Vec<Dim> low;        ///< low corner [m]
  double spacing;      ///< h [m]
  double per_spacing;  ///< 1/h [1/m]
  Vec<Dim> period;     ///< length of periodic axes, 0 along others, in units of h

  CellFrame(const Grid<Dim>& grid, const Splines<Dim>& all, const Index<Dim>& cell)
      : low(grid.position(cell)), spacing(grid.spacing), per_spacing(1 / grid.spacing) {
    for (std::size_t d = 0; d < Dim; ++d) {
      splines[d] = &all.axis[d].of_cell(cell[d]);
      period[static_cast<Eigen::Index>(d)] = all.axis[d].periodic() ? all.axis[d].cells() : 0;
    }
  }
  /// From the low corner in units of h, for a point that lies in the cell or, along a periodic axis, in its image.
  Vec<Dim> local(const Vec<Dim>& y) const {
    Vec<Dim> xi = (y - low) * per_spacing;
    for (int d = 0; d < Dim; ++d) {
      if (xi[d] < -0.5) xi[d] += period[d];
      if (xi[d] > 1.5) xi[d] -= period[d];
      xi[d] = std::clamp(xi[d], 0.0, 1.0);
    }
    return xi;
  }
  /// Greville point of a face of direction D, from the low corner of the cell in units of h.
  template <int D>
  double face_place(int axis, int a) const {
    const CellSplines& of = *splines[static_cast<std::size_t>(axis)];
    return axis == D ? of.along_place[static_cast<std::size_t>(a)] : of.across_place[static_cast<std::size_t>(a)];
  }
};

/// Value at x of a polynomial of a degree of at least 1, its coefficients from the constant on.
template <int Degree, class Real>
[[gnu::always_inline]] inline Real polynomial(const CellSplines::Polynomial& c, const Real& x) {
  Real value = c[Degree] * x + c[Degree - 1];
  for (int k = Degree - 2; k >= 0; --k) value = value * x + c[static_cast<std::size_t>(k)];
  return value;
}

/// Its derivative.
template <int Degree, class Real>
[[gnu::always_inline]] inline Real slope_of_polynomial(const CellSplines::Polynomial& c, const Real& x) {
  Real value = Real{} + Degree * c[Degree];
  for (int k = Degree - 1; k >= 1; --k) value = value * x + k * c[static_cast<std::size_t>(k)];
  return value;
}

/// A number for every spline of a cell.
template <int Dim, int K, class Real>
struct SplineNumbers {
  std::array<std::array<Real, K + 1>, static_cast<std::size_t>(Dim)> along;
  std::array<std::array<Real, K>, static_cast<std::size_t>(Dim)> across;

  /// Of the splines that faces of direction D have along an axis.
  template <int D, int Axis>
  [[gnu::always_inline]] const auto& of() const {
    if constexpr (Axis == D) {
      return along[Axis];
    } else {
      return across[Axis];
    }
  }
};

/// Values of the splines of a cell at a point, or at one in every lane.
template <int Dim, int K, class Real = double>
struct SplineWeights : SplineNumbers<Dim, K, Real> {
  using SplineNumbers<Dim, K, Real>::along;
  using SplineNumbers<Dim, K, Real>::across;

  template <class Place>
  SplineWeights(const CellFrame<Dim>& frame, const Place& xi) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const Real x = coordinate(xi, d);
      const CellSplines& of = *frame.splines[d];
      for (std::size_t a = 0; a < K + 1; ++a) along[d][a] = polynomial<K>(of.along[a], x);
      for (std::size_t a = 0; a < K; ++a) across[d][a] = polynomial<K - 1>(of.across[a], x);
    }
  }
  /// N_f for a face of direction D.
  template <int D>
  [[gnu::always_inline]] Real face(const Index<Dim>& offset) const {
    Real product = factor<D>(0, offset[0]) * factor<D>(1, offset[1]);
    if constexpr (Dim == 3) product *= factor<D>(2, offset[2]);
    return product;
  }
  [[gnu::always_inline]] Real multiplier(const Index<Dim>& offset) const {
    Real product = across[0][static_cast<std::size_t>(offset[0])];
    for (std::size_t d = 1; d < Dim; ++d) product *= across[d][static_cast<std::size_t>(offset[d])];
    return product;
  }
  template <int D>
  [[gnu::always_inline]] Real factor(int axis, int a) const {
    const auto d = static_cast<std::size_t>(axis);
    return axis == D ? along[d][static_cast<std::size_t>(a)] : across[d][static_cast<std::size_t>(a)];
  }
};

/// Derivatives of the splines of a cell at a point, or at one in every lane, per m.
template <int Dim, int K, class Real = double>
struct SplineSlopes : SplineNumbers<Dim, K, Real> {
  using SplineNumbers<Dim, K, Real>::along;
  using SplineNumbers<Dim, K, Real>::across;

  template <class Place>
  SplineSlopes(const CellFrame<Dim>& frame, const Place& xi) {
    for (std::size_t d = 0; d < Dim; ++d) {
      const Real x = coordinate(xi, d);
      const CellSplines& of = *frame.splines[d];
      for (std::size_t a = 0; a < K + 1; ++a) along[d][a] = frame.per_spacing * slope_of_polynomial<K>(of.along[a], x);
      for (std::size_t a = 0; a < K; ++a) {
        across[d][a] = frame.per_spacing * slope_of_polynomial<K - 1>(of.across[a], x);
      }
    }
  }
};

}  // namespace minamo
