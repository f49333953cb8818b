#pragma once
/// \file
/// (E95) Viscosity as a function of the shear rate.

#include "components/rheology.hpp"

namespace minamo {

/// (E95)
/// \param rate  sqrt(2 D:D), not negative [1/s]
/// \return [Pa s]; finite at rest, however small the rate
double viscosity_at(const rheology::Law& law, double rate);

}  // namespace minamo
