#include "systems/bodies/motion/motion_table.hpp"

#include "engine/input/text_mistakes.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace minamo {

namespace {

/// The numbers of a line; none if one of its fields is not a finite number.
std::optional<std::vector<double>> numbers_of(const std::string& line) {
  std::vector<double> numbers;
  std::istringstream fields(line);
  for (std::string field; std::getline(fields, field, ',');) {
    std::size_t read = 0;
    try {
      numbers.push_back(std::stod(field, &read));
    } catch (const std::exception&) {
      return {};
    }
    if (field.find_first_not_of(" \t\r", read) != std::string::npos || !std::isfinite(numbers.back())) return {};
  }
  return numbers;
}

}  // namespace

template <int Dim>
Tabulated<Dim> read_motion_table(const std::filesystem::path& file) {
  const std::string expected = Dim == 2 ? "lines \"time, x, y\" or \"time, x, y, angle\", at rising times"
                                        : "lines \"time, x, y, z\" or \"time, x, y, z, angle\", at rising times";
  std::ifstream text(file);
  if (!text) throw MotionTableError("cannot be read", "a CSV file", file.filename().string());
  Tabulated<Dim> table;
  int count = 0;
  for (std::string line; std::getline(text, line);) {
    if (++count == 1)
      line = std::string(without_byte_order_mark(line));  // that of a spreadsheet; it would hide the first row
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    const auto row = numbers_of(line);
    if (!row && table.time.empty() && count == 1) continue;  // a header
    const bool fits = row && (row->size() == Dim + 1 || row->size() == Dim + 2);
    if (!fits || (!table.time.empty() && row->at(0) <= table.time.back())) {
      throw MotionTableError(fits ? "times do not rise" : "not a row of numbers", expected,
                             fmt::format("line {}: {}", count, line));
    }
    table.time.push_back(row->at(0));
    Vec<Dim> x;
    for (int d = 0; d < Dim; ++d) x[d] = row->at(static_cast<std::size_t>(d) + 1);
    table.position.push_back(x);
    table.angle.push_back(row->size() == Dim + 2 ? row->back() * std::numbers::pi / 180 : 0);
  }
  if (table.time.empty()) throw MotionTableError("no rows", expected, "none");
  return table;
}

template Tabulated<2> read_motion_table<2>(const std::filesystem::path&);
template Tabulated<3> read_motion_table<3>(const std::filesystem::path&);

}  // namespace minamo
