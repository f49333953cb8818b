#include "systems/output/surface/write_surfaces.hpp"

#include "systems/bodies/geometry/cut.hpp"
#include "systems/output/surface/surface_folder.hpp"
#include "systems/ranks/gathered.hpp"

#include <filesystem>
#include <optional>

namespace minamo {

template <int Dim>
void WriteSurfaces<Dim>::operator()(Read<Grid<Dim>> grid, Read<SurfaceOutput> output, Read<particle::Position<Dim>> x_p,
                                    Read<particle::Velocity<Dim>> v_p, Read<particle::Volume> V_p,
                                    Optional<Read<BodySet<Dim>>> set, Optional<Read<body::Position<Dim>>> c_b,
                                    Optional<Read<body::Rotation<Dim>>> R_b, Optional<Read<Ranks>> ranks,
                                    Update<FieldsFile> fields) const {
  if (fields->folder.empty() && !ranks) return;
  SurfaceOf<Dim> of{{grid->low, grid->high}, output->spacing, x_p.span(), v_p.span(), V_p.span(), {}};
  std::vector<Vec<Dim>> x;
  std::vector<Vec<Dim>> v;
  std::vector<double> V;
  if (ranks) {
    Communicator& all = *ranks->all;
    x = gathered(all, x_p.span());
    v = gathered(all, v_p.span());
    V = gathered(all, V_p.span());
    if (fields->folder.empty()) return;  // that of the first rank alone is known
    of.position = x;
    of.velocity = v;
    of.volume = V;
  }
  std::optional<PlacedBodies<Dim>> bodies;
  if (set) {
    bodies.emplace(*set, c_b.span(), R_b.span());
    of.distance_to_bodies = [&](const Vec<Dim>& point) { return bodies->distance(point); };
  }
  const auto path = surface_path(fields->folder, fields->frames - 1, output->format);
  std::filesystem::create_directories(path.parent_path());
  write_surface<Dim>(surface_of<Dim>(of), output->format, output->spacing, path.string());
  if (output->format == SurfaceFormat::vtp) add_to_surface_index(*fields);
}

template struct WriteSurfaces<2>;
template struct WriteSurfaces<3>;

}  // namespace minamo
