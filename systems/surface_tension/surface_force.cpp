#include "engine/schedule/parallel.hpp"
#include "systems/bodies/geometry/cut.hpp"
#include "systems/grid/incidence.hpp"
#include "systems/surface_tension/piece_sums.hpp"
#include "systems/surface_tension/surface_points.hpp"
#include "systems/surface_tension/tension.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace minamo {

namespace {

/// Directions in which the face of a row takes forces: next to a multiplier that is an unknown, for others nothing
/// holds against it, and where walls hold, from which the walls take it.
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

/// Hands a force at a point on to the faces around it, those of its cell.
template <int Dim, int K>
void add_to_faces(const PointSites<Dim, K>& sites, const SplineWeights<Dim, K>& weights,
                  std::span<const std::uint8_t> takes, const Vec<Dim>& force, std::span<Vec<Dim>> F_k) {
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
      if (is_taker[k]) F_k[k][D] += force[D] * weights.template face<D>(offset) / taken;
    });
  });
}

/// E^T F: what acts on closed faces acts on the open ones that their velocities are made of.
template <int Dim>
void move_to_open_faces(const FaceExtension<Dim>& extension, std::span<Vec<Dim>> F_f) {
  for (const auto& at : extension.targets) {
    if (at.own) continue;
    double& pull = F_f[at.row][at.direction];
    for (std::size_t j = at.begin; j < at.begin + at.count; ++j)
      F_f[extension.source[j]][at.direction] += extension.weight[j] * pull;
    pull = 0;
  }
}

template <int Dim>
double energy_of(const SurfaceTension& tension, const FreeSurface<Dim>& surface) {
  return tension.coefficient * (surface.areas.free - surface.areas.gained);
}

/// Lines where the surface meets walls: their length, in 2-D their number. [m^(d-2)]
template <int Dim>
double contact_lines_of(const FreeSurface<Dim>& surface) {
  double length = 0;
  for (const auto& piece : surface.pieces) {
    if constexpr (Dim == 2) {
      for (const auto& contact : piece.contacts) length += contact.counts ? 1 : 0;
    } else {
      for (const auto& contact : piece.contacts)
        length += contact.counts ? (contact.corner[1].x - contact.corner[0].x).norm() : 0;
    }
  }
  return length / FreeSurface<Dim>::covers;
}

/// (E59)  What the energy of the surface changes by when it passes the lattice that it is found on and keeps its shape.
template <int Dim>
double unresolved_of(const SurfaceTension& tension, const FreeSurface<Dim>& surface, double h,
                     std::span<const double> V_p, const SiteExchange* shared) {
  constexpr double of_curvature = 1.0 / 16;  // up to 1/25 measured, of drops at rest
  constexpr double of_contact = 0.4;         // measured of drops that spread and draw back, 30 to 150 degrees
  const double area = surface.areas.free;
  const double own_volume = reduce_rows(
      V_p.size(), 0.0, [&](std::size_t p) { return V_p[p]; }, std::plus<>());
  const double volume = on_all(shared, own_volume);
  const double per_radius = std::min(1.0, h * area / (Dim * volume));
  return tension.coefficient * (of_curvature * per_radius * per_radius * area +
                                of_contact * h * on_all(shared, contact_lines_of<Dim>(surface)));
}

template <int Dim>
void set_energy(double joule, double unresolved, measure::Energy& energy, measure::Columns& columns) {
  energy.surface = joule;
  energy.unresolved = unresolved;
  columns.set("surface_energy", joule, Dim == 2 ? "J/m" : "J");
}

}  // namespace

