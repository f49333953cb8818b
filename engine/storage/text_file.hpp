#pragma once
/// \file
/// Small files that are there whole or not at all.

#include <filesystem>
#include <string>

namespace minamo {

/// Writes bytes to a file that appears when it is complete, in the place of the one before.
/// \throws std::runtime_error if it cannot be written; the one before stays
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace minamo
