#include "systems/output/history.hpp"

#include "engine/storage/file_error.hpp"
#include "engine/storage/text_file.hpp"

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>

namespace minamo {

namespace {

namespace fs = std::filesystem;

template <int Dim>
RunTotals::Values values(const measure::Energy& energy, const measure::Momentum<Dim>& momentum) {
  RunTotals::Values values{.energy = energy.total(), .momentum = {}, .angular_momentum = {}};
  for (int d = 0; d < Dim; ++d) values.momentum[static_cast<std::size_t>(d)] = momentum.linear[d];
  for (int d = 0; d < rotations<Dim>; ++d) values.angular_momentum[static_cast<std::size_t>(d)] = momentum.angular[d];
  return values;
}

void require_known(const measure::Columns& further, std::int64_t known) {
  const auto count = static_cast<std::int64_t>(further.columns.size());
  if (count <= known) return;
  throw std::runtime_error(fmt::format("column {} of history.csv was not measured at the start",
                                       further.columns[static_cast<std::size_t>(known)].name));
}

/// Sets `last` to the value of a column, if it has one.
void keep_measured(const measure::Columns& columns, std::string_view name, double& last) {
  const double* value = columns.find(name);
  if (value != nullptr && !std::isnan(*value)) last = *value;
}

/// The totals with one more row.
template <int Dim>
RunTotals added(RunTotals totals, const Clock& clock, const measure::Energy& energy,
                const measure::EnergyBalance& balance, const measure::Momentum<Dim>& momentum,
                const measure::Columns& further) {
  const bool is_start = totals.rows == 0;
  totals.last = values<Dim>(energy, momentum);
  if (is_start) totals.first = totals.last;
  if (is_start) totals.columns = static_cast<std::int64_t>(further.columns.size());
  require_known(further, totals.columns);
  const double stored = energy.potential.value_or(0) + energy.surface.value_or(0);
  const EnergyScales scales{.exchanged = balance.exchanged, .unresolved = energy.unresolved};
  if (is_start) {
    totals.energy.start(energy.kinetic, stored, scales);
  } else {
    totals.energy.see(clock.end_of_step, balance.value, energy.kinetic, stored, scales);
  }
  keep_measured(further, "error_velocity", totals.error_velocity);
  keep_measured(further, "error_pressure", totals.error_pressure);
  ++totals.rows;
  return totals;
}

/// What was not measured is an empty cell.
void append_cells(const std::vector<measure::Columns::Column>& columns, fmt::memory_buffer& row) {
  for (const auto& column : columns) {
    row.push_back(',');
    if (!std::isnan(column.value)) fmt::format_to(std::back_inserter(row), "{}", column.value);
  }
}

/// \pre errno was 0 before the file was written to
void require_written(HistoryFile& history) {
  if (history.file) return;
  // Once it has failed nothing is tried any more.
  if (errno != 0) history.error = errno;
  throw std::runtime_error(not_written(history.path.empty() ? "history.csv" : history.path, history.error));
}

/// The units of the columns, in a file of their own: who reads history.csv takes what is behind its first line for
/// numbers.
template <int Dim>
void write_units(const std::string& history, const measure::Columns& further) {
  nlohmann::ordered_json units;
  for (const auto& [column, unit] : history_units<Dim>(further)) units[column] = unit;
  write_text(fs::path(history).replace_filename(history_units_name), units.dump(2) + "\n");
}

}  // namespace

template <int Dim>
std::vector<std::pair<std::string, std::string>> history_units(const measure::Columns& further) {
  const char* energy = Dim == 2 ? "J/m" : "J";
  std::vector<std::pair<std::string, std::string>> units{
      {"step", "1"}, {"time", "s"}, {"dt", "s"}, {"kinetic_energy", energy}, {"potential_energy", energy}};
  const auto add_vector = [&](const char* name, int size, const char* unit) {
    for (int d = 0; d < size; ++d) units.emplace_back(size == 1 ? name : fmt::format("{}_{}", name, "xyz"[d]), unit);
  };
  add_vector("momentum", Dim, Dim == 2 ? "kg/s" : "kg m/s");
  add_vector("angular_momentum", rotations<Dim>, Dim == 2 ? "kg m/s" : "kg m^2/s");
  units.insert(units.end(), {{"max_speed", "m/s"},
                             {"max_divergence", "1/s"},
                             {"overlap", "1"},
                             {"active_nodes", "1"},
                             {"iterations", "1"},
                             {"residual", "1"}});
  for (const auto& column : further.columns) units.emplace_back(column.name, column.unit.empty() ? "1" : column.unit);
  return units;
}

template <int Dim>
std::string history_header(const measure::Columns& further) {
  std::string names;
  for (const auto& [column, unit] : history_units<Dim>(further)) names += (names.empty() ? "" : ",") + column;
  return names;
}

void flush(HistoryFile& history) {
  errno = 0;
  history.file.flush();
  require_written(history);
}

const RunTotals& totals_of_all_rows(World& world) {
  const auto& extra = world.resource<HistoryFile>().extra;
  const bool has_extra = extra && extra->step == world.resource<Clock>().index;
  return has_extra ? extra->totals : world.resource<RunTotals>();
}

template <int Dim>
void WriteHistory<Dim>::operator()(Read<Clock> clock, Read<measure::Energy> energy,
                                   Read<measure::EnergyBalance> balance, Read<measure::Momentum<Dim>> momentum,
                                   Read<measure::MaxSpeed> speed, Read<measure::MaxDivergence> divergence,
                                   Read<measure::Overlap> overlap, Read<SolveReport> solve,
                                   Read<measure::Columns> further, Read<HistoryInterval> every,
                                   Update<RunTotals> totals, Update<HistoryFile> history) const {
  // The row of the start has no step behind it.
  const bool is_start = totals->rows == 0;
  const std::int64_t step = is_start ? 0 : clock->index + 1;
  const RunTotals with_row = added<Dim>(*totals, *clock, *energy, *balance, *momentum, *further);
  history->extra.reset();
  if (step % every->steps == 0) {
    *totals = with_row;
  } else {
    history->extra = {step, with_row};
  }
  if (!history->file.is_open() && !history->keeps_row) return;

  errno = 0;
  if (is_start && history->file.is_open()) {
    if (!history->path.empty()) write_units<Dim>(history->path, *further);
    history->file << history_header<Dim>(*further) << '\n';
  }
  fmt::memory_buffer row;
  const auto out = std::back_inserter(row);
  fmt::format_to(out, "{},{},{},{},", step, is_start ? clock->time : clock->end_of_step, is_start ? 0 : clock->step,
                 energy->kinetic);
  if (energy->potential) fmt::format_to(out, "{}", *energy->potential);
  for (int d = 0; d < Dim; ++d) fmt::format_to(out, ",{}", momentum->linear[d]);
  for (int d = 0; d < rotations<Dim>; ++d) fmt::format_to(out, ",{}", momentum->angular[d]);
  fmt::format_to(out, ",{},{},{},{},{},{}", speed->value, divergence->value, overlap->value, solve->active,
                 solve->iterations, solve->residual);
  append_cells(further->columns, row);
  if (history->keeps_row) history->row.assign(row.data(), row.size());
  if (!history->file.is_open()) return;
  row.push_back('\n');
  history->file.write(row.data(), static_cast<std::streamsize>(row.size()));
  history->rows = with_row.rows;
  history->row_bytes = row.size();
  require_written(*history);
}

template <int Dim>
void FlushHistory<Dim>::operator()(Update<HistoryFile> history) const {
  if (history->file.is_open()) flush(*history);
}

void take_back_row(HistoryFile& history) {
  flush(history);
  history.file.close();
  fs::resize_file(history.path, fs::file_size(history.path) - history.row_bytes);
  history.file.open(history.path, std::ios::app);
  --history.rows;
}

std::int64_t cut_history(const std::string& path, std::int64_t rows) {
  std::ifstream file(path, std::ios::binary);
  std::int64_t lines = 0;
  std::streamoff end = 0;
  for (std::string line; lines < rows + 1 && std::getline(file, line) && !file.eof(); ++lines) end = file.tellg();
  file.close();
  fs::resize_file(path, static_cast<std::uintmax_t>(end));
  return lines - 1;
}

template std::vector<std::pair<std::string, std::string>> history_units<2>(const measure::Columns&);
template std::vector<std::pair<std::string, std::string>> history_units<3>(const measure::Columns&);
template std::string history_header<2>(const measure::Columns&);
template std::string history_header<3>(const measure::Columns&);
template struct WriteHistory<2>;
template struct WriteHistory<3>;
template struct FlushHistory<2>;
template struct FlushHistory<3>;

}  // namespace minamo
