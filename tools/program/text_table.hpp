#pragma once
/// \file
/// Tables as text: for eyes, and as comma separated values.

#include <cstddef>
#include <string>
#include <vector>

namespace minamo {

using RowCells = std::vector<std::string>;

/// A row, fields quoted where the format asks for it (RFC 4180).
std::string csv_line(const RowCells& cells);

/// Rows with the columns aligned: the first `words` to the left, numbers to the right.
std::string aligned(const std::vector<RowCells>& rows, std::size_t words);

}  // namespace minamo
