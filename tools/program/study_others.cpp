#include "tools/program/study_others.hpp"

#include "engine/input/input.hpp"
#include "engine/input/text_mistakes.hpp"
#include "tools/program/text_table.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>

namespace minamo {

namespace {

constexpr std::array<const char*, 4> columns{"code", "setting", "cost", "error"};

RowCells fields_of(const std::string& line) {
  RowCells fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(std::move(field));
  return fields;
}

std::optional<double> positive(const std::string& field) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  const bool is_number = error == std::errc() && end == field.data() + field.size() && value > 0;
  return is_number ? std::optional(value) : std::nullopt;
}

/// Where each of the columns is; problems are noted.
std::array<std::size_t, 4> places_of(const RowCells& heads, const std::string& path, std::vector<Problem>& problems) {
  std::array<std::size_t, 4> places{};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto found = std::find(heads.begin(), heads.end(), columns.at(k));
    places.at(k) = static_cast<std::size_t>(found - heads.begin());
    if (found != heads.end()) continue;
    problems.push_back({path,
                        {},
                        fmt::format("no column \"{}\"", columns.at(k)),
                        "a table with the columns code, setting, cost and error",
                        heads.empty() ? "an empty file" : fmt::format("{}", fmt::join(heads, ",")).substr(0, 100),
                        closest_name(columns.at(k), heads)});
  }
  return places;
}

/// The number in a field; where it is none, 0 and a problem.
double number_of(const std::string& field, const std::string& path, std::size_t line, std::vector<Problem>& problems) {
  if (const auto value = positive(field)) return *value;
  problems.push_back({path, {}, fmt::format("line {}: not a number", line), "a number > 0", '"' + field + '"', {}});
  return 0;
}

const StudyRow* cheapest_within(const StudyTable& table, double error) {
  const StudyRow* best = nullptr;
  for (const StudyRow& row : table.rows) {
    if (!row.error || *row.error > error) continue;
    if (!best || cost_of(table, row) < cost_of(table, *best)) best = &row;
  }
  return best;
}

std::vector<RowCells> cells_of(const StudyTable& table, const std::vector<AtEqualError>& pairs) {
  std::vector<RowCells> rows{{"code", "setting"}};
  rows.front().insert(rows.front().end(), table.heads.begin(), table.heads.end());
  for (const char* head : {"their error", "our error", "their cost", "our cost", "ratio"})
    rows.front().emplace_back(head);
  for (const auto& [other, ours] : pairs) {
    RowCells cells{other.code, other.setting};
    for (std::size_t k = 0; k < table.heads.size(); ++k) cells.push_back(ours ? ours->values[k] : "-");
    cells.push_back(fmt::format("{:.4g}", other.error));
    cells.push_back(ours ? fmt::format("{:.4g}", *ours->error) : "-");
    cells.push_back(fmt::format("{:.3g}", other.cost));
    cells.push_back(ours ? fmt::format("{:.3g}", cost_of(table, *ours)) : "-");
    cells.push_back(ours ? fmt::format("{:.2g}", other.cost / cost_of(table, *ours)) : "-");
    rows.push_back(std::move(cells));
  }
  return rows;
}

}  // namespace

std::vector<OtherPoint> read_others(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError({{path, {}, "cannot be read", "a table of points of others", {}, {}}});
  std::vector<Problem> problems;
  std::string line;
  std::getline(file, line);
  const std::array<std::size_t, 4> places =
      places_of(fields_of(std::string(without_byte_order_mark(line))), path, problems);
  if (!problems.empty()) throw InputError(problems);
  std::vector<OtherPoint> others;
  for (std::size_t number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    RowCells fields = fields_of(line);
    fields.resize(std::max(fields.size(), *std::max_element(places.begin(), places.end()) + 1));
    const auto [code, setting, cost, error] = places;
    others.push_back({fields[code], fields[setting], number_of(fields[cost], path, number, problems),
                      number_of(fields[error], path, number, problems)});
  }
  if (!problems.empty()) throw InputError(problems);
  return others;
}

std::vector<AtEqualError> at_equal_error(const StudyTable& table, const std::vector<OtherPoint>& others) {
  std::vector<AtEqualError> pairs;
  for (const OtherPoint& other : others) pairs.push_back({other, cheapest_within(table, other.error)});
  return pairs;
}

std::string as_text(const StudyTable& table, const std::vector<AtEqualError>& pairs) {
  return "At equal error: the cheapest variant that is at least as accurate; ratio: their cost over ours\n" +
         aligned(cells_of(table, pairs), 2 + table.heads.size());
}

std::string as_csv(const StudyTable& table, const std::vector<AtEqualError>& pairs) {
  std::string csv;
  for (const RowCells& cells : cells_of(table, pairs)) csv += csv_line(cells);
  return csv;
}

}  // namespace minamo