template <int Dim>
void AddSurfaceTension<Dim>::operator()(Read<Rates> rates, Uses<MacGrid<Dim>> mac, Read<StaggeredIndex<Dim>> rows,
                                        Read<face::Held> held, Read<multiplier::Row> row,
                                        Read<FreeSurface<Dim>> surface, Read<surface::Traction<Dim>> t_i,
                                        Read<face::Mobility<Dim>> mobility, Optional<Read<face::Open<Dim>>> open,
                                        Optional<Read<FaceExtension<Dim>>> extension, Update<PieceSums<Dim>> sums,
                                        Write<face::TakesSurfaceForce> takes, Write<face::SurfaceForce<Dim>> F_f,
                                        Update<face::Predictor<Dim>> predictor) const {
  for_each_row(F_f.size(), [&](std::size_t i) { F_f[i].setZero(); });
  const Incidence<Dim> incidence(mac);
  for_each_row(takes.size(), [&](std::size_t i) { takes[i] = takers_of<Dim>(incidence, i, held[i], row.span()); });
  sums->forces.resize(surface->pieces.size());
  with_degree(mac.splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_row(
        surface->pieces.size(),
        [&](std::size_t piece) {
          PointSites<Dim, K> sites(*mac.grid, *mac.splines, *rows);
          SumsOfCells<Dim, K, Vec<Dim>> of_cells(sums->forces[piece]);
          for_each_point_of_piece<Dim>(surface->pieces[piece], [&](const Vec<Dim>& x, double area) {
            const auto weights = sites.weights_at(x);
            Vec<Dim> traction = Vec<Dim>::Zero();
            for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
              if (sites.row(k) == staggered::none) return;
              traction += quadratic_weight<Dim, K>(weights, offset) * t_i[static_cast<std::size_t>(sites.row(k))];
            });
            const auto F_k = of_cells.around(sites, Vec<Dim>::Zero());
            add_to_faces<Dim, K>(sites, weights, takes.span(), Vec<Dim>(area * traction), F_k);
          });
        },
        1);
  });
  add_pieces(sums->forces, F_f.span());
  if (extension) move_to_open_faces<Dim>(*extension, F_f.span());
  const double tau = rates->velocity / rates->acceleration;
  for_each_row(F_f.size(), [&](std::size_t i) {
    Vec<Dim> change = tau * mobility[i].cwiseProduct(F_f[i]);
    if (open) change = change.cwiseQuotient(open[i].cwiseMax(sliver));  // mobility is a_f/m_f there
    predictor[i] += change;
  });
}

template <int Dim>
void MeasureSurfaceEnergy<Dim>::operator()(Read<SurfaceTension> tension, Read<FreeSurface<Dim>> surface,
                                           Read<Grid<Dim>> grid, Read<particle::Volume> V_p,
                                           Read<face::SurfaceForce<Dim>> F_f, Read<face::Displacement<Dim>> u_f,
                                           Optional<Read<SiteExchange>> shared, Update<measure::Energy> energy,
                                           Update<measure::Columns> columns) const {
  const double work = reduce_rows(
      F_f.size(), 0.0, [&](std::size_t i) { return owns(of_ranks(shared), i) ? F_f[i].dot(u_f[i]) : 0; },
      std::plus<>());
  set_energy<Dim>(energy_of<Dim>(*tension, *surface) - 0.5 * on_all(of_ranks(shared), work),
                  unresolved_of<Dim>(*tension, *surface, grid->spacing, V_p.span(), of_ranks(shared)), *energy,
                  *columns);
}

template <int Dim>
void MeasureSurfaceEnergyAtStart<Dim>::operator()(Read<SurfaceTension> tension, Read<FreeSurface<Dim>> surface,
                                                  Read<Grid<Dim>> grid, Read<particle::Volume> V_p,
                                                  Optional<Read<SiteExchange>> shared, Update<measure::Energy> energy,
                                                  Update<measure::Columns> columns) const {
  set_energy<Dim>(energy_of<Dim>(*tension, *surface),
                  unresolved_of<Dim>(*tension, *surface, grid->spacing, V_p.span(), of_ranks(shared)), *energy,
                  *columns);
}

template struct AddSurfaceTension<2>;
template struct AddSurfaceTension<3>;
template struct MeasureSurfaceEnergy<2>;
template struct MeasureSurfaceEnergy<3>;
template struct MeasureSurfaceEnergyAtStart<2>;
template struct MeasureSurfaceEnergyAtStart<3>;

}  // namespace minamo
