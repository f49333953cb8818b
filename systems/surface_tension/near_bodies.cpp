#include "systems/surface_tension/near_bodies.hpp"

#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/quadratic_spline.hpp"
#include "systems/grid/sites_around.hpp"
#include "systems/linear/dense.hpp"
#include "systems/surface_tension/free_surface.hpp"
#include "systems/surface_tension/surface_lattice.hpp"

#include <cmath>

namespace minamo {

namespace {

/// Bodies farther away than that do not count. [h]
constexpr double far_away = 3;
/// With less of it open, a spline tells nothing of the liquid. [1]
constexpr double telling_from = 0.05;
/// A site counts as much as those around it together: less and drops of 30 degrees swing, more and their surface is
/// wavy. [h^2]
constexpr double own_share = 0.5;

/// Integral of s times the quadratic B-spline from t >= 0 on.
double moment_beyond(double t) {
  const double rest = quadratic_spline_reach - t;
  if (t < 0.5) return 0.203125 - t * t * (0.375 - 0.25 * t * t);
  return rest > 0 ? rest * rest * rest * (0.25 - 0.125 * rest) : 0;
}

/// The value at the origin of the linear function nearest to values at places around it.
template <int Dim>
class LinearFit {
 public:
  using Basis = Eigen::Matrix<double, Dim + 1, 1>;

  /// \param place  in units of h
  void add(const Vec<Dim>& place, double value, double weight) {
    Basis basis;
    basis << 1, place;
    matrix_ += weight * basis * basis.transpose();
    right_ += weight * value * basis;
  }
  bool is_empty() const { return matrix_(0, 0) == 0; }
  double at_origin() const {
    auto matrix = matrix_;
    // Slopes that few values tell of tend to zero.
    for (int d = 1; d <= Dim; ++d) matrix(d, d) += 1e-3 * matrix_(0, 0);
    return solve_small_symmetric<Dim + 1>(matrix, right_)[0];
  }

 private:
  Eigen::Matrix<double, Dim + 1, Dim + 1> matrix_ = Eigen::Matrix<double, Dim + 1, Dim + 1>::Zero();
  Basis right_ = Basis::Zero();
};

}  // namespace

OpenSpline open_spline(double distance) {
  const double share = quadratic_spline_below(distance);
  return {share, share > 0 ? moment_beyond(std::abs(distance)) / share : 0};
}

template <int Dim>
SolidAtRest solid_at_rest(const BodySet<Dim>& set, const Grid<Dim>& grid, const Splines<Dim>& splines) {
  const auto rests = [](const auto& body) { return !body.moves(); };
  if (std::none_of(set.bodies.begin(), set.bodies.end(), rests)) return {};
  const auto bodies = PlacedBodies<Dim>::at_start(set);
  const StaggeredIndex<Dim> nobody{};
  const SurfaceLattice<Dim> lattice(grid, nobody);
  SolidAtRest at_rest{std::vector<double>(rows_in<Dim>(splines.sites()))};
  for_each_costly_row(at_rest.distance.size(), [&](std::size_t k) {
    const Index<Dim> site = index_in<Dim>(splines.sites(), k);
    at_rest.distance[k] =
        lattice.has(site) ? bodies.distance(lattice.place_of_site(site), false) : far_away * grid.spacing;
  });
  return at_rest;
}

template <int Dim>
void ExtendSurfaceDistance<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                            Read<StaggeredIndex<Dim>> rows, Read<SolidAtRest> at_rest,
                                            Uses<BodyPlacement<Dim>> placement, Read<staggered::Site<Dim>> site,
                                            Write<surface::SolidDistance> solid, Write<surface::OpenShare> open,
                                            Write<surface::OpenCentroid<Dim>> centroid,
                                            Write<surface::OpenDistance> open_psi,
                                            Update<surface::Distance> psi) const {
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  const PlacedBodies<Dim> bodies(placement);
  const double h = grid->spacing;
  const auto nearest_to = [&](const Vec<Dim>& x, const Index<Dim>& at) {
    double distance = far_away * h;
    if (!at_rest->distance.empty()) distance = std::min(distance, at_rest->distance[row_in<Dim>(splines->sites(), at)]);
    if (bodies.may_be_near(x, far_away * h)) distance = std::min(distance, bodies.distance(x, true));
    return distance;
  };
  const auto normal_at = [&](const Vec<Dim>& x) -> Vec<Dim> {
    const auto resting = bodies.nearest(x, false);
    const auto moving = bodies.nearest(x, true);
    const auto b = static_cast<std::size_t>(moving.distance < resting.distance ? moving.body : resting.body);
    return bodies.placement(b).gradient(*placement.set->bodies[b].shape, x).stableNormalized();
  };
  for_each_costly_row(site.size(), [&](std::size_t i) {
    open[i] = lattice.has(site[i]) ? 1 : 0;
    centroid[i].setZero();
    open_psi[i] = psi[i];
    solid[i] = far_away * h;
    if (open[i] == 0) return;
    const Vec<Dim> x = lattice.place_of_site(site[i]);
    solid[i] = nearest_to(x, site[i]);
    if (solid[i] >= quadratic_spline_reach * h) return;
    const OpenSpline of_spline = open_spline(solid[i] / h);
    open[i] = of_spline.share;
    if (open[i] < telling_from) return;
    centroid[i] = of_spline.centroid * h * normal_at(x);
    const double phi = quadratic_spline_below(psi[i] / h) / open[i];
    open_psi[i] = h * distance_of_fill(std::min(1.0, phi));
  });
  const DistanceAround<Dim> around{*grid, *splines, lattice, open.span(), centroid.span(), open_psi.span()};
  for_each_costly_row(site.size(), [&](std::size_t i) {
    if (open[i] < 1 && lattice.has(site[i])) psi[i] = around.at(site[i]);
  });
}

template <int Dim>
double DistanceAround<Dim>::at(const Index<Dim>& site) const {
  const double h = grid.spacing;
  const Vec<Dim> x = lattice.place_of_site(site);
  LinearFit<Dim> fit;
  for_each_site_around<Dim, 2>(splines, site, [&](const Index<Dim>& other, const Index<Dim>& steps) {
    const auto row = lattice.row_of_site(other);
    if (!row || open[*row] < telling_from) return;
    Vec<Dim> place = (lattice.place_of_site(other) - x) / h;
    for (std::size_t d = 0; d < Dim; ++d) {
      if (grid.periodic[d]) place[static_cast<Eigen::Index>(d)] = steps[d];
    }
    place += centroid[*row] / h;
    // Where a spline is all full or empty its distance is only known to be far.
    constexpr double of_far = 1e-3;
    const double far = own_share + place.squaredNorm();
    fit.add(place, psi[*row], open[*row] * (quadratic_spline(psi[*row] / h) + of_far) / (far * far));
  });
  const double reach = quadratic_spline_reach * h;
  return fit.is_empty() ? -reach : std::clamp(fit.at_origin(), -reach, reach);
}

template struct DistanceAround<2>;
template struct DistanceAround<3>;
template SolidAtRest solid_at_rest<2>(const BodySet<2>&, const Grid<2>&, const Splines<2>&);
template SolidAtRest solid_at_rest<3>(const BodySet<3>&, const Grid<3>&, const Splines<3>&);
template struct ExtendSurfaceDistance<2>;
template struct ExtendSurfaceDistance<3>;

}  // namespace minamo
