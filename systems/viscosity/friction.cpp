#include "systems/viscosity/friction.hpp"

#include "systems/grid/filled_nodes.hpp"
#include "systems/viscosity/cell_room.hpp"
#include "systems/viscosity/wall_friction.hpp"

#include <algorithm>

namespace minamo {

namespace {

template <int Dim>
std::span<double> numbers(std::span<Vec<Dim>> of_faces) {
  static_assert(sizeof(Vec<Dim>) == Dim * sizeof(double));
  return {of_faces.empty() ? nullptr : of_faces.front().data(), Dim * of_faces.size()};
}
template <int Dim>
std::span<const double> numbers(std::span<const Vec<Dim>> of_faces) {
  return {of_faces.empty() ? nullptr : of_faces.front().data(), Dim * of_faces.size()};
}

}  // namespace

template <int Dim>
void FindCellViscosity<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                                        Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<particle::Volume> V_p,
                                        Read<multiplier::FillAround> around, Optional<Read<CutFriction<Dim>>> cut,
                                        Optional<Read<FrictionAtRest<Dim>>> at_rest,
                                        Write<cell::Viscosity> mu_c) const {
  const CellRoom<Dim> room(grid->spacing, cut, at_rest);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      double volume = 0;
      for (std::size_t p = cell.begin; p < cell.end; ++p) volume += V_p[p];
      const double theta = filled_indicator(least_of_multipliers<Dim, K>(sites->of(c), around.span()));
      mu_c[c] = fluid->viscosity * room.liquid_share(c, theta, volume);
    });
  });
}

template <int Dim>
void RubFaces<Dim>::operator()(Read<Rates> rates, Read<Splines<Dim>> splines, Read<FrictionMatrices<Dim>> matrices,
                               Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<face::Mobility<Dim>> mobility,
                               Optional<Read<face::Open<Dim>>> open, Optional<Read<FaceExtension<Dim>>> extension,
                               Optional<Read<CutFriction<Dim>>> cut, Optional<Read<FrictionAtRest<Dim>>> at_rest,
                               Optional<Read<SiteExchange>> shared, Update<cell::Viscosity> mu_c,
                               Write<face::FrictionBound<Dim>> bound, Write<face::Friction<Dim>> friction,
                               Write<FrictionOnWalls<Dim>> on_walls, Update<face::Predictor<Dim>> predictor) const {
  const double tau = rates->velocity / rates->acceleration;
  const bool walls_rub = static_cast<bool>(cut);
  FrictionOf<Dim> of{*splines, *matrices, *cells, *sites, mu_c.span()};
  of.shared = of_ranks(shared);
  if (walls_rub) {
    of.extension = &*extension;
    of.cut = &*cut;
    of.at_rest = &*at_rest;
  }
  // 1/m_f: what bodies leave open of a face stands in its mobility, too.
  const auto per_mass = [&](std::size_t i, Eigen::Index d) {
    return walls_rub && open[i][d] > 0 ? mobility[i][d] / open[i][d] : mobility[i][d];
  };
  for_each_row(bound.size(), [&](std::size_t i) {
    bound[i].setZero();
    friction[i].setZero();
  });
  add_friction_diagonal<Dim>(of, numbers<Dim>(bound.span()).data(),
                             [&](std::size_t c, std::size_t f, std::size_t) { return of.bounds_of(c)[f]; });
  add_up(shared, bound.span());
  if (walls_rub) bound_by_open_faces<Dim>(*extension, numbers<Dim>(bound.span()));
  // 2 tau D_f/m_f takes the place of the bound.
  for_each_row(bound.size(), [&](std::size_t i) {
    for (Eigen::Index d = 0; d < Dim; ++d) bound[i][d] = 2 * tau * bound[i][d] * per_mass(i, d);
  });
  if (walls_rub) most_of_open_faces<Dim>(*extension, numbers<Dim>(bound.span()));
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto&) {
      const std::uint32_t* rows = sites->of(c);
      double largest = 1;
      for_each_cell_face<Dim, K>(
          [&](std::size_t, std::size_t k, Eigen::Index d) { largest = std::max(largest, bound[rows[k]][d]); });
      mu_c[c] /= largest;
    });
  });
  if (walls_rub) {
    on_walls->of.assign(cut->motion.size(), RigidVector<Dim>::Zero());
    // The bound is not read again: room for the extended velocities.
    apply_wall_friction<Dim>(of, WallsMove::yes, {}, numbers<Dim>(std::span<const Vec<Dim>>(predictor.span())),
                             numbers<Dim>(bound.span()), numbers<Dim>(friction.span()), &on_walls->of);
  } else {
    on_walls->of.clear();
    apply_friction<Dim>(of, numbers<Dim>(std::span<const Vec<Dim>>(predictor.span())).data(),
                        numbers<Dim>(friction.span()).data());
    add_up(shared, friction.span());
  }
  for_each_row(predictor.size(), [&](std::size_t i) {
    for (Eigen::Index d = 0; d < Dim; ++d) predictor[i][d] -= tau * (per_mass(i, d) * friction[i][d]);
  });
}

template struct FindCellViscosity<2>;
template struct FindCellViscosity<3>;
template struct RubFaces<2>;
template struct RubFaces<3>;

}  // namespace minamo
