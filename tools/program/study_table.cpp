#include "tools/program/study_table.hpp"

#include "tools/program/text_table.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace minamo {

namespace {

/// Whether two rows differ in nothing but the resolution.
bool same_line(const StudyTable& table, const StudyRow& a, const StudyRow& b) {
  for (std::size_t k = 0; k < table.keys.size(); ++k) {
    if (k != table.resolution_at && a.values[k] != b.values[k]) return false;
  }
  return true;
}

/// The next coarser row of the same line that has an error; null if there is none.
const StudyRow* coarser(const StudyTable& table, const StudyRow& row) {
  const StudyRow* nearest = nullptr;
  for (const StudyRow& other : table.rows) {
    if (!other.error || !(other.resolution < row.resolution) || !same_line(table, other, row)) continue;
    if (!nearest || other.resolution > nearest->resolution) nearest = &other;
  }
  return nearest;
}

std::optional<double> order(const StudyTable& table, const StudyRow& row) {
  if (!row.resolution || !row.error) return {};
  const StudyRow* coarse = coarser(table, row);
  if (!coarse || *coarse->error <= 0 || *row.error <= 0) return {};
  return std::log(*coarse->error / *row.error) / std::log(*row.resolution / *coarse->resolution);
}

bool on_frontier(const StudyTable& table, const StudyRow& row) {
  return row.error && std::none_of(table.rows.begin(), table.rows.end(), [&](const StudyRow& other) {
           return other.error && cost_of(table, other) < cost_of(table, row) && *other.error < *row.error;
         });
}

double product(const StudyTable& table, const StudyRow& row) { return cost_of(table, row) * row.error.value_or(0); }

std::optional<int> rank(const StudyTable& table, const StudyRow& row) {
  if (!row.error) return {};
  const auto better = std::count_if(table.rows.begin(), table.rows.end(), [&](const StudyRow& other) {
    return other.error && product(table, other) < product(table, row);
  });
  return static_cast<int>(better) + 1;
}

/// A number, or `none` where there is none.
template <class T>
std::string shown(const std::optional<T>& value, std::string_view format, std::string_view none) {
  return value ? fmt::format(fmt::runtime(format), *value) : std::string(none);
}

}  // namespace

double cost_of(const StudyTable& table, const StudyRow& row) {
  return table.cost == Cost::wall ? row.wall_seconds : row.cpu_seconds;
}

std::vector<Standing> standings(const StudyTable& table) {
  std::vector<Standing> standings;
  for (const StudyRow& row : table.rows)
    standings.push_back({order(table, row), rank(table, row), on_frontier(table, row)});
  return standings;
}

std::string as_text(const StudyTable& table) {
  std::vector<RowCells> rows{table.heads};
  for (const char* head : {"error [1]", "order", table.cost == Cost::wall ? "wall [s]" : "cpu [s/s]", "steps",
                           "time x error rank", "frontier", "status"})
    rows.front().emplace_back(head);
  const auto all = standings(table);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const StudyRow& row = table.rows[i];
    RowCells cells = row.values;
    for (std::string& cell :
         std::vector<std::string>{shown(row.error, "{:.3e}", "-"), shown(all[i].order, "{:.2f}", "-"),
                                  fmt::format("{:.3g}", cost_of(table, row)), std::to_string(row.steps),
                                  shown(all[i].rank, "{}", "-"), all[i].on_frontier ? "*" : "", row.status})
      cells.push_back(std::move(cell));
    rows.push_back(std::move(cells));
  }
  return aligned(rows, table.heads.size());
}

std::string as_csv(const StudyTable& table) {
  RowCells heads = table.keys;
  for (const char* head : {"error", "order", "wall_s", "cpu_per_s", "time_step", "steps", "particles", "unknowns_max",
                           "cpu_model", "threads", "status", "rank", "frontier"})
    heads.emplace_back(head);
  std::string csv = csv_line(heads);
  const auto all = standings(table);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const StudyRow& row = table.rows[i];
    RowCells cells = row.values;
    for (std::string& cell : std::vector<std::string>{
             shown(row.error, "{}", ""), shown(all[i].order, "{:.4f}", ""), fmt::format("{:.6g}", row.wall_seconds),
             fmt::format("{:.4g}", row.cpu_seconds), fmt::format("{}", row.time_step), std::to_string(row.steps),
             std::to_string(row.particles), std::to_string(row.unknowns_max), table.cpu_model,
             std::to_string(table.threads), row.status, shown(all[i].rank, "{}", ""), all[i].on_frontier ? "1" : "0"})
      cells.push_back(std::move(cell));
    csv += csv_line(cells);
  }
  return csv;
}

}  // namespace minamo
