#include "systems/conforming/friction.hpp"

#include "systems/conforming/friction_operator.hpp"
#include "systems/grid/filled_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

template <int Dim>
double* numbers(std::span<Vec<Dim>> of_faces) {
  static_assert(sizeof(Vec<Dim>) == Dim * sizeof(double));
  return of_faces.empty() ? nullptr : of_faces.front().data();
}
template <int Dim>
const double* numbers(std::span<const Vec<Dim>> of_faces) {
  return of_faces.empty() ? nullptr : of_faces.front().data();
}

}  // namespace

template <int Dim>
void FindCellViscosity<Dim>::operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<Fluid> fluid,
                                        Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<particle::Volume> V_p,
                                        Read<multiplier::FillFraction> phi, Write<cell::Viscosity> mu_c) const {
  const double per_cell = std::pow(grid->spacing, -Dim);
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto& cell) {
      double volume = 0;
      for (std::size_t p = cell.begin; p < cell.end; ++p) volume += V_p[p];
      const double theta = filled_indicator(least_of_multipliers<Dim, K>(sites->of(c), phi.span()));
      mu_c[c] = fluid->viscosity * ((1 - theta) * volume * per_cell + theta);
    });
  });
}

template <int Dim>
void RubFaces<Dim>::operator()(Read<Rates> rates, Read<Splines<Dim>> splines, Read<FrictionMatrices<Dim>> matrices,
                               Read<GridCells<Dim>> cells, Read<CellSites> sites, Read<face::Mobility<Dim>> mobility,
                               Update<cell::Viscosity> mu_c, Write<face::FrictionBound<Dim>> bound,
                               Write<face::Friction<Dim>> friction, Update<face::Predictor<Dim>> predictor) const {
  const double tau = rates->velocity / rates->acceleration;
  const FrictionOf<Dim> of{*splines, *matrices, *cells, *sites, mu_c.span()};
  for_each_row(bound.size(), [&](std::size_t i) {
    bound[i].setZero();
    friction[i].setZero();
  });
  add_friction_diagonal<Dim>(of, numbers<Dim>(bound.span()), [&](const Index<Dim>& cell, std::size_t f, std::size_t) {
    return matrices->bounds_of(*splines, cell)[f];
  });
  with_degree(splines->degree, [&](auto degree) {
    constexpr int K = degree();
    for_each_cell<Dim>(*cells, [&](std::size_t c, const auto&) {
      const std::uint32_t* rows = sites->of(c);
      double largest = 1;
      for_each_cell_face<Dim, K>([&](std::size_t, std::size_t k, Eigen::Index d) {
        largest = std::max(largest, 2 * tau * bound[rows[k]][d] * mobility[rows[k]][d]);
      });
      mu_c[c] /= largest;
    });
  });
  apply_friction<Dim>(of, numbers<Dim>(std::span<const Vec<Dim>>(predictor.span())), numbers<Dim>(friction.span()));
  for_each_row(predictor.size(), [&](std::size_t i) { predictor[i] -= tau * mobility[i].cwiseProduct(friction[i]); });
}

template struct FindCellViscosity<2>;
template struct FindCellViscosity<3>;
template struct RubFaces<2>;
template struct RubFaces<3>;

}  // namespace minamo
