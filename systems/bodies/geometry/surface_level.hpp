#pragma once
/// \file
/// (E123) Mass of faces at bodies near the free surface. Water rests only if faces on the same level of its surface
/// are equally full, or gravity drives a whirl in the corner of surface and wall. Particles in what a body leaves of a
/// face tell how full it is to some hundredths, whole faces nearby tell it exactly.

#include "components/body.hpp"
#include "components/staggered.hpp"
#include "systems/grid/splines.hpp"
#include "systems/momentum/face_density.hpp"

namespace minamo {

/// The faces of one direction, and what bodies leave open around them.
template <int Dim>
struct FacesOnLevels {
  const Splines<Dim>& splines;
  const SiteRows<Dim>& rows;
  std::span<const Index<Dim>> site;
  std::span<const Vec<Dim>> open_volume;  ///< of faces [1]
  std::span<const double> open_share;     ///< of multipliers [1]
  std::span<const double> phi;            ///< fill fraction of multipliers, zero where no particle is [1]
  std::span<const Vec<Dim>> m_f;          ///< of the particles; a face without any tells nothing [kg]
  std::size_t direction;
  double cell_volume;  ///< [m^d]
  FaceDensity<Dim> density;
};

/// (E123)
/// \param cut   rows of faces of which a body takes a part
/// \param mass  by row and direction, of faces that are cut as if they were whole: before by their own particles, after
///              by the whole faces on their level, too [kg]
template <int Dim>
void level_with_surface(const FacesOnLevels<Dim>& faces, std::vector<std::uint32_t> cut, std::span<Vec<Dim>> mass);

}  // namespace minamo
