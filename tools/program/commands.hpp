#pragma once
/// \file
/// The commands of the program. Each prints to stdout and returns the exit code; bad input is thrown as InputError.

#include "engine/schedule/registry.hpp"

#include <optional>
#include <string>
#include <vector>

namespace minamo {

inline constexpr int exit_done = 0;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_failed = 3;
inline constexpr int exit_interrupted = 130;

struct RunOptions {
  std::string scene;
  std::string out;                     ///< empty: out/NAME
  int threads = 0;                     ///< 0: all processors
  std::vector<std::string> overrides;  ///< /pointer=JSON
  std::optional<std::int64_t> steps;
  bool resume = false;
  bool overwrite = false;
  bool profile = false;
  std::string trace;  ///< empty: OUT/trace.json
  bool quiet = false;
};

struct StudyOptions {
  std::string study;
  std::string out;  ///< empty: out/studies/NAME
  int threads = 0;  ///< 0: all processors
  bool quiet = false;
};

int run_scene(const RunOptions& options, const SystemRegistry& registry);
int run_study(const StudyOptions& options, const SystemRegistry& registry);
int check_scenes(const std::vector<std::string>& scenes, const SystemRegistry& registry);
int show_graph(const std::string& scene, const std::string& format, const SystemRegistry& registry);
int list(const std::string& what, const SystemRegistry& registry);
int show_schema(bool as_table, const SystemRegistry& registry);

}  // namespace minamo
