#pragma once
/// \file
/// history.csv: a row of the start, of every n-th step and of the last one.

#include "components/fluid.hpp"
#include "components/matrix.hpp"
#include "components/measure.hpp"
#include "engine/run/clock.hpp"
#include "engine/run/linear_solver.hpp"
#include "engine/schedule/system.hpp"
#include "systems/measure/energy_watch.hpp"

#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace minamo {

struct HistoryInterval {
  std::int64_t steps = 1;
  static constexpr ComponentInfo info{"history.interval", "", "1", Lifetime::constant};
};

/// What the rows of a run add up to.
struct RunTotals {
  struct Values {
    double energy = 0;                         ///< kinetic, and potential where it exists [J]
    std::array<double, 3> momentum{};          ///< [kg m/s]
    std::array<double, 3> angular_momentum{};  ///< [kg m^2/s]
  };
  Values first;
  Values last;
  EnergyWatch energy;
  std::int64_t rows = 0;
  std::int64_t columns = 0;  ///< of measure::Columns
  // The last that were measured; NaN: none was.
  double error_velocity = std::numeric_limits<double>::quiet_NaN();
  double error_pressure = std::numeric_limits<double>::quiet_NaN();
  static constexpr ComponentInfo info{"history.totals", "", "", Lifetime::state};
};

/// Where the history goes; nothing is written while it is closed.
struct HistoryFile {
  /// The row of a step whose turn it is not, the last of a run. A run that goes on from there does not have it: no
  /// state knows of it.
  struct ExtraRow {
    std::int64_t step = 0;
    RunTotals totals;  ///< with it
  };
  std::ofstream file;
  std::string path;           ///< with its units next to it; empty: none
  std::int64_t rows = 0;      ///< written, among them that of a step which is taken back
  std::size_t row_bytes = 0;  ///< of the last one
  int error = 0;              ///< errno of what went wrong
  std::optional<ExtraRow> extra;
  bool keeps_row = false;  ///< for who reads the rows as they come
  std::string row;         ///< the last one, without its end
  static constexpr ComponentInfo info{"history.file", "", "", Lifetime::cache};
};

/// With the row of the last step, whether or not it was its turn.
const RunTotals& totals_of_all_rows(World& world);

/// A file next to history.csv with the units of its columns.
inline constexpr const char* history_units_name = "history.units.json";

/// The columns of history.csv and their units, in 2-D those per metre of depth.
template <int Dim>
std::vector<std::pair<std::string, std::string>> history_units(const measure::Columns& further);

/// What has been written is on the disk. \throws std::runtime_error
void flush(HistoryFile& history);

/// The first line of history.csv, without its end.
template <int Dim>
std::string history_header(const measure::Columns& further);

/// Takes back the last row of a history, at the same cost however long that is. \throws std::runtime_error
void take_back_row(HistoryFile& history);

/// Cuts a history off behind so many rows, or behind its last whole one.
/// \return how many it has then; -1 for a file without header
/// \throws std::filesystem::filesystem_error
std::int64_t cut_history(const std::string& path, std::int64_t rows);

/// Header and units come with the first row, because it is then that measure::Columns knows its names.
/// \throws std::runtime_error if a system sets a column that the header does not have, or if writing fails.
template <int Dim>
struct WriteHistory {
  static constexpr Doc doc = "a row of history.csv";
  void operator()(Read<Clock> clock, Read<measure::Energy> energy, Read<measure::EnergyBalance> balance,
                  Read<measure::Momentum<Dim>> momentum, Read<measure::MaxSpeed> speed,
                  Read<measure::MaxDivergence> divergence, Read<measure::Overlap> overlap, Read<SolveReport> solve,
                  Read<measure::Columns> further, Read<HistoryInterval> every, Update<RunTotals> totals,
                  Update<HistoryFile> history) const;
};

/// So that the rows on the disk reach as far as the frames.
template <int Dim>
struct FlushHistory {
  static constexpr Doc doc = "the rows of history.csv so far, on the disk";
  /// \throws std::runtime_error if writing fails.
  void operator()(Update<HistoryFile> history) const;
};

}  // namespace minamo
