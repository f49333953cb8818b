#include "tools/program/text_table.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>

namespace minamo {

namespace {

/// Quoted where the format asks for it (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

/// Characters, not bytes.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

std::string csv_line(const RowCells& cells) {
  RowCells fields;
  for (const std::string& cell : cells) fields.push_back(csv_field(cell));
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::string aligned(const std::vector<RowCells>& rows, std::size_t words) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const RowCells& cells : rows) {
    for (std::size_t k = 0; k < cells.size(); ++k) widths[k] = std::max(widths[k], width_of(cells[k]));
  }
  std::string text;
  for (const RowCells& cells : rows) {
    std::string line;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::string fill(widths[k] - width_of(cells[k]), ' ');
      if (k > 0) line.append("  ");
      line.append(k < words ? cells[k] : fill).append(k < words ? fill : cells[k]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text.append(line).append("\n");
  }
  return text;
}

}  // namespace minamo
