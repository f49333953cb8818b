#include "systems/output/surface/level_set.hpp"

#ifdef MINAMO_OPENVDB
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <sstream>
#else
#include <stdexcept>
#endif

namespace minamo {

#ifdef MINAMO_OPENVDB

namespace {

constexpr float band = 3;  // to either side [voxel]

openvdb::Vec3s vector_of(const Vec<3>& x) { return openvdb::Vec3s(openvdb::Vec3d(x[0], x[1], x[2])); }

/// Velocity of the triangle that is nearest to each voxel of the band: the mean of its corners.
openvdb::Vec3SGrid::Ptr velocities(const ParticleSurface<3>& surface, const openvdb::FloatGrid& distance,
                                   const openvdb::Int32Grid& nearest) {
  const auto velocity = openvdb::Vec3SGrid::create();
  auto into = velocity->getAccessor();
  const auto triangle_at = nearest.getConstAccessor();
  for (auto voxel = distance.cbeginValueOn(); voxel; ++voxel) {
    Vec<3> mean = Vec<3>::Zero();
    for (const std::uint32_t corner :
         surface.outline.element[static_cast<std::size_t>(triangle_at.getValue(voxel.getCoord()))]) {
      mean += surface.velocity[corner] / 3;
    }
    into.setValue(voxel.getCoord(), vector_of(mean));
  }
  return velocity;
}

}  // namespace

bool can_write_level_sets() { return true; }

std::string level_set_of(const ParticleSurface<3>& surface, double voxel) {
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  std::vector<openvdb::Vec3s> points;  // [voxel]
  std::vector<openvdb::Vec4I> triangles;
  for (const Vec<3>& x : surface.outline.point) points.push_back(vector_of(x / voxel));
  for (const auto& corners : surface.outline.element) {
    triangles.emplace_back(corners[0], corners[1], corners[2], openvdb::util::INVALID_IDX);
  }
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec4I> mesh(points, triangles);
  openvdb::Int32Grid nearest(0);
  const auto distance = openvdb::tools::meshToVolume<openvdb::FloatGrid>(mesh, *transform, band, band, 0, &nearest);
  distance->setName("surface");
  distance->setGridClass(openvdb::GRID_LEVEL_SET);
  const auto velocity = velocities(surface, *distance, nearest);
  velocity->setName("velocity");
  velocity->setTransform(transform->copy());
  velocity->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  std::ostringstream bytes;
  openvdb::io::Stream(bytes).write(openvdb::GridCPtrVec{distance, velocity});
  return bytes.str();
}

#else

bool can_write_level_sets() { return false; }

std::string level_set_of(const ParticleSurface<3>&, double) { throw std::logic_error("built without OpenVDB"); }

#endif

}  // namespace minamo
