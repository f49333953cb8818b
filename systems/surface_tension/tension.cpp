#include "systems/surface_tension/tension.hpp"

#include "systems/surface_tension/piece_sums.hpp"
#include "systems/surface_tension/surface_lattice.hpp"
#include "systems/surface_tension/surface_points.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace minamo {

template <int Dim>
AreaGradient<Dim> area_gradient(const typename FreeSurface<Dim>::Element& element) {
  if constexpr (Dim == 2) {
    const Vec<2> along = (element[1].x - element[0].x).normalized();
    return {Vec<2>(-along), along};
  } else {
    const Vec<3> normal = area_vector<3>(element).normalized();
    const std::size_t size = element.size();
    AreaGradient<3> gradient;
    for (std::size_t k = 0; k < size; ++k)
      gradient[k] = 0.5 * normal.cross(element[(k + size - 1) % size].x - element[(k + 1) % size].x);
    return gradient;
  }
}

namespace {

/// Hands forces at the corners of a piece on: what acts along walls to the sites from which the places of the corners
/// come, the rest to the walls.
template <int Dim>
class CornerForces {
 public:
  using Corner = typename FreeSurface<Dim>::Corner;
  using OnBody = typename FreeSurface<Dim>::OnBody;

  CornerForces(const SurfaceLattice<Dim>& lattice, const Walls<Dim>& walls,
               const std::vector<SurfaceTension::Wall>& bodies, std::span<const double> around, double least_around)
      : lattice_(lattice), walls_(walls), bodies_(bodies), around_(around), least_around_(least_around) {}

  /// Calls use(row of a site, force) for what the liquid gets. \return what a body gets
  template <class Use>
  Vec<Dim> hand_on(const Corner& corner, const OnBody* on, const Vec<Dim>& force, const Use& use) const {
    Vec<Dim> along = along_sides(corner, force);
    Vec<Dim> of_body = Vec<Dim>::Zero();
    if (on != nullptr) {
      const bool sticks = bodies_[static_cast<std::size_t>(on->body)].sticks;
      of_body = sticks ? along : Vec<Dim>(along.dot(on->normal) * on->normal);
      along -= of_body;
    }
    double taken = 0;
    for_each_taker(corner, on, [&](std::size_t, double weight) { taken += weight; });
    constexpr double least = 0.1;  // a corner far from all sites: a drop of a particle or two, which has no surface
    if (taken < least) return of_body;
    for_each_taker(corner, on, [&](std::size_t i, double weight) { use(i, Vec<Dim>(weight / taken * along)); });
    return of_body;
  }

 private:
  /// What pulls across a side of the box at a corner on it, the side takes, and all where the liquid does not slip
  /// along it: there the contact line does not move.
  Vec<Dim> along_sides(const Corner& corner, Vec<Dim> force) const {
    constexpr auto all = static_cast<std::uint8_t>((1U << Dim) - 1);
    for (std::size_t d = 0; d < Dim; ++d) {
      const auto& ax = lattice_.axis(d);
      const bool is_low = ax.is_low_wall(corner.in[d]) && ax.is_low_wall(corner.out[d]);
      const bool is_high = ax.is_high_wall(corner.in[d]) && ax.is_high_wall(corner.out[d]);
      if (!is_low && !is_high) continue;
      force[static_cast<Eigen::Index>(d)] = 0;
      if (walls_.held[d][is_low ? 0 : 1] == all) return Vec<Dim>::Zero();
    }
    return force;
  }

  template <class Use>
  void for_each_taker(const Corner& corner, const OnBody* on, const Use& use) const {
    const auto from = [&](const Index<Dim>& node, double share) {
      lattice_.for_each_source(node, [&](const auto& row, double weight) {
        if (row && around_[*row] > least_around_) use(*row, share * weight);
      });
    };
    const double part = on == nullptr ? 0 : on->part;
    from(corner.in, (1 - part) * (1 - corner.share));
    from(corner.out, (1 - part) * corner.share);
    if (on == nullptr) return;
    from(on->in, part * (1 - on->share));
    from(on->out, part * on->share);
  }

  const SurfaceLattice<Dim>& lattice_;
  const Walls<Dim>& walls_;
  const std::vector<SurfaceTension::Wall>& bodies_;
  std::span<const double> around_;
  double least_around_;
};

/// Calls use(corner, force on it, body that it is pulled along or none, whether it counts for all ranks) for the
/// corners of a piece: (E113), then (E114) of its contact lines.
template <int Dim, class Use>
void for_each_corner_force(const typename FreeSurface<Dim>::Piece& piece, const SurfaceTension& tension,
                           const Use& use) {
  const double sigma = tension.coefficient / FreeSurface<Dim>::covers;
  for (const auto& element : piece.elements) {
    const auto gradient = area_gradient<Dim>(element);
    for (std::size_t k = 0; k < element.size(); ++k)
      use(element[k], Vec<Dim>(-sigma * gradient[k]), staggered::none, element.counts);
  }
  for (const auto& contact : piece.contacts) {
    double pull = sigma * (contact.body == staggered::none
                               ? tension.cosine_of_contact_angle
                               : tension.bodies[static_cast<std::size_t>(contact.body)].cosine_of_contact_angle);
    if (pull == 0) continue;
    if constexpr (Dim == 3) pull *= 0.5 * (contact.corner[1].x - contact.corner[0].x).norm();
    for (const auto& corner : contact.corner)
      use(corner, Vec<Dim>(pull * contact.outward), contact.body, contact.counts);
  }
}

}  // namespace

