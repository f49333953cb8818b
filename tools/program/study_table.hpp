#pragma once
/// \file
/// What came of the variants of a study, compared: order, rank and frontier; as a table and as study.csv.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace minamo {

/// One variant that was run.
struct StudyRow {
  std::vector<std::string> values;   ///< one per parameter, as shown
  std::optional<double> resolution;  ///< cells along x [1]
  std::optional<double> error;       ///< none where the run is not done [1]
  double time_step = 0;              ///< of the last step [s]
  double wall_seconds = 0;           ///< of the time loop [s]
  double cpu_seconds = 0;            ///< of the time loop, all threads, per simulated second [1]
  std::int64_t steps = 0;
  std::int64_t particles = 0;
  std::int64_t unknowns_max = 0;
  std::string status;
};

/// What only the other rows tell of a row.
struct Standing {
  std::optional<double> order;  ///< against the next coarser row of the same other values [1]
  std::optional<int> rank;      ///< 1: least cost times error
  bool on_frontier = false;     ///< no other row is both cheaper and more accurate
};

/// What variants are compared by in addition to the error.
enum class Cost { wall, cpu };

struct StudyTable {
  std::vector<std::string> keys;             ///< of the parameters, as in the study
  std::vector<std::string> heads;            ///< of their columns, short
  std::optional<std::size_t> resolution_at;  ///< the parameter that is the resolution
  std::string cpu_model;
  int threads = 1;
  Cost cost = Cost::wall;
  std::vector<StudyRow> rows;
};

/// Wall time of the time loop, or its processor time per simulated second. [s]
double cost_of(const StudyTable& table, const StudyRow& row);

/// One per row. The order is log(e_coarse/e_fine) / log(N_fine/N_coarse).
std::vector<Standing> standings(const StudyTable& table);

/// Aligned columns with units; `*` marks the frontier.
std::string as_text(const StudyTable& table);

std::string as_csv(const StudyTable& table);

}  // namespace minamo
