#include "systems/surface_tension/surface_lattice.hpp"

#include <algorithm>

namespace minamo {

int SurfaceAxis::knot(int site, int k) const {
  const int at = site - 2 + k;
  return periodic_ ? at : std::clamp(at, 0, cells_);
}

double SurfaceAxis::place(int node) const {
  if (is_low_wall(node)) return 0;
  if (is_high_wall(node)) return cells_;
  const int site = periodic_ ? node : node - 1;
  int sum = 0;
  for (int k = 0; k < 4; ++k) sum += knot(site, k);
  return 0.25 * sum;
}

double SurfaceAxis::integral(int site) const { return (knot(site, 3) - knot(site, 0)) / 3.0; }

template <int Dim>
SurfaceLattice<Dim>::SurfaceLattice(const Grid<Dim>& grid, const StaggeredIndex<Dim>& rows)
    : low_(grid.low), spacing_(grid.spacing), rows_(rows) {
  for (std::size_t d = 0; d < Dim; ++d) axis_[d] = SurfaceAxis(grid.cells[d], grid.periodic[d]);
}

template <int Dim>
bool SurfaceLattice<Dim>::has(const Index<Dim>& site) const {
  for (std::size_t d = 0; d < Dim; ++d) {
    if (site[d] >= axis_[d].sites()) return false;
  }
  return true;
}

template <int Dim>
double SurfaceLattice<Dim>::capacity(const Index<Dim>& site) const {
  double product = 1;
  for (std::size_t d = 0; d < Dim; ++d) product *= spacing_ * axis_[d].integral(site[d]);
  return product;
}

template <int Dim>
bool SurfaceLattice<Dim>::is_site(const Index<Dim>& node) const {
  for (std::size_t d = 0; d < Dim; ++d) {
    if (axis_[d].is_on_wall(node[d])) return false;
  }
  return true;
}

template <int Dim>
Vec<Dim> SurfaceLattice<Dim>::place(const Index<Dim>& node) const {
  Vec<Dim> x = low_;
  for (std::size_t d = 0; d < Dim; ++d) x[static_cast<Eigen::Index>(d)] += spacing_ * axis_[d].place(node[d]);
  return x;
}

template <int Dim>
std::optional<std::uint32_t> SurfaceLattice<Dim>::row(const Index<Dim>& node) const {
  return rows_.find(site_of(node));
}

template class SurfaceLattice<2>;
template class SurfaceLattice<3>;

}  // namespace minamo
