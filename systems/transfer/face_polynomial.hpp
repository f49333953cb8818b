#pragma once
/// \file
/// A velocity that faces carry, within a cell, as a polynomial per component: a few numbers per cell, after which value
/// and derivatives at a point cost less than the weights there.

#include "systems/grid/site_support.hpp"
#include "systems/transfer/jet.hpp"

namespace minamo {

/// Coefficients of the faces of a cell, by direction, at the places of for_each_offset().
template <int Dim, int K>
using FaceCoefficients = std::array<std::array<double, cell_sites<Dim, K>>, static_cast<std::size_t>(Dim)>;

/// at_face(row) is the vector of the faces of a site.
template <int Dim, int K, class AtFace>
[[gnu::always_inline]] inline FaceCoefficients<Dim, K> coefficients(const std::uint32_t* rows, const AtFace& at_face) {
  FaceCoefficients<Dim, K> q;
  for (std::size_t k = 0; k < cell_sites<Dim, K>; ++k) {
    const Vec<Dim> of_site = at_face(rows[k]);
    for (std::size_t d = 0; d < Dim; ++d) q[d][k] = of_site[static_cast<Eigen::Index>(d)];
  }
  return q;
}

/// Splines that faces of direction D have along an axis of a cell.
template <int K, int D>
constexpr std::size_t splines_along(int axis) {
  return static_cast<std::size_t>(axis == D ? K + 1 : K);
}

/// Value and derivatives at x of a polynomial of N coefficients.
template <std::size_t N, class Real>
struct PolynomialJet {
  Real value, first, second;

  template <class Coefficient>
  [[gnu::always_inline]] PolynomialJet(const std::array<Coefficient, N>& c, const Real& x)
      : value(c[N - 1] * x + c[N - 2]), first(Real{} + static_cast<double>(N - 1) * c[N - 1]), second(Real{}) {
    if constexpr (N > 2) {
      first = first * x + static_cast<double>(N - 2) * c[N - 2];
      value = value * x + c[N - 3];
      second = Real{} + static_cast<double>((N - 1) * (N - 2)) * c[N - 1];
    }
    if constexpr (N > 3) {
      first = first * x + static_cast<double>(N - 3) * c[N - 3];
      value = value * x + c[N - 4];
      second = second * x + static_cast<double>((N - 2) * (N - 3)) * c[N - 2];
    }
  }
};

/// (E17), (E18)  q(y) = sum_f N_f(y) q_f and its derivatives, y in the cell of a frame.
template <int Dim, int K>
class FacePolynomials {
 public:
  /// \param rows  of the sites of the cell
  template <class AtFace>
  FacePolynomials(const CellFrame<Dim>& frame, const std::uint32_t* rows, const AtFace& at_face)
      : FacePolynomials(frame, coefficients<Dim, K>(rows, at_face)) {}
  FacePolynomials(const CellFrame<Dim>& frame, const FaceCoefficients<Dim, K>& q)
      : c_(q), per_spacing_(frame.per_spacing) {
    for_each_direction<Dim>(
        [&](auto d) { for_each_direction<Dim>([&](auto axis) { along_axis<d(), axis()>(*frame.splines[axis()]); }); });
  }

  /// Values and derivatives of a component at a point, or at one in every lane.
  template <class Real>
  struct ComponentJet {
    Real value;
    std::array<Real, static_cast<std::size_t>(Dim)> gradient;
    std::array<Real, static_cast<std::size_t>(Dim*(Dim + 1) / 2)> second;
  };

  /// Inline, so that what the caller does not use is not computed.
  template <int D, class Real>
  [[gnu::always_inline]] ComponentJet<Real> at(const std::array<Real, static_cast<std::size_t>(Dim)>& xi) const {
    const double once = per_spacing_;
    const double twice = per_spacing_ * per_spacing_;
    if constexpr (Dim == 2) {
      const Plane<D, Real> of(c_[D].data(), xi);
      return {of.value.value,
              {once * of.slope.value, once * of.value.first},
              {twice * of.bend.value, twice * of.slope.first, twice * of.value.second}};
    } else {
      const auto planes = [&](std::size_t c) { return Plane<D, Real>(c_[D].data() + c * stride * stride, xi); };
      const Stack<D, Real> of(planes, xi[2]);
      return {of.value.value,
              {once * of.slope_x.value, once * of.slope_y.value, once * of.value.first},
              {twice * of.bend_x.value, twice * of.twist.value, twice * of.slope_x.first, twice * of.bend_y.value,
               twice * of.slope_y.first, twice * of.value.second}};
    }
  }

 private:
  static constexpr std::size_t stride = K + 1;

