#pragma once
/// \file
/// (E95), (E117) Viscosity as a function of the shear rate, of grains of the pressure, too.

#include "components/rheology.hpp"

namespace minamo {

/// (E95), (E117)
/// \param rate      sqrt(2 D:D), not negative [1/s]
/// \param pressure  [Pa]
/// \return [Pa s]; finite at rest, however small the rate
double viscosity_at(const rheology::Law& law, double rate, double pressure = 0);

}  // namespace minamo