template <int Dim>
void MeasureSurfaceAround<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines,
                                           Read<StaggeredIndex<Dim>> rows, Read<FreeSurface<Dim>> surface,
                                           Update<PieceSums<Dim>> sums, Write<surface::Around> A_i) const {
  for_each_row(A_i.size(), [&](std::size_t i) { A_i[i] = 0; });
  sums->areas.resize(surface->pieces.size());
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_row(
        surface->pieces.size(),
        [&](std::size_t piece) {
          PointSites<Dim, K> sites(*grid, *splines, *rows);
          SumsOfCells<Dim, K, double> of_cells(sums->areas[piece]);
          for_each_point_of_piece<Dim>(surface->pieces[piece], [&](const Vec<Dim>& x, double area) {
            const auto weights = sites.weights_at(x);
            const auto A_k = of_cells.around(sites, 0);
            for_each_quadratic<Dim, K>([&](std::size_t k, const Index<Dim>& offset) {
              A_k[k] += area * quadratic_weight<Dim, K>(weights, offset);
            });
          });
        },
        1);
  });
  add_pieces(sums->areas, A_i.span());
}

template <int Dim>
void FindSurfaceTraction<Dim>::operator()(Read<SurfaceTension> tension, Read<Grid<Dim>> grid, Read<Walls<Dim>> walls,
                                          Read<StaggeredIndex<Dim>> rows, Read<FreeSurface<Dim>> surface,
                                          Read<surface::Around> A_i, Optional<Read<body::MiddlePosition<Dim>>> c_b,
                                          Optional<Read<SiteExchange>> shared, Update<PieceSums<Dim>> sums,
                                          Write<surface::Traction<Dim>> t_i,
                                          Write<surface::ForceOnBodies<Dim>> F_b) const {
  // What hardly reaches the surface would put its force on a point.
  const double least_around = 1e-3 * std::pow(grid->spacing, Dim - 1);
  const SurfaceLattice<Dim> lattice(*grid, *rows);
  const CornerForces<Dim> forces(lattice, *walls, tension->bodies, A_i.span(), least_around);
  sums->at_corners.resize(surface->pieces.size());
  sums->on_bodies.resize(surface->pieces.size());
  for_each_row(
      surface->pieces.size(),
      [&](std::size_t k) {
        const auto& piece = surface->pieces[k];
        auto& at_corners = sums->at_corners[k];
        auto& on_bodies = sums->on_bodies[k];
        at_corners.clear();
        on_bodies.clear();
        for_each_corner_force<Dim>(
            piece, *tension, [&](const auto& corner, const Vec<Dim>& force, std::int32_t pulled, bool counts) {
              const auto* on = corner.on_body == staggered::none
                                   ? nullptr
                                   : &piece.on_bodies[static_cast<std::size_t>(corner.on_body)];
              Vec<Dim> of_body = forces.hand_on(corner, on, force, [&](std::size_t i, const Vec<Dim>& share) {
                at_corners.emplace_back(static_cast<std::uint32_t>(i), share);
              });
              if (on == nullptr || !counts) return;
              // The wall is pulled against the liquid that spreads on it.
              if (pulled != staggered::none) of_body -= force;
              const auto b = static_cast<std::size_t>(on->body);
              on_bodies.emplace_back(static_cast<std::uint32_t>(b),
                                     rigid_vector<Dim>(of_body, moment_of(Vec<Dim>(corner.x - c_b[b]), of_body)));
            });
      },
      1);
  for_each_row(t_i.size(), [&](std::size_t i) { t_i[i].setZero(); });
  for (const auto& of_piece : sums->at_corners) {
    for (const auto& [i, force] : of_piece) t_i[i] += force;
  }
  F_b->of.assign(tension->bodies.size(), RigidVector<Dim>::Zero());
  for (const auto& of_piece : sums->on_bodies) {
    for (const auto& [b, force] : of_piece) F_b->of[b] += force;
  }
  add_up_on_all(of_ranks(shared), std::span(F_b->of));
  for_each_row(t_i.size(), [&](std::size_t i) {
    if (A_i[i] > least_around) t_i[i] /= A_i[i];
  });
}

template AreaGradient<2> area_gradient<2>(const FreeSurface<2>::Element&);
template AreaGradient<3> area_gradient<3>(const FreeSurface<3>::Element&);
template struct MeasureSurfaceAround<2>;
template struct MeasureSurfaceAround<3>;
template struct FindSurfaceTraction<2>;
template struct FindSurfaceTraction<3>;

}  // namespace minamo
