#pragma once
/// \file
/// The one number per variant that a study compares: what it is, and how it comes out of a finished run.

#include "engine/input/input.hpp"
#include "engine/storage/world.hpp"
#include "systems/scene/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace minamo {

/// "velocity" or "pressure": against the `exact` block of the scene, at the end. "overlap": the largest of the run.
struct ErrorOfSummary {
  std::string name;
};

/// |mean of an expression in columns of history.csv over a time / target - 1|.
struct ErrorOfHistory {
  std::string expression;
  double target = 0;  ///< in the unit of the expression
  double from = 0;    ///< [s]
  double to = 0;      ///< [s]
};

/// |r / exact - 1|, r the largest distance of a particle from the centre of mass at the end.
struct ErrorOfFarthest {
  double exact = 0;  ///< [m]
};

/// What a program finds in the folder of a run: the one number that it prints.
struct ErrorOfProgram {
  std::string program;  ///< path
  std::vector<std::string> arguments;
  std::string label;  ///< of the axis
};

using ErrorMeasure = std::variant<ErrorOfSummary, ErrorOfHistory, ErrorOfFarthest, ErrorOfProgram>;

/// Reads the key `error`; problems are noted.
ErrorMeasure read_error_measure(Input& input);

/// What of the measure a scene cannot give. `file` is the study.
std::vector<Problem> missing_for(const ErrorMeasure& measure, const Scene& scene, const std::string& file);

/// As the axis of the picture shows it.
std::string error_label(const ErrorMeasure& measure);

/// What a run that is done has left to measure.
struct FinishedRun {
  std::filesystem::path folder;
  Json summary;
  double farthest = 0;  ///< see farthest_distance() [m]
};

/// The error of a run that is done; none where it is not finite.
/// \throws std::runtime_error if a program fails or prints no number.
std::optional<double> error_of(const ErrorMeasure& measure, const FinishedRun& run);

/// Largest distance of a particle from the centre of mass. [m]
double farthest_distance(World& world, int dimension);

}  // namespace minamo
