#pragma once
/// \file
/// (E122) How full faces beside bodies would be if nothing were cut away, by those on the same level of the surface.

#include "components/staggered.hpp"
#include "systems/conforming/splines.hpp"

namespace minamo {

/// Fill fractions of the faces of one direction, by row.
struct FacesOfDirection {
  std::size_t direction;
  std::span<std::uint8_t> is_known;         ///< nothing is cut away
  std::span<const std::uint32_t> unknown;   ///< rows of faces to find
  std::span<double> fill;                   ///< of unknown ones the estimate by their own particles [1]
};

/// (E122)
template <int Dim>
void level_with_surface(const Splines<Dim>& splines, const StaggeredIndex<Dim>& rows,
                        std::span<const Index<Dim>> site, const FacesOfDirection& faces);

}  // namespace minamo
