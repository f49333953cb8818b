#pragma once
/// \file
/// study.png, drawn by tools/plot_study.py, which is part of the program.

#include <filesystem>
#include <string>

namespace minamo {

/// Draws study.png beside `csv`.
/// \return whether it is drawn; if not, a line on stderr says what is missing.
bool draw_study(const std::filesystem::path& csv, const std::string& title, const std::string& error_label);

}  // namespace minamo
