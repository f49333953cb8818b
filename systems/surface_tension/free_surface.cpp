#include "systems/surface_tension/free_surface.hpp"

#include "systems/grid/quadratic_spline.hpp"
#include "systems/surface_tension/point_sites.hpp"
#include "systems/surface_tension/surface_cube.hpp"
#include "systems/surface_tension/surface_lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace minamo {

double distance_of_fill(double fraction) {
  const double beyond = std::abs(fraction - 0.5);
  constexpr double of_half = 1.0 / 3;  // F(1/2) - 1/2
  double distance = quadratic_spline_reach - std::cbrt(6 * std::max(0.0, 0.5 - beyond));
  // s^3 - 9/4 s + 3 (F - 1/2) = 0, by the sine of a third of an angle.
  if (beyond < of_half) distance = std::numbers::sqrt3 * std::sin(std::asin(4 * beyond / std::numbers::sqrt3) / 3);
  return fraction < 0.5 ? -distance : distance;
}

namespace {

/// Whether a cube counts to a row: to the first of its nodes that has one.
template <int Dim>
bool belongs_to(const SurfaceLattice<Dim>& lattice, const Index<Dim>& base, std::size_t row) {
  for (std::size_t c = 0; c < power(2, Dim); ++c) {
    Index<Dim> node = base;
    for (std::size_t d = 0; d < Dim; ++d) node[d] += static_cast<int>(c >> d & 1U);
    if (!lattice.is_site(node)) continue;
    if (const auto found = lattice.row(node)) return *found == row;
  }
  return false;
}

/// What another rank counts: it pulls here, too.
template <int Dim>
void add_uncounted(const SurfaceCube<Dim>& cube, typename FreeSurface<Dim>::Piece& piece) {
  const auto areas = piece.areas;
  const std::size_t elements = piece.elements.size();
  const std::size_t contacts = piece.contacts.size();
  cube.add_to(piece);
  piece.areas = areas;
  for (std::size_t k = elements; k < piece.elements.size(); ++k) piece.elements[k].counts = false;
  for (std::size_t k = contacts; k < piece.contacts.size(); ++k) piece.contacts[k].counts = false;
}

}  // namespace

template <int Dim>
void FindSurfaceDistance<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                          Read<StaggeredIndex<Dim>> rows, Read<GridCells<Dim>> cells,
                                          Read<CellSites> sites, Read<particle::QuadraturePosition<Dim>> y_p,
                                          Read<particle::Volume> V_p, Read<staggered::Site<Dim>> site,
                                          Optional<Read<SiteExchange>> shared, Write<surface::Distance> psi) const {
  for_each_row(psi.size(), [&](std::size_t i) { psi[i] = 0; });
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell_coloured<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      const CellFrame<Dim> frame(*grid, *splines, cell.node);
      std::array<double, cell_sites<Dim, K>> volume{};
      for (std::size_t p = cell.begin; p < cell.end; ++p) {
        const SplineWeights<Dim, K> weights(frame, frame.local(y_p[p]));
        for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
          volume[k] += V_p[p] * quadratic_weight<Dim, K>(weights, offset);
        });
      }
      const std::uint32_t* of_cell = sites->of(c);
      for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>&) { psi[of_cell[k]] += volume[k]; });
    });
  });
  add_up(shared, psi.span());
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  for_each_row(psi.size(), [&](std::size_t i) {
    const double phi = lattice.has(site[i]) ? std::min(1.0, psi[i] / lattice.capacity(site[i])) : 0;
    psi[i] = grid->spacing * distance_of_fill(phi);
  });
}

template <int Dim>
void FindFreeSurface<Dim>::operator()(
    Read<SurfaceTension> tension, Read<Grid<Dim>> grid, Read<StaggeredIndex<Dim>> rows, Read<staggered::Site<Dim>> site,
    Read<surface::Distance> psi, Read<Splines<Dim>> splines, Optional<Read<surface::SolidDistance>> solid,
    Optional<Read<surface::OpenShare>> open, Optional<Read<surface::OpenCentroid<Dim>>> centroid,
    Optional<Read<surface::OpenDistance>> open_psi, Optional<Read<BodySet<Dim>>> set,
    Optional<Read<body::MiddlePosition<Dim>>> c_b, Optional<Read<body::MiddleRotation<Dim>>> R_b,
    Optional<Read<SiteExchange>> shared, Write<FreeSurface<Dim>> surface) const {
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  std::optional<SurfaceBodies<Dim>> bodies;
  const DistanceAround<Dim> around{*grid, *splines, lattice, open.span(), centroid.span(), open_psi.span()};
  if (solid) bodies.emplace(SurfaceBodies<Dim>{{*set, c_b.span(), R_b.span()}, tension->bodies, around});
  const double outside = -quadratic_spline_reach * grid->spacing;
  // A cube reaches as far from any of its nodes.
  const double near_body = std::sqrt(Dim) * grid->spacing;
  constexpr std::size_t rows_per_piece = 256;
  const auto add_cubes_of = [&](std::size_t i, typename FreeSurface<Dim>::Piece& piece) {
    const SurfaceBodies<Dim>* near = bodies && solid[i] <= near_body ? &*bodies : nullptr;
    for (std::size_t c = 0; c < power(2, Dim); ++c) {
      Index<Dim> base;
      for (std::size_t d = 0; d < Dim; ++d)
        base[d] = lattice.axis(d).node_of(site[i][d]) - static_cast<int>(c >> d & 1U);
      if (!belongs_to<Dim>(lattice, base, i)) continue;
      const SurfaceCube<Dim> cube(lattice, psi.span(), outside, base, near, tension->cosine_of_contact_angle);
      if (owns(of_ranks(shared), i)) {
        cube.add_to(piece);
      } else {
        add_uncounted<Dim>(cube, piece);
      }
    }
  };
  surface->pieces.resize(site.size() / rows_per_piece + 1);
  for_each_row(
      surface->pieces.size(),
      [&](std::size_t k) {
        auto& piece = surface->pieces[k];
        piece.elements.clear();
        piece.contacts.clear();
        piece.on_bodies.clear();
        piece.areas = {};
        const std::size_t end = std::min(site.size(), (k + 1) * rows_per_piece);
        for (std::size_t i = k * rows_per_piece; i < end; ++i) {
          if (lattice.has(site[i])) add_cubes_of(i, piece);
        }
      },
      1);
  surface->areas = {};
  for (const auto& piece : surface->pieces) surface->areas += piece.areas;
  add_up_on_all(of_ranks(shared), std::span(&surface->areas, 1));
}

template struct FindSurfaceDistance<2>;
template struct FindSurfaceDistance<3>;
template struct FindFreeSurface<2>;
template struct FindFreeSurface<3>;

}  // namespace minamo
