#pragma once
/// \file
/// (E76) The splines of the conforming discretization, an axis at a time: B-splines of degree K on the cells of the
/// axis, for the velocity along it, and of degree K - 1, for the velocities across it and the multipliers. Between
/// walls knots are open, so that the first and last spline alone meet the wall; along a periodic axis they go around.
///
/// Differentiation maps the one family onto the other by differences of coefficients,
/// d/dx sum_i u_i N^K_i = sum_j (u_{j+1} - u_j)/w_j N^{K-1}_j, w_j the distance of the Greville points of the splines j
/// and j + 1. J. A. Evans, T. J. R. Hughes, J. Comput. Phys. 241 (2013) 141; A. Buffa, J. Rivas, G. Sangalli,
/// R. Vazquez, SIAM J. Numer. Anal. 49 (2011) 818.

#include "components/grid.hpp"

#include <optional>
#include <vector>

namespace minamo {

/// The least and the largest degree K.
inline constexpr int least_degree = 2;
inline constexpr int largest_degree = 3;

/// The splines that are not zero in one cell: as polynomials of xi, 0 ... 1 across the cell, and where they are.
struct CellSplines {
  static constexpr std::size_t most = largest_degree + 1;
  using Polynomial = std::array<double, most>;  ///< coefficients of xi^0, xi^1, ...

  std::array<Polynomial, most> along{};   ///< the K + 1 of degree K
  std::array<Polynomial, most> across{};  ///< the K of degree K - 1
  /// Greville points from the low end of the cell, in units of h: sum_i N_i g_i = xi.
  std::array<double, most> along_place{};
  std::array<double, most> across_place{};
  /// sum_a N_a (g_a - xi)^2 = sum_a N_a g_a^2 - xi^2 of the splines of degree K - 1: D of (E30) in units of h^2.
  Polynomial across_moment{};
  /// Spread of the inner knots of a spline around its Greville point, s_i, in units of h^2: sum_i N_i (g_i^2 - s_i) =
  /// xi^2.
  std::array<double, most> along_spread{};
  std::array<double, most> across_spread{};
  /// Integrals over the cell, in units of h.
  std::array<double, most> along_integral{};
  std::array<double, most> across_integral{};
};

/// The spline of a multiplier along an axis as a sum of truncated powers, sum_t jump_t (x - at_t)_+^power_t/power_t!,
/// x from its Greville point in units of h, divided by its integral.
struct TruncatedPowers {
  struct Term {
    double at;
    double jump;  ///< of the derivative of order `power` at a knot
    int power;
  };
  std::array<Term, static_cast<std::size_t>(largest_degree + 1)> terms{};
  std::size_t count = 0;
  /// int x^k/k! of the spline: in 3-D two axes raise a power by the degree each, and the mean depth begins at one.
  std::array<double, static_cast<std::size_t>(2 * largest_degree + 2)> moments{};
};

/// The splines of an axis. Spline number c + a is the a-th of those in cell c.
class SplineAxis {
 public:
  SplineAxis() = default;
  /// \pre cells >= degree + 2 along a periodic axis
  SplineAxis(int degree, int cells, bool periodic);

  int cells() const { return cells_; }
  bool periodic() const { return periodic_; }
  /// Sites of the staggered grid: splines of degree K.
  int sites() const { return periodic_ ? cells_ : cells_ + degree_; }
  /// Splines of degree K - 1: multipliers.
  int multipliers() const { return periodic_ ? cells_ : cells_ + degree_ - 1; }
  /// The site some steps away from one, if there is one. \pre fewer steps than there are sites
  std::optional<int> site_at(int site, int steps) const {
    const int count = sites();
    int at = site + steps;
    if (periodic_) at += at < 0 ? count : at >= count ? -count : 0;
    return at < 0 || at >= count ? std::nullopt : std::optional(at);
  }
  int wrapped(int site) const { return periodic_ && site >= cells_ ? site - cells_ : site; }

  const CellSplines& of_cell(int cell) const { return kinds_[kind_of(cell)]; }
  /// Cells of one kind have the same splines.
  std::size_t kinds() const { return kinds_.size(); }
  std::size_t kind_of(int cell) const {
    if (periodic_) return 0;
    const int from_low = cell < degree_ ? cell : degree_ - 1;
    const int from_high = cells_ - 1 - cell < degree_ ? cells_ - 1 - cell : degree_ - 1;
    return static_cast<std::size_t>(from_low * degree_ + from_high);
  }
  /// The cells that all have the same splines, from the first to one behind the last.
  std::array<int, 2> inner_cells() const {
    if (periodic_) return {0, cells_};
    return {degree_ - 1, cells_ - degree_ + 1};
  }
  const TruncatedPowers& powers_of_multiplier(int j) const { return powers_[multiplier_kind(j)]; }
  /// Greville point of a multiplier from the low end of the axis, in units of h.
  double place(int j) const {
    const int cell = j < cells_ ? j : cells_ - 1;
    return cell + of_cell(cell).across_place[static_cast<std::size_t>(j - cell)];
  }
  /// w_j, which is also the integral of the spline j of degree K - 1, in units of h.
  double width(int j) const { return static_cast<double>(support(j, degree_ - 1)) / degree_; }
  /// Integral of the spline i of degree K, in units of h.
  double integral(int i) const { return static_cast<double>(support(i, degree_)) / (degree_ + 1); }

