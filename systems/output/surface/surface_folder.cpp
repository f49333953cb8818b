#include "systems/output/surface/surface_folder.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <vector>

namespace minamo {

namespace {

namespace fs = std::filesystem;

constexpr const char* surface_folder = "surface";

}  // namespace

fs::path surface_path(const fs::path& folder, std::size_t frame, SurfaceFormat format) {
  return folder / surface_folder / fmt::format("{:04}.{}", frame, name_of(format));
}

std::optional<std::size_t> frame_of_surface(const fs::path& folder, const fs::path& file) {
  const std::string number = file.stem().string();
  std::size_t frame = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), frame);
  if (error != std::errc() || end != number.data() + number.size()) return {};
  const auto formats = {SurfaceFormat::vtp, SurfaceFormat::ply, SurfaceFormat::vdb};
  const bool is_ours = std::any_of(formats.begin(), formats.end(), [&](SurfaceFormat format) {
    return surface_path(folder, frame, format) == folder / surface_folder / file.filename();
  });
  return is_ours ? std::optional(frame) : std::nullopt;
}

void add_to_surface_index(FieldsFile& fields) {
  const fs::path file = surface_path(fields.folder, fields.frames - 1, SurfaceFormat::vtp);
  fields.surfaces.append(fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", fields.time,
                                     file.lexically_relative(fields.folder).string()));
}

void remove_surfaces(const fs::path& folder, std::size_t from) {
  if (!fs::is_directory(folder / surface_folder)) return;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder / surface_folder)) {
    const auto frame = frame_of_surface(folder, entry.path());
    if (frame && *frame >= from && entry.is_regular_file()) old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file);
  if (!old.empty() && fs::is_empty(folder / surface_folder)) fs::remove(folder / surface_folder);
}

}  // namespace minamo
