#pragma once
/// \file
/// study.png, drawn by tools/plot_study.py, which is part of the program.

#include "tools/program/study_table.hpp"

#include <filesystem>
#include <string>

namespace minamo {

struct PictureLabels {
  std::string title;
  std::string error;
  Cost cost = Cost::wall;
  std::string others;  ///< file of points of others; may be empty
};

/// Draws study.png next to `csv`.
/// \return whether it is drawn; if not, a line on stderr says what is missing.
bool draw_study(const std::filesystem::path& csv, const PictureLabels& labels);

}  // namespace minamo
