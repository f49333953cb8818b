#pragma once
/// \file
/// A side of the box on the staggered grid. Of the splines across a side only the outermost is not zero on it, and it
/// is 1 there, so that a velocity on a side is a sum over the splines along it alone.

#include "components/openings.hpp"
#include "systems/grid/site_support.hpp"

namespace minamo {

/// 2 d for the low and 2 d + 1 for the high side along axis d, as openings and neighbours count them.
inline double inward_of(std::size_t side) { return side % 2 == 0 ? 1 : -1; }

/// What is nearer to a face than to others along an axis of its side, within the box. [m]
struct FaceRange {
  double low;
  double high;
};
template <int Dim>
FaceRange range_of_face(const Grid<Dim>& grid, std::size_t e, const Vec<Dim>& face) {
  const auto d = static_cast<Eigen::Index>(e);
  FaceRange range{face[d] - grid.spacing / 2, face[d] + grid.spacing / 2};
  if (!grid.periodic[e]) range = {std::max(range.low, grid.low[d]), std::min(range.high, grid.high[d])};
  return range;
}

template <int Dim>
class Side {
 public:
  Side(const Grid<Dim>& grid, const Splines<Dim>& splines, std::size_t side)
      : grid_(&grid), splines_(&splines), axis_(side / 2), side_(side) {}

  std::size_t axis() const { return axis_; }
  /// Direction into the box along the axis, 1 or -1.
  double inward() const { return inward_of(side_); }
  /// Where the side lies on its axis. [m]
  double plane() const {
    const auto d = static_cast<Eigen::Index>(axis_);
    return side_ % 2 == 0 ? grid_->low[d] : grid_->high[d];
  }

  /// Whether a face of direction d lies on the side.
  bool holds(const Index<Dim>& site, std::size_t d) const { return site[axis_] == outermost(d); }
  /// How many faces of direction d lie on it.
  std::size_t count(std::size_t d) const;
  /// Place of a face among them, x fastest.
  std::size_t index(const Index<Dim>& site, std::size_t d) const;
  Index<Dim> site(std::size_t index, std::size_t d) const;
  /// Greville point of a face on the side. [m]
  Vec<Dim> place(const Index<Dim>& site, std::size_t d) const;
  /// What its spline integrates to over the side, of a face across. [m^2; m in 2-D]
  double area(const Index<Dim>& site) const;
  /// The faces across whose Greville points are nearest to a point: half way between two, whatever rounding says, both.
  struct Nearest {
    std::array<std::size_t, power(2, Dim - 1)> index;
    std::size_t count;
  };
  Nearest nearest(const Vec<Dim>& x) const;

  /// Velocity at a point of the side, and its derivatives along the side; that across follows from the divergence, the
  /// others are zero.
  struct Jet {
    Vec<Dim> value;
    Mat<Dim> gradient;
  };
  Jet at(const opening::SideVelocity<Dim>& velocity, const Vec<Dim>& x) const;

  /// Calls use(index of a face across, weight of its spline) for a point of the side.
  template <class Use>
  void for_each_across(const Vec<Dim>& x, const Use& use) const {
    for_each_spline(axis_, x,
                    [&](const Index<Dim>& site, double weight, const Vec<Dim>&) { use(index(site, axis_), weight); });
  }
  /// A point of the side within the box, its image along periodic axes. [m]
  Vec<Dim> within(Vec<Dim> x) const;

 private:
  int outermost(std::size_t d) const {
    const SplineAxis& of = splines_->axis[axis_];
    if (side_ % 2 == 0) return 0;
    return (d == axis_ ? of.sites() : of.multipliers()) - 1;
  }
  int along(std::size_t e, std::size_t d) const {
    return e == d ? splines_->axis[e].sites() : splines_->axis[e].multipliers();
  }
  /// Calls use(site, weight, slopes along the side) for the faces of direction d that are not zero at x.
  template <class Use>
  void for_each_spline(std::size_t d, const Vec<Dim>& x, const Use& use) const;

  const Grid<Dim>* grid_;
  const Splines<Dim>* splines_;
  std::size_t axis_;
  std::size_t side_;
};

template <int Dim>
template <class Use>
void Side<Dim>::for_each_spline(std::size_t d, const Vec<Dim>& x, const Use& use) const {
  constexpr int degree_of_polynomial = largest_degree;
  std::array<AxisPlace, static_cast<std::size_t>(Dim)> at{};
  Index<Dim> count;
  for (std::size_t e = 0; e < Dim; ++e) {
    count[e] = e == axis_ ? 1 : e == d ? splines_->degree + 1 : splines_->degree;
    const auto axis = static_cast<Eigen::Index>(e);
    if (e != axis_) at[e] = axis_place(splines_->axis[e], (x[axis] - grid_->low[axis]) / grid_->spacing);
  }
  Index<Dim> a{};
  for (;;) {
    Index<Dim> site;
    std::array<double, static_cast<std::size_t>(Dim)> value;
    std::array<double, static_cast<std::size_t>(Dim)> slope{};
    for (std::size_t e = 0; e < Dim; ++e) {
      site[e] = e == axis_ ? outermost(d) : splines_->axis[e].wrapped(at[e].cell + a[e]);
      value[e] = 1;
      if (e == axis_) continue;
      const CellSplines& of = splines_->axis[e].of_cell(at[e].cell);
      const auto& spline = (e == d ? of.along : of.across)[static_cast<std::size_t>(a[e])];
      value[e] = polynomial<degree_of_polynomial>(spline, at[e].xi);
      slope[e] = slope_of_polynomial<degree_of_polynomial>(spline, at[e].xi) / grid_->spacing;
    }
    double weight = 1;
    Vec<Dim> slopes;
    for (std::size_t e = 0; e < Dim; ++e) {
      weight *= value[e];
      double product = slope[e];
      for (std::size_t g = 0; g < Dim; ++g) product *= g == e ? 1 : value[g];
      slopes[static_cast<Eigen::Index>(e)] = product;
    }
    use(site, weight, slopes);
    std::size_t e = 0;
    while (e < Dim && ++a[e] == count[e]) a[e++] = 0;
    if (e == Dim) return;
  }
}

}  // namespace minamo
