#pragma once
/// \file
/// Files of surfaces, binary: VTP for ParaView, PLY for Blender and others, OpenVDB level sets (level_set.hpp).

#include "systems/output/surface/particle_surface.hpp"

#include <string>

namespace minamo {

enum class SurfaceFormat { vtp, ply, vdb };

/// "vtp", "ply" or "vdb", which end the names of the files, too.
std::string name_of(SurfaceFormat format);
SurfaceFormat surface_format_of(const std::string& name);

/// Points, their velocities, and lines or triangles. In 2-D z is zero. Numbers have 4 bytes. The file appears
/// when it is complete.
/// \param voxel  of level sets, which are in 3-D alone [m]
/// \throws std::runtime_error if it cannot be written
template <int Dim>
void write_surface(const ParticleSurface<Dim>& surface, SurfaceFormat format, double voxel, const std::string& path);

}  // namespace minamo
