#pragma once
/// \file
/// fields.h5 and fields.xdmf: what particles carry, at every output time. /particles/{frame}/{position, velocity,
/// pressure, id, ...}, attribute `time`. Vectors have three components and tensors nine, in 2-D too, as
/// ParaView's filters want them; position, which it takes for points, has as many as the scene. Bodies are in
/// body_fields.hpp.

#include "components/fluids.hpp"
#include "components/grid.hpp"
#include "components/node.hpp"
#include "components/particle.hpp"
#include "components/rheology.hpp"
#include "components/sites.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/geometry/outlines.hpp"
#include "systems/output/fields_file.hpp"

namespace minamo {

/// (E33)  p_p = sum_I S_I(y_p) p_I.
template <int Dim>
struct SamplePressure {
  static constexpr Doc doc = "(E33) p_p";
  void operator()(Read<Grid<Dim>> grid, Read<NodeIndex<Dim>> rows, Read<particle::QuadraturePosition<Dim>> y_p,
                  Read<node::Pressure> p_i, Write<particle::Pressure> p_p) const;
};

/// Adds a frame to fields.h5; a velocity gradient row by row. write_xdmf shows it to readers; until then
/// take_back_frame() undoes it. \throws std::runtime_error if the file cannot be written.
template <int Dim>
struct WriteFrame {
  static constexpr Doc doc = "a frame of fields.h5";
  void operator()(Read<Clock> clock, Read<FieldsChoice> choice, Read<particle::Id> id,
                  Read<particle::Position<Dim>> x_p, Read<particle::Velocity<Dim>> v_p, Read<particle::Pressure> p_p,
                  Read<particle::Mass> m_p, Read<particle::Volume> V_p,
                  Optional<Read<particle::VelocityGradient<Dim>>> grad_v_p, Optional<Read<particle::ShearRate>> g_p,
                  Optional<Read<particle::Viscosity>> mu_p, Optional<Read<particle::FluidIndex>> k_p,
                  Optional<Read<Ranks>> ranks, Update<FieldsFile> fields) const;
};

/// Shows the frame in fields.h5, and in fields.xdmf, the index that ParaView opens. With bodies a frame is a collection
/// of particles and bodies.
template <int Dim>
struct WriteXdmf {
  static constexpr Doc doc = "fields.xdmf";
  void operator()(Optional<Read<BodyOutlines<Dim>>> outlines, Update<FieldsFile> fields) const;
};

}  // namespace minamo
