#include "systems/surface/surface_file.hpp"

#include "engine/text_file.hpp"
#include "systems/surface/level_set.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace minamo {

namespace {

static_assert(std::endian::native == std::endian::little, "the files say that their numbers are little-endian");

template <class Number>
void append(std::string& bytes, Number value) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), &value, sizeof(Number));
  bytes.append(raw.data(), raw.size());
}

template <int Dim>
void append_vector(std::string& bytes, const Vec<Dim>& vector) {
  for (Eigen::Index d = 0; d < 3; ++d) append(bytes, static_cast<float>(d < Dim ? vector[d] : 0));
}

/// An array of the appended data, after its size in bytes.
class Appended {
 public:
  /// \return where it begins
  std::size_t add(const std::string& array) {
    const std::size_t offset = bytes_.size();
    append(bytes_, static_cast<std::uint64_t>(array.size()));
    bytes_ += array;
    return offset;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

template <int Dim>
std::string vtp(const ParticleSurface<Dim>& surface) {
  const auto& [points, elements] = surface.outline;
  std::string places;
  std::string velocities;
  std::string corners;
  std::string ends;
  for (const Vec<Dim>& x : points) append_vector<Dim>(places, x);
  for (const Vec<Dim>& v : surface.velocity) append_vector<Dim>(velocities, v);
  for (std::size_t k = 0; k < elements.size(); ++k) {
    for (const std::uint32_t corner : elements[k]) append(corners, static_cast<std::int32_t>(corner));
    append(ends, static_cast<std::int32_t>(Dim * (k + 1)));
  }
  Appended data;
  const auto array = [&](const char* type, const char* name, int components, const std::string& bytes) {
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type,
        name, components, data.add(bytes));
  };
  const char* kind = Dim == 2 ? "Lines" : "Polys";
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      points.size(), Dim == 2 ? elements.size() : 0, Dim == 2 ? 0 : elements.size());
  text += "<PointData Vectors=\"velocity\">\n" + array("Float32", "velocity", 3, velocities) + "</PointData>\n";
  text += "<Points>\n" + array("Float32", "position", 3, places) + "</Points>\n";
  text += fmt::format("<{}>\n", kind) + array("Int32", "connectivity", 1, corners) +
          array("Int32", "offsets", 1, ends) + fmt::format("</{}>\n", kind);
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return text + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

template <int Dim>
std::string ply(const ParticleSurface<Dim>& surface) {
  const auto& [points, elements] = surface.outline;
  std::string text =
      fmt::format("ply\nformat binary_little_endian 1.0\ncomment minamo\nelement vertex {}\n", points.size());
  for (const char* name : {"x", "y", "z", "vx", "vy", "vz"}) text += fmt::format("property float {}\n", name);
  if (Dim == 2) {
    text += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\nend_header\n", elements.size());
  } else {
    text += fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", elements.size());
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    append_vector<Dim>(text, points[k]);
    append_vector<Dim>(text, surface.velocity[k]);
  }
  for (const auto& element : elements) {
    if (Dim == 3) append(text, static_cast<std::uint8_t>(Dim));
    for (const std::uint32_t corner : element) append(text, static_cast<std::int32_t>(corner));
  }
  return text;
}

constexpr std::array names{"vtp", "ply", "vdb"};

template <int Dim>
std::string bytes_of(const ParticleSurface<Dim>& surface, SurfaceFormat format, double voxel) {
  if constexpr (Dim == 3) {
    if (format == SurfaceFormat::vdb) return level_set_of(surface, voxel);
  }
  return format == SurfaceFormat::vtp ? vtp<Dim>(surface) : ply<Dim>(surface);
}

}  // namespace

std::string name_of(SurfaceFormat format) { return names[static_cast<std::size_t>(format)]; }

SurfaceFormat surface_format_of(const std::string& name) {
  return static_cast<SurfaceFormat>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <int Dim>
void write_surface(const ParticleSurface<Dim>& surface, SurfaceFormat format, double voxel, const std::string& path) {
  write_text(path, bytes_of<Dim>(surface, format, voxel));
}

template void write_surface<2>(const ParticleSurface<2>&, SurfaceFormat, double, const std::string&);
template void write_surface<3>(const ParticleSurface<3>&, SurfaceFormat, double, const std::string&);

}  // namespace minamo
