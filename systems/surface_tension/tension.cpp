#include "systems/surface_tension/tension.hpp"

#include "engine/parallel.hpp"
#include "systems/conforming/incidence.hpp"
#include "systems/surface_tension/free_surface.hpp"
#include "systems/surface_tension/point_sites.hpp"
#include "systems/surface_tension/surface_lattice.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <functional>

namespace minamo {

template <int Dim>
std::array<Vec<Dim>, static_cast<std::size_t>(Dim)> area_gradient(const typename FreeSurface<Dim>::Element& element) {
  if constexpr (Dim == 2) {
    const Vec<2> along = (element[1].x - element[0].x).normalized();
    return {Vec<2>(-along), along};
  } else {
    const Vec<3> normal = (element[1].x - element[0].x).cross(element[2].x - element[0].x).normalized();
    std::array<Vec<3>, 3> gradient;
    for (std::size_t k = 0; k < 3; ++k)
      gradient[k] = 0.5 * normal.cross(element[(k + 2) % 3].x - element[(k + 1) % 3].x);
    return gradient;
  }
}

namespace {

/// Calls use(point, its area) for three points of an element: with fewer, constant curvature does not balance constant
/// pressure and currents double.
template <int Dim, class Use>
void for_each_point(const typename FreeSurface<Dim>::Element& element, const Use& use) {
  const double area = area_of<Dim>(element);
  if constexpr (Dim == 2) {
    // Gauss's points, of degree 5.
    const Vec<2> middle = 0.5 * (element[0].x + element[1].x);
    const Vec<2> step = std::sqrt(0.15) * (element[1].x - element[0].x);
    use(Vec<2>(middle - step), 5.0 / 18 * area);
    use(middle, 8.0 / 18 * area);
    use(Vec<2>(middle + step), 5.0 / 18 * area);
  } else {
    // Of degree 2.
    const Vec<3> sixth = (element[0].x + element[1].x + element[2].x) / 6;
    for (const auto& corner : element) use(Vec<3>(sixth + 0.5 * corner.x), area / 3);
  }
}

template <int Dim, class Use>
void for_each_point_of_surface(const FreeSurface<Dim>& surface, const Use& use) {
  for (const auto& piece : surface.pieces) {
    for (const auto& element : piece.elements) for_each_point<Dim>(element, use);
  }
}

/// Hands forces at corners on to the sites from which their place comes.
template <int Dim>
class SiteForces {
 public:
  SiteForces(const SurfaceLattice<Dim>& lattice, double least_around, std::span<const double> around,
             std::span<Vec<Dim>> force)
      : lattice_(lattice), least_around_(least_around), around_(around), force_(force) {}

  void add(const typename FreeSurface<Dim>::Corner& corner, Vec<Dim> force) {
    // What pulls across a wall at a corner on it, the wall takes.
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto& ax = lattice_.axis(d);
      const bool is_low = ax.is_low_wall(corner.in[d]) && ax.is_low_wall(corner.out[d]);
      const bool is_high = ax.is_high_wall(corner.in[d]) && ax.is_high_wall(corner.out[d]);
      if (is_low || is_high) force[static_cast<Eigen::Index>(d)] = 0;
    }
    double taken = 0;
    for_each_taker(corner, [&](std::size_t, double weight) { taken += weight; });
    constexpr double least = 0.1;  // a corner far from all sites: a drop of a particle or two, which has no surface
    if (taken < least) return;
    for_each_taker(corner, [&](std::size_t i, double weight) { force_[i] += weight / taken * force; });
  }

 private:
  template <class Use>
  void for_each_taker(const typename FreeSurface<Dim>::Corner& corner, const Use& use) const {
    const auto from = [&](const Index<Dim>& node, double share) {
      lattice_.for_each_source(node, [&](const auto& row, double weight) {
        if (row && around_[*row] > least_around_) use(*row, share * weight);
      });
    };
    from(corner.in, 1 - corner.share);
    from(corner.out, corner.share);
  }

