#pragma once
/// \file
/// The files of surfaces in the folder of a run: their names, the index of those that are there, and their end.

#include "systems/output/fields_file.hpp"
#include "systems/output/surface/surface_file.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace minamo {

/// surface/NNNN.EXT in the folder of a run.
std::filesystem::path surface_path(const std::filesystem::path& folder, std::size_t frame, SurfaceFormat format);

/// The frame whose surface a file in the folder of a run holds, by its name and whatever its format; none of files that
/// no run writes.
std::optional<std::size_t> frame_of_surface(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Adds the VTP file of the frame that is being written. \throws std::runtime_error if it cannot be written
void add_to_surface_index(FieldsFile& fields);

/// Removes the surfaces of a frame and of all later ones, of every format, and no other file.
/// \throws std::filesystem::filesystem_error
void remove_surfaces(const std::filesystem::path& folder, std::size_t from);

}  // namespace minamo
