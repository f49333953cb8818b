#pragma once
/// \file
/// A file of the surface with every frame, in the folder surface/ of a run.

#include "components/body.hpp"
#include "components/grid.hpp"
#include "components/particle.hpp"
#include "engine/run/communicator.hpp"
#include "engine/schedule/system.hpp"
#include "systems/bodies/body_set.hpp"
#include "systems/output/fields_file.hpp"
#include "systems/output/surface/surface_file.hpp"

namespace minamo {

/// What surfaces are found with and how they are written.
struct SurfaceOutput {
  SurfaceFormat format = SurfaceFormat::vtp;
  double spacing = 0;  ///< of the particles as they were laid out [m]
  static constexpr ComponentInfo info{"surface.output", "", "", Lifetime::constant};
};

/// (E111) as surface/NNNN.vtp, .ply or .vdb, NNNN the number of the frame; of VTP also surface.pvd with their
/// times. Of several ranks the first one gathers the particles of all and writes. \throws std::runtime_error if a file
/// cannot be written
template <int Dim>
struct WriteSurfaces {
  static constexpr Doc doc = "(E111) the surface of a frame, to a file";
  void operator()(Read<Grid<Dim>> grid, Read<SurfaceOutput> output, Read<particle::Position<Dim>> x_p,
                  Read<particle::Velocity<Dim>> v_p, Read<particle::Volume> V_p, Optional<Read<BodySet<Dim>>> set,
                  Optional<Read<body::Position<Dim>>> c_b, Optional<Read<body::Rotation<Dim>>> R_b,
                  Optional<Read<Ranks>> ranks, Update<FieldsFile> fields) const;
};

}  // namespace minamo
