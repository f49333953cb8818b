#include "systems/output/history.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace minamo {

namespace {

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

void require_written(const std::ostream& file) {
  if (!file) throw std::runtime_error("history.csv: cannot be written");
}

}  // namespace

template <int Dim>
std::string history_header(const measure::Columns& further) {
  const std::string momentum = Dim == 2 ? "momentum_x,momentum_y,angular_momentum"
                                        : "momentum_x,momentum_y,momentum_z,angular_momentum_x,angular_momentum_y,"
                                          "angular_momentum_z";
  std::string names = "step,time,dt,kinetic_energy,potential_energy," + momentum +
                      ",max_speed,max_divergence,overlap,active_nodes,iterations,residual";
  for (const auto& column : further.columns) names += "," + column.name;
  return names;
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

  if (is_start && history->file.is_open()) history->file << history_header<Dim>(*further) << '\n';
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
  require_written(history->file);
}

template <int Dim>
void FlushHistory<Dim>::operator()(Update<HistoryFile> history) const {
  if (history->file.is_open()) require_written(history->file.flush());
}

std::int64_t cut_history(const std::string& path, std::int64_t rows) {
  std::ifstream file(path, std::ios::binary);
  std::int64_t lines = 0;
  std::streamoff end = 0;
  for (std::string line; lines < rows + 1 && std::getline(file, line) && !file.eof(); ++lines) end = file.tellg();
  file.close();
  std::filesystem::resize_file(path, static_cast<std::uintmax_t>(end));
  return lines - 1;
}

template std::string history_header<2>(const measure::Columns&);
template std::string history_header<3>(const measure::Columns&);
template struct WriteHistory<2>;
template struct WriteHistory<3>;
template struct FlushHistory<2>;
template struct FlushHistory<3>;

}  // namespace minamo