 private:
  /// Multipliers of one kind have the same spline.
  std::size_t multiplier_kind(int j) const {
    if (periodic_) return 0;
    const int from_low = j < degree_ ? j : degree_ - 1;
    const int from_high = multipliers() - 1 - j < degree_ ? multipliers() - 1 - j : degree_ - 1;
    return static_cast<std::size_t>(from_low * degree_ + from_high);
  }
  TruncatedPowers truncated_powers(int j) const;

  /// How many cells the spline i of a degree covers.
  int support(int i, int degree) const {
    if (periodic_) return degree + 1;
    const int low = i - degree > 0 ? i - degree : 0;
    const int high = i + 1 < cells_ ? i + 1 : cells_;
    return high - low;
  }

  int degree_ = least_degree;
  int cells_ = 0;
  bool periodic_ = false;
  std::vector<CellSplines> kinds_;       ///< by distance of the cell from the low and from the high end, up to K - 1
  std::vector<TruncatedPowers> powers_;  ///< by distance of the multiplier from the ends, up to K - 1
};

/// The splines of all axes.
template <int Dim>
struct Splines {
  int degree = least_degree;
  std::array<SplineAxis, static_cast<std::size_t>(Dim)> axis;
  static constexpr ComponentInfo info{"splines", "N", "1", Lifetime::constant};

  Index<Dim> sites() const {
    Index<Dim> count;
    for (std::size_t d = 0; d < Dim; ++d) count[d] = axis[d].sites();
    return count;
  }
  /// The site at an offset from the first one of a cell.
  Index<Dim> site(const Index<Dim>& cell, Index<Dim> offset) const {
    for (std::size_t d = 0; d < Dim; ++d) offset[d] = axis[d].wrapped(cell[d] + offset[d]);
    return offset;
  }
  /// The site some steps away from one, if there is one. \pre fewer steps than an axis has sites
  std::optional<Index<Dim>> site_at(Index<Dim> site, const Index<Dim>& steps) const {
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto at = axis[d].site_at(site[d], steps[d]);
      if (!at) return {};
      site[d] = *at;
    }
    return site;
  }
  /// Steps from a site to another, the shorter way around periodic axes.
  Index<Dim> steps(const Index<Dim>& from, const Index<Dim>& to) const {
    Index<Dim> steps;
    for (std::size_t d = 0; d < Dim; ++d) {
      const int count = axis[d].sites();
      steps[d] = to[d] - from[d];
      if (axis[d].periodic() && 2 * std::abs(steps[d]) > count) steps[d] -= steps[d] > 0 ? count : -count;
    }
    return steps;
  }
  /// From a multiplier to the one some steps away, in units of h.
  Vec<Dim> offset(const Index<Dim>& site, const Index<Dim>& steps) const {
    Vec<Dim> x;
    for (std::size_t d = 0; d < Dim; ++d)
      x[static_cast<Eigen::Index>(d)] =
          axis[d].periodic() ? steps[d] : axis[d].place(site[d] + steps[d]) - axis[d].place(site[d]);
    return x;
  }
  /// Product of the widths of a multiplier, w_l/h^d. [1]
  double widths(const Index<Dim>& site) const {
    double product = 1;
    for (std::size_t d = 0; d < Dim; ++d) product *= axis[d].width(site[d]);
    return product;
  }
  /// Whether there is a multiplier at a site: along axes with walls the last site has none.
  bool has_multiplier(const Index<Dim>& site) const {
    for (std::size_t d = 0; d < Dim; ++d) {
      if (site[d] >= axis[d].multipliers()) return false;
    }
    return true;
  }
  /// Whether the multipliers end at a site towards a side, 2 d below and 2 d + 1 above along axis d: at a wall.
  bool ends_at(const Index<Dim>& site, std::size_t side) const {
    const SplineAxis& along = axis[side / 2];
    return !along.periodic() && site[side / 2] == (side % 2 == 0 ? 0 : along.multipliers() - 1);
  }
  /// Integral of the function of a face of direction `d`, in units of h^Dim.
  double face_integral(const Index<Dim>& site, std::size_t d) const {
    double product = axis[d].integral(site[d]);
    for (std::size_t e = 0; e < Dim; ++e) {
      if (e != d) product *= axis[e].width(site[e]);
    }
    return product;
  }
  /// Whether there is a face of direction d at a site.
  bool has_face(const Index<Dim>& site, std::size_t d) const {
    for (std::size_t e = 0; e < Dim; ++e) {
      if (e != d && site[e] >= axis[e].multipliers()) return false;
    }
    return true;
  }
};

template <int Dim>
Splines<Dim> make_splines(const Grid<Dim>& grid, int degree) {
  Splines<Dim> splines;
  splines.degree = degree;
  for (std::size_t d = 0; d < Dim; ++d) splines.axis[d] = SplineAxis(degree, grid.cells[d], grid.periodic[d]);
  return splines;
}

/// Calls f(std::integral_constant<int, K>) for the degree K.
template <class F>
void with_degree(int degree, const F& f) {
  if (degree == 2) {
    f(std::integral_constant<int, 2>());
  } else {
    f(std::integral_constant<int, 3>());
  }
}

}  // namespace minamo