  /// From coefficients of the splines of every line along an axis to those of powers.
  template <int D, int Axis>
  [[gnu::always_inline]] void along_axis(const CellSplines& of) {
    constexpr std::size_t n = splines_along<K, D>(Axis);
    constexpr std::size_t step = power(stride, Axis);
    const auto& spline = Axis == D ? of.along : of.across;
    const auto line = [&](std::size_t start) {
      std::array<double, n> power_of{};
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t a = 0; a < n; ++a) power_of[k] += spline[a][k] * c_[D][start + a * step];
      }
      for (std::size_t k = 0; k < n; ++k) c_[D][start + k * step] = power_of[k];
    };
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
      if (offset[Axis] == 0) line(k);
    });
  }

  /// Along y: of the value, of the first and of the second derivative along x.
  template <int D, class Real>
  struct Plane {
    static constexpr std::size_t nx = splines_along<K, D>(0);
    static constexpr std::size_t ny = splines_along<K, D>(1);
    PolynomialJet<ny, Real> value, slope, bend;

    template <class Place>
    [[gnu::always_inline]] Plane(const double* c, const Place& xi) : Plane(lines(c, xi[0]), xi[1]) {}

   private:
    struct Lines {
      std::array<Real, ny> value, slope, bend;
    };
    [[gnu::always_inline]] Plane(const Lines& x, const Real& y)
        : value(x.value, y), slope(x.slope, y), bend(x.bend, y) {}
    [[gnu::always_inline]] static Lines lines(const double* c, const Real& x) {
      Lines all;
      for (std::size_t b = 0; b < ny; ++b) {
        std::array<double, nx> line;
        std::copy_n(c + b * stride, nx, line.begin());
        const PolynomialJet<nx, Real> of(line, x);
        all.value[b] = of.value;
        all.slope[b] = of.first;
        all.bend[b] = of.second;
      }
      return all;
    }
  };

  /// Along z: of what planes have.
  template <int D, class Real>
  struct Stack {
    static constexpr std::size_t nz = splines_along<K, D>(2);
    PolynomialJet<nz, Real> value, slope_x, slope_y, bend_x, bend_y, twist;

    template <class Planes>
    [[gnu::always_inline]] Stack(const Planes& plane, const Real& z) : Stack(levels(plane), z) {}

   private:
    struct Levels {
      std::array<Real, nz> value, slope_x, slope_y, bend_x, bend_y, twist;
    };
    [[gnu::always_inline]] Stack(const Levels& of, const Real& z)
        : value(of.value, z),
          slope_x(of.slope_x, z),
          slope_y(of.slope_y, z),
          bend_x(of.bend_x, z),
          bend_y(of.bend_y, z),
          twist(of.twist, z) {}
    template <class Planes>
    [[gnu::always_inline]] static Levels levels(const Planes& plane) {
      Levels all;
      for (std::size_t c = 0; c < nz; ++c) {
        const auto of = plane(c);
        all.value[c] = of.value.value;
        all.slope_x[c] = of.slope.value;
        all.slope_y[c] = of.value.first;
        all.bend_x[c] = of.bend.value;
        all.bend_y[c] = of.value.second;
        all.twist[c] = of.slope.first;
      }
      return all;
    }
  };

  FaceCoefficients<Dim, K> c_;  ///< of xi^a eta^b zeta^c at a + (K + 1) (b + (K + 1) c)
  double per_spacing_;
};

/// The jet of a velocity in every lane.
template <int Dim>
struct LaneJet {
  std::array<Four, static_cast<std::size_t>(Dim)> value;
  std::array<std::array<Four, static_cast<std::size_t>(Dim)>, static_cast<std::size_t>(Dim)> gradient;
  std::array<std::array<Four, static_cast<std::size_t>(Dim*(Dim + 1) / 2)>, static_cast<std::size_t>(Dim)> second;

  template <int K>
  [[gnu::always_inline]] LaneJet(const FacePolynomials<Dim, K>& q,
                                 const std::array<Four, static_cast<std::size_t>(Dim)>& xi) {
    for_each_direction<Dim>([&](auto d) {
      const auto jet = q.template at<d(), Four>(xi);
      value[d()] = jet.value;
      gradient[d()] = jet.gradient;
      second[d()] = jet.second;
    });
  }
  [[gnu::always_inline]] Jet<Dim> of(std::size_t lane) const {
    Jet<Dim> jet;
    for (int d = 0; d < Dim; ++d) {
      const auto row = static_cast<std::size_t>(d);
      jet.value[d] = value[row][lane];
      for (int e = 0; e < Dim; ++e) jet.gradient(d, e) = gradient[row][static_cast<std::size_t>(e)][lane];
      for (int k = 0; k < jet.second.cols(); ++k) jet.second(d, k) = second[row][static_cast<std::size_t>(k)][lane];
    }
    return jet;
  }
};

}  // namespace minamo
