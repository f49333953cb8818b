#pragma once
/// \file
/// The free surface in 3-D as an OpenVDB level set, for renderers and sculptors. Only in a build with OpenVDB, the
/// option MINAMO_OPENVDB.

#include "systems/output/surface/particle_surface.hpp"

#include <string>

namespace minamo {

/// Whether this build has OpenVDB.
bool can_write_level_sets();

/// The bytes of a file with two grids: "surface", the signed distance, negative in the liquid, three voxels to either
/// side [m], and "velocity", that of the nearest point of the surface in the same voxels [m/s].
/// \param voxel  edge length [m]
/// \pre can_write_level_sets()
std::string level_set_of(const ParticleSurface<3>& surface, double voxel);

}  // namespace minamo