  const SurfaceLattice<Dim>& lattice_;
  double least_around_;
  std::span<const double> around_;
  std::span<Vec<Dim>> force_;
};

/// Directions in which the face of a row takes forces: beside a multiplier that is an unknown, for others nothing holds
/// against it, and where walls hold, from which the walls take it.
template <int Dim>
std::uint8_t takers_of(const Incidence<Dim>& incidence, std::size_t i, unsigned held,
                       std::span<const std::int32_t> row) {
  unsigned takes = held;
  for (std::size_t d = 0; d < Dim; ++d) {
    incidence.for_each_multiplier(i, d, [&](std::size_t l, double) {
      if (row[l] != staggered::none) takes |= 1U << d;
    });
  }
  return static_cast<std::uint8_t>(takes);
}

/// Hands a force at a point on to the faces around it.
template <int Dim, int K>
void add_to_faces(const PointSites<Dim, K>& sites, const SplineWeights<Dim, K>& weights,
                  std::span<const std::uint8_t> takes, const Vec<Dim>& force, std::span<Vec<Dim>> F_f) {
  for_each_direction<Dim>([&](auto direction) {
    constexpr int D = direction();
    double taken = 0;
    std::array<bool, cell_sites<Dim, K>> is_taker{};
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
      const std::int32_t i = sites.row(k);
      is_taker[k] = i != staggered::none && (takes[static_cast<std::size_t>(i)] & (1U << D)) != 0;
      if (is_taker[k]) taken += weights.template face<D>(offset);
    });
    constexpr double least = 0.05;  // a point far out: the faces there have next to no mass
    if (taken < least) return;
    for_each_face<Dim, K, D>([&](std::size_t k, const Index<Dim>& offset) {
      if (is_taker[k])
        F_f[static_cast<std::size_t>(sites.row(k))][D] += force[D] * weights.template face<D>(offset) / taken;
    });
  });
}

template <int Dim>
double energy_of(const SurfaceTension& tension, const FreeSurface<Dim>& surface) {
  return tension.coefficient * (surface.area - tension.cosine_of_contact_angle * surface.wetted);
}

void set_energy(double joule, measure::Energy& energy, measure::Columns& columns) {
  energy.surface = joule;
  columns.set("surface_energy", joule);
}

}  // namespace

// The surface has far fewer points than the liquid has particles: the loops over it run one after the other.

template <int Dim>
void MeasureSurfaceAround<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                           Read<StaggeredIndex<Dim>> rows, Read<FreeSurface<Dim>> surface,
                                           Write<surface::Around> A_i) const {
  for_each_row(A_i.size(), [&](std::size_t i) { A_i[i] = 0; });
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    PointSites<Dim, K> sites(*grid, *splines, *rows);
    for_each_point_of_surface<Dim>(*surface, [&](const Vec<Dim>& x, double area) {
      const auto weights = sites.weights_at(x);
      for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
        if (sites.row(k) == staggered::none) return;
        A_i[static_cast<std::size_t>(sites.row(k))] += area * quadratic_weight<Dim, K>(weights, offset);
      });
    });
  });
}

template <int Dim>
void FindSurfaceTraction<Dim>::operator()(Read<SurfaceTension> tension, Read<Grid<Dim>> grid,
                                          Read<StaggeredIndex<Dim>> rows, Read<FreeSurface<Dim>> surface,
                                          Read<surface::Around> A_i, Write<surface::Traction<Dim>> t_i) const {
  for_each_row(t_i.size(), [&](std::size_t i) { t_i[i].setZero(); });
  // What hardly reaches the surface would put its force on a point.
  const double least_around = 1e-3 * std::pow(grid->spacing, Dim - 1);
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  SiteForces<Dim> forces(lattice, least_around, A_i.span(), t_i.span());
  const double sigma = tension->coefficient;
  const double along_wall = sigma * tension->cosine_of_contact_angle;
  for (const auto& piece : surface->pieces) {
    for (const auto& element : piece.elements) {
      const auto gradient = area_gradient<Dim>(element);
      for (std::size_t k = 0; k < element.size(); ++k) forces.add(element[k], Vec<Dim>(-sigma * gradient[k]));
    }
    if (along_wall == 0) continue;
    for (const auto& contact : piece.contacts) {
      double share = along_wall;
      if constexpr (Dim == 3) share *= 0.5 * (contact.corner[1].x - contact.corner[0].x).norm();
      for (const auto& corner : contact.corner) forces.add(corner, Vec<Dim>(share * contact.outward));
    }
  }
  for_each_row(t_i.size(), [&](std::size_t i) {
    if (A_i[i] > least_around) t_i[i] /= A_i[i];
  });
}

