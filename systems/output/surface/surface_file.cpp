#include "systems/output/surface/surface_file.hpp"

#include "engine/storage/text_file.hpp"
#include "systems/output/surface/level_set.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <utility>

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

/// An array of the appended data: what the head says of it, and how many bytes it has.
struct Array {
  const char* type;
  const char* name;
  int components;
  std::uint64_t bytes;
};

/// Where the arrays begin: each after its size in 8 bytes.
std::string declared(const Array& array, std::uint64_t& offset) {
  const std::uint64_t begin = std::exchange(offset, offset + sizeof(std::uint64_t) + array.bytes);
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", array.type,
      array.name, array.components, begin);
}

template <int Dim>
std::string vtp(const ParticleSurface<Dim>& surface) {
  const auto& [points, elements] = surface.outline;
  const std::uint64_t vectors = points.size() * 3 * sizeof(float);
  const Array velocities{"Float32", "velocity", 3, vectors};
  const Array places{"Float32", "position", 3, vectors};
  const Array corners{"Int32", "connectivity", 1, elements.size() * Dim * sizeof(std::int32_t)};
  const Array ends{"Int32", "offsets", 1, elements.size() * sizeof(std::int32_t)};
  std::uint64_t bytes = 0;
  const char* kind = Dim == 2 ? "Lines" : "Polys";
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      points.size(), Dim == 2 ? elements.size() : 0, Dim == 2 ? 0 : elements.size());
  text += "<PointData Vectors=\"velocity\">\n" + declared(velocities, bytes) + "</PointData>\n";
  text += "<Points>\n" + declared(places, bytes) + "</Points>\n";
  text += fmt::format("<{}>\n", kind) + declared(corners, bytes);
  text += declared(ends, bytes) + fmt::format("</{}>\n", kind);
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  constexpr std::string_view tail = "\n</AppendedData>\n</VTKFile>\n";
  text.reserve(text.size() + bytes + tail.size());
  append(text, velocities.bytes);
  for (const Vec<Dim>& v : surface.velocity) append_vector<Dim>(text, v);
  append(text, places.bytes);
  for (const Vec<Dim>& x : points) append_vector<Dim>(text, x);
  append(text, corners.bytes);
  for (const auto& element : elements)
    for (const std::uint32_t corner : element) append(text, static_cast<std::int32_t>(corner));
  append(text, ends.bytes);
  for (std::size_t k = 0; k < elements.size(); ++k) append(text, static_cast<std::int32_t>(Dim * (k + 1)));
  return text.append(tail);
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
