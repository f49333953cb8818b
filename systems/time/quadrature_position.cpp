#include "systems/time/quadrature_position.hpp"

#include "systems/grid/node_support.hpp"

namespace minamo {

namespace {

template <int Dim>
void configure(double time, const Grid<Dim>& grid, std::span<const Vec<Dim>> x_p, std::span<const Vec<Dim>> v_p,
               std::span<Vec<Dim>> y_p) {
  for_each_row(x_p.size(), [&](std::size_t p) {
    y_p[p] = keep_off_walls<Dim>(grid, fold<Dim>(grid, Vec<Dim>(x_p[p] + time * v_p[p])));
  });
}

}  // namespace

template <int Dim>
void PlaceQuadratureAtStart<Dim>::operator()(Read<Grid<Dim>> grid, Read<particle::Position<Dim>> x_p,
                                             Write<particle::QuadraturePosition<Dim>> y_p) const {
  for_each_row(x_p.size(), [&](std::size_t p) { y_p[p] = fold<Dim>(*grid, x_p[p]); });
}

template <int Dim>
void PlaceQuadratureAtMiddle<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid,
                                              Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                              Write<particle::QuadraturePosition<Dim>> y_p) const {
  configure<Dim>(0.5 * clock->step, *grid, x_p.span(), v_p.span(), y_p.span());
}

template <int Dim>
void PlaceQuadratureStepBefore<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid,
                                                Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                                Write<particle::QuadraturePosition<Dim>> y_p) const {
  configure<Dim>(-clock->step, *grid, x_p.span(), v_p.span(), y_p.span());
}

template <int Dim>
void PlaceQuadratureStepAhead<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid,
                                               Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p,
                                               Write<particle::QuadraturePosition<Dim>> y_p) const {
  configure<Dim>(clock->step, *grid, x_p.span(), v_p.span(), y_p.span());
}

template struct PlaceQuadratureAtStart<2>;
template struct PlaceQuadratureAtStart<3>;
template struct PlaceQuadratureAtMiddle<2>;
template struct PlaceQuadratureAtMiddle<3>;
template struct PlaceQuadratureStepBefore<2>;
template struct PlaceQuadratureStepBefore<3>;
template struct PlaceQuadratureStepAhead<2>;
template struct PlaceQuadratureStepAhead<3>;

}  // namespace minamo
