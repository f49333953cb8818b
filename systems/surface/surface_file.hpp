#pragma once
/// \file
/// Files of surfaces, binary: VTP for ParaView, PLY for Blender and others.

#include "systems/surface/particle_surface.hpp"

#include <string>

namespace minamo {

enum class SurfaceFormat { vtp, ply };

/// "vtp" or "ply", which end the names of the files, too.
std::string name_of(SurfaceFormat format);

/// Points, their velocities, and lines or triangles. In the plane z is zero. Numbers have 4 bytes. The file appears
/// when it is complete. \throws std::runtime_error if it cannot be written
template <int Dim>
void write_surface(const ParticleSurface<Dim>& surface, SurfaceFormat format, const std::string& path);

}  // namespace minamo
