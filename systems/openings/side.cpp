#include "systems/openings/side.hpp"

#include <cmath>
#include <optional>

namespace minamo {

namespace {

/// Greville point of the spline i along an axis, of the degree K or, across, K - 1. [h from the low end]
double greville(const SplineAxis& axis, int degree, bool across, int i) {
  const int count = across ? degree : degree + 1;
  const int cell = axis.periodic() ? i : std::clamp(i - 1, 0, axis.cells() - 1);
  const CellSplines& of = axis.of_cell(axis.periodic() ? i % axis.cells() : cell);
  const int a = std::clamp(i - cell, 0, count - 1);
  const auto& places = across ? of.across_place : of.along_place;
  return cell + places[static_cast<std::size_t>(a)];
}

}  // namespace

template <int Dim>
std::size_t Side<Dim>::count(std::size_t d) const {
  std::size_t count = 1;
  for (std::size_t e = 0; e < Dim; ++e) count *= e == axis_ ? 1 : static_cast<std::size_t>(along(e, d));
  return count;
}

template <int Dim>
std::size_t Side<Dim>::index(const Index<Dim>& site, std::size_t d) const {
  std::size_t index = 0;
  for (std::size_t e = Dim; e-- > 0;) {
    if (e != axis_) index = index * static_cast<std::size_t>(along(e, d)) + static_cast<std::size_t>(site[e]);
  }
  return index;
}

template <int Dim>
Index<Dim> Side<Dim>::site(std::size_t index, std::size_t d) const {
  Index<Dim> site;
  site[axis_] = outermost(d);
  for (std::size_t e = 0; e < Dim; ++e) {
    if (e == axis_) continue;
    const auto count = static_cast<std::size_t>(along(e, d));
    site[e] = static_cast<int>(index % count);
    index /= count;
  }
  return site;
}

template <int Dim>
Vec<Dim> Side<Dim>::place(const Index<Dim>& site, std::size_t d) const {
  Vec<Dim> x;
  for (std::size_t e = 0; e < Dim; ++e) {
    const auto axis = static_cast<Eigen::Index>(e);
    x[axis] = e == axis_
                  ? plane()
                  : grid_->low[axis] + grid_->spacing * greville(splines_->axis[e], splines_->degree, e != d, site[e]);
  }
  return x;
}

template <int Dim>
double Side<Dim>::area(const Index<Dim>& site) const {
  double area = 1;
  for (std::size_t e = 0; e < Dim; ++e) {
    if (e != axis_) area *= grid_->spacing * splines_->axis[e].width(site[e]);
  }
  return area;
}

template <int Dim>
typename Side<Dim>::Nearest Side<Dim>::nearest(const Vec<Dim>& x) const {
  // Lattices with a particle in the middle of a cell have it as near to both of its faces as rounding tells.
  constexpr double rounding = 1e-9;  // [h]
  std::array<Index<Dim>, power(2, Dim - 1)> site;
  site[0][axis_] = outermost(axis_);
  std::size_t count = 1;
  for (std::size_t e = 0; e < Dim; ++e) {
    if (e == axis_) continue;
    const auto axis = static_cast<Eigen::Index>(e);
    const AxisPlace at = axis_place(splines_->axis[e], (x[axis] - grid_->low[axis]) / grid_->spacing);
    const CellSplines& of = splines_->axis[e].of_cell(at.cell);
    const auto distance = [&](int a) { return std::abs(of.across_place[static_cast<std::size_t>(a)] - at.xi); };
    int best = 0;
    for (int a = 1; a < splines_->degree; ++a) {
      if (distance(a) < distance(best)) best = a;
    }
    std::optional<int> as_near;
    for (int a = 0; a < splines_->degree; ++a) {
      if (a != best && distance(a) <= distance(best) + rounding) as_near = a;
    }
    for (std::size_t k = 0; k < count; ++k) site[k][e] = splines_->axis[e].wrapped(at.cell + best);
    if (!as_near) continue;
    for (std::size_t k = 0; k < count; ++k) {
      site[count + k] = site[k];
      site[count + k][e] = splines_->axis[e].wrapped(at.cell + *as_near);
    }
    count *= 2;
  }
  Nearest nearest{{}, count};
  for (std::size_t k = 0; k < count; ++k) nearest.index[k] = index(site[k], axis_);
  return nearest;
}

template <int Dim>
typename Side<Dim>::Jet Side<Dim>::at(const opening::SideVelocity<Dim>& velocity, const Vec<Dim>& x) const {
  Jet jet{Vec<Dim>::Zero(), Mat<Dim>::Zero()};
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto row = static_cast<Eigen::Index>(d);
    for_each_spline(d, x, [&](const Index<Dim>& site, double weight, const Vec<Dim>& slopes) {
      const double of = velocity.of[d][index(site, d)];
      jet.value[row] += weight * of;
      jet.gradient.row(row) += of * slopes.transpose();
    });
  }
  const auto across = static_cast<Eigen::Index>(axis_);
  jet.gradient(across, across) = 0;
  jet.gradient(across, across) = -jet.gradient.trace();
  return jet;
}

template <int Dim>
Vec<Dim> Side<Dim>::within(Vec<Dim> x) const {
  for (std::size_t e = 0; e < Dim; ++e) {
    const auto axis = static_cast<Eigen::Index>(e);
    if (e == axis_) {
      x[axis] = plane();
    } else if (!grid_->periodic[e]) {
      x[axis] = std::clamp(x[axis], grid_->low[axis], grid_->high[axis]);
    }
  }
  return x;
}

template class Side<2>;
template class Side<3>;

}  // namespace minamo
