#pragma once
/// \file
/// Bodies in fields.h5: /bodies/outlines/NAME/{points, elements}, once, where the shape is given, and at every output
/// time /bodies/{frame}/NAME/{position, rotation, velocity, spin, angle}, of a moving body the moved points, too.

#include "components/body.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/outlines.hpp"
#include "systems/output/fields_file.hpp"

namespace minamo {

/// Adds the bodies to the frame that write_frame has begun. \throws std::runtime_error if the file cannot be written.
template <int Dim>
struct WriteBodies {
  static constexpr Doc doc = "bodies in a frame of fields.h5";
  void operator()(Read<BodyOutlines<Dim>> outlines, Read<body::Position<Dim>> c_b, Read<body::Rotation<Dim>> R_b,
                  Read<body::Velocity<Dim>> V_b, Read<body::Spin<Dim>> omega_b, Read<body::Angle<Dim>> alpha_b,
                  Update<FieldsFile> fields) const;
};

/// The bodies of a frame as grids of fields.xdmf; none without an outline.
template <int Dim>
std::string body_grids(const BodyOutlines<Dim>& outlines, std::size_t frame);

}  // namespace minamo
