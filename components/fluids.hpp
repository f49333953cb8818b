#pragma once
/// \file
/// Several liquids that do not mix. Scenes with one have nothing of this.

#include "components/fluid.hpp"
#include "components/particle.hpp"
#include "components/staggered.hpp"

#include <string>
#include <vector>

namespace minamo {

/// Most liquids of a scene: what a cell sums up of each has its place on the stack.
inline constexpr std::size_t most_fluids = 8;

/// The liquids, in the order of the scene.
struct Fluids {
  std::vector<std::string> names;
  std::vector<Fluid> of;
  static constexpr ComponentInfo info{"fluids", "rho_k, mu_k", "kg/m^3, Pa s", Lifetime::constant};
};

namespace particle {

/// Which of the liquids the particle is of. [1]
struct FluidIndex : Column<Particles, std::int64_t> {
  static constexpr ComponentInfo info{"particle.fluid", "k_p", "1", Lifetime::state};
};

}  // namespace particle

namespace face {

/// Volume of the particles around a face. [m^3; m^2 in 2-D]
template <int Dim>
struct LiquidVolume : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.liquid_volume", "V~_f", "m^d", Lifetime::scratch};
};

/// Density of the liquids around a face. [kg/m^3]
template <int Dim>
struct Density : Column<Staggered, Vec<Dim>> {
  static constexpr ComponentInfo info{"face.density", "rho_f", "kg/m^3", Lifetime::scratch};
};

}  // namespace face
}  // namespace minamo
