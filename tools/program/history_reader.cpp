#include "tools/program/history_reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace minamo {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(std::move(field));
  if (line.ends_with(',')) fields.emplace_back();
  return fields;
}

double number(const std::string& field) {
  double value = nan;
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

}  // namespace

History::History(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (std::getline(file, line)) columns_ = fields_of(line);
  while (std::getline(file, line)) {
    std::vector<double> row;
    for (const std::string& field : fields_of(line)) row.push_back(number(field));
    row.resize(columns_.size(), nan);
    rows_.push_back(std::move(row));
  }
  if (rows_.empty()) throw std::runtime_error(path + ": no rows");
}

double History::mean(const std::string& expression, double from, double to) const {
  const Expression value(expression, {columns_, {}});
  const auto found = std::find(columns_.begin(), columns_.end(), "time");
  if (found == columns_.end()) return nan;
  const auto time = static_cast<std::size_t>(found - columns_.begin());
  const double rounding = 1e-9 * std::max(std::abs(from), std::abs(to));  // of times that are sums of steps
  double integral = 0;
  double last = nan;
  const std::vector<double>* before = nullptr;
  double begin = nan;
  for (const std::vector<double>& row : rows_) {
    if (row[time] < from - rounding || row[time] > to + rounding) continue;
    const double now = value(row);
    if (before) {
      integral += 0.5 * (now + last) * (row[time] - (*before)[time]);
    } else {
      begin = row[time];
    }
    last = now;
    before = &row;
  }
  if (!before) return nan;
  const double duration = (*before)[time] - begin;
  return duration > 0 ? integral / duration : last;
}

}  // namespace minamo
