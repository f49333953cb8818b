#include "systems/grid/site_places.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

template <int Dim>
double SitePlaces<Dim>::along(std::size_t d, int i) const {
  const SplineAxis& axis = splines_.axis[d];
  const int cell = axis.periodic() ? i : std::clamp(i - 1, 0, axis.cells() - 1);
  const int kind_of = axis.periodic() ? i % axis.cells() : cell;
  const double from_low = axis.of_cell(kind_of).along_place[static_cast<std::size_t>(i - cell)];
  return grid_.low[static_cast<Eigen::Index>(d)] + grid_.spacing * (cell + from_low);
}

template <int Dim>
Bounds<Dim> SitePlaces<Dim>::box(const Index<Dim>& site) const {
  Bounds<Dim> box;
  for (std::size_t d = 0; d < Dim; ++d) {
    const auto axis = static_cast<Eigen::Index>(d);
    box.low[axis] = along(d, site[d]);
    const bool has_multiplier = site[d] < splines_.axis[d].multipliers();
    box.high[axis] = box.low[axis] + (has_multiplier ? grid_.spacing * splines_.axis[d].width(site[d]) : 0);
  }
  return box;
}

template <int Dim>
Vec<Dim> SitePlaces<Dim>::middle(const Index<Dim>& site) const {
  const Bounds<Dim> around = box(site);
  return 0.5 * (around.low + around.high);
}

template <int Dim>
Vec<Dim> SitePlaces<Dim>::face(const Index<Dim>& site, std::size_t d) const {
  const Bounds<Dim> around = box(site);
  Vec<Dim> x = 0.5 * (around.low + around.high);
  x[static_cast<Eigen::Index>(d)] = around.low[static_cast<Eigen::Index>(d)];
  return x;
}

template <int Dim>
double SitePlaces<Dim>::reach() const {
  return 0.5 * grid_.spacing * (splines_.degree + 1) * std::sqrt(static_cast<double>(Dim));
}

template class SitePlaces<2>;
template class SitePlaces<3>;

}  // namespace minamo
