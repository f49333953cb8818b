#include "systems/solve/pspg.hpp"

#include <cmath>

namespace minamo {

template <int Dim>
void StabilizePspg<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<Fluid> fluid,
                                    Write<StabilizationTime> time) const {
  const double inertia = 2 * fluid->density / clock->step;
  const double friction = 4 * fluid->viscosity / (grid->spacing * grid->spacing);
  time->tau = 1 / std::hypot(inertia, friction);
}

template struct StabilizePspg<2>;
template struct StabilizePspg<3>;

}  // namespace minamo
