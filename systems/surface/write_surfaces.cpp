#include "systems/surface/write_surfaces.hpp"

#include "engine/text_file.hpp"
#include "systems/bodies/cut.hpp"
#include "systems/ranks/gathered.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <optional>

namespace minamo {

namespace {

std::string file_of(std::size_t frame, SurfaceFormat format) { return fmt::format("{:04}.{}", frame, name_of(format)); }

/// The index of all frames, which ParaView opens.
void write_index(const FieldsFile& fields, SurfaceFormat format) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (std::size_t k = 0; k < fields.frames.size(); ++k)
    text += fmt::format("<DataSet timestep=\"{}\" file=\"surface/{}\"/>\n", fields.frames[k].time, file_of(k, format));
  write_text(fields.folder + "/surface.pvd", text + "</Collection>\n</VTKFile>\n");
}

}  // namespace

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
  std::filesystem::create_directories(fields->folder + "/surface");
  const std::size_t frame = fields->frames.size() - 1;
  write_surface<Dim>(surface_of<Dim>(of), output->format, output->spacing,
                     fields->folder + "/surface/" + file_of(frame, output->format));
  if (output->format == SurfaceFormat::vtp) write_index(*fields, output->format);
}

template struct WriteSurfaces<2>;
template struct WriteSurfaces<3>;

}  // namespace minamo