template <int Dim>
void AddSurfaceTension<Dim>::operator()(Read<Rates> rates, Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                        Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
                                        Read<staggered::Neighbour<Dim>> neighbour, Read<face::Held> held,
                                        Read<multiplier::Row> row, Read<FreeSurface<Dim>> surface,
                                        Read<surface::Traction<Dim>> t_i, Read<face::Mobility<Dim>> mobility,
                                        Write<face::TakesSurfaceForce> takes, Write<face::SurfaceForce<Dim>> F_f,
                                        Update<face::Predictor<Dim>> predictor) const {
  for_each_row(F_f.size(), [&](std::size_t i) { F_f[i].setZero(); });
  const Incidence<Dim> incidence(*grid, *splines, site.span(), neighbour.span());
  for_each_row(takes.size(), [&](std::size_t i) { takes[i] = takers_of<Dim>(incidence, i, held[i], row.span()); });
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    PointSites<Dim, K> sites(*grid, *splines, *rows);
    for_each_point_of_surface<Dim>(*surface, [&](const Vec<Dim>& x, double area) {
      const auto weights = sites.weights_at(x);
      Vec<Dim> traction = Vec<Dim>::Zero();
      for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
        if (sites.row(k) == staggered::none) return;
        traction += quadratic_weight<Dim, K>(weights, offset) * t_i[static_cast<std::size_t>(sites.row(k))];
      });
      add_to_faces<Dim, K>(sites, weights, takes.span(), Vec<Dim>(area * traction), F_f.span());
    });
  });
  const double tau = rates->velocity / rates->acceleration;
  for_each_row(F_f.size(), [&](std::size_t i) { predictor[i] += tau * mobility[i].cwiseProduct(F_f[i]); });
}

template <int Dim>
void MeasureSurfaceEnergy<Dim>::operator()(Read<SurfaceTension> tension, Read<FreeSurface<Dim>> surface,
                                           Read<face::SurfaceForce<Dim>> F_f, Read<face::Displacement<Dim>> u_f,
                                           Update<measure::Energy> energy, Update<measure::Columns> columns) const {
  const double work = reduce_rows(
      F_f.size(), 0.0, [&](std::size_t i) { return F_f[i].dot(u_f[i]); }, std::plus<>());
  set_energy(energy_of<Dim>(*tension, *surface) - 0.5 * work, *energy, *columns);
}

template <int Dim>
void MeasureSurfaceEnergyAtStart<Dim>::operator()(Read<SurfaceTension> tension, Read<FreeSurface<Dim>> surface,
                                                  Update<measure::Energy> energy,
                                                  Update<measure::Columns> columns) const {
  set_energy(energy_of<Dim>(*tension, *surface), *energy, *columns);
}

template std::array<Vec<2>, 2> area_gradient<2>(const FreeSurface<2>::Element&);
template std::array<Vec<3>, 3> area_gradient<3>(const FreeSurface<3>::Element&);
template struct MeasureSurfaceAround<2>;
template struct MeasureSurfaceAround<3>;
template struct FindSurfaceTraction<2>;
template struct FindSurfaceTraction<3>;
template struct AddSurfaceTension<2>;
template struct AddSurfaceTension<3>;
template struct MeasureSurfaceEnergy<2>;
template struct MeasureSurfaceEnergy<3>;
template struct MeasureSurfaceEnergyAtStart<2>;
template struct MeasureSurfaceEnergyAtStart<3>;

}  // namespace minamo
