#pragma once
/// \file
/// (E85) What moving bodies push through faces, once the motions of free ones are known.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "engine/schedule/system.hpp"
#include "systems/grid/splines.hpp"

namespace minamo {

/// The balance of mass has free bodies with the velocities that (E92) finds, cut_faces only knew those of the start.
template <int Dim>
struct RenewWallFlux {
  static constexpr Doc doc = "(E85) what bodies push through faces, of free ones with (E92)";
  void operator()(Read<Grid<Dim>> grid, Read<Splines<Dim>> splines, Read<body::MiddlePosition<Dim>> c_b,
                  Read<body::MeanVelocity<Dim>> V_b, Read<body::MeanSpin<Dim>> omega_b, Read<staggered::Site<Dim>> site,
                  Read<face::Closed<Dim>> closed, Read<face::Closer<Dim>> closer,
                  Write<face::WallFlux<Dim>> flux) const;
};

}  // namespace minamo
