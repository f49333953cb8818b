#pragma once
/// \file
/// The run whose results a folder has already: whether it came to its end, and what becomes of it.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace minamo {

struct EarlierRun {
  std::string scene;          ///< its file; empty if nobody knows
  std::string ended;          ///< how, as in "interrupted"
  double time = 0;            ///< at which it ended [s]
  std::optional<double> end;  ///< of its scene [s]
  std::int64_t steps = 0;
  bool is_finished = false;

  /// Whether something would be lost with it that took time: it is not finished, and not at its start.
  bool is_worth_keeping() const { return !is_finished && steps > 0; }
};

/// What summary.json and checkpoint.h5 say of the results in a folder; nothing if there are none. A run that was killed
/// has no summary.
std::optional<EarlierRun> earlier_run(const std::filesystem::path& folder);

/// \throws InputError: a new run would replace this one, and nobody has said that it may
[[noreturn]] void refuse_to_replace(const EarlierRun& run, const std::filesystem::path& folder);

/// Says in a line that the results in a folder are replaced.
/// \param scene  of the new run; that the results are another scene's is told even to who wants to hear of problems
/// only
void tell_of_replaced(const EarlierRun& run, const std::filesystem::path& folder, const std::string& scene, bool quiet);

}  // namespace minamo
