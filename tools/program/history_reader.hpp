#pragma once
/// \file
/// history.csv read back, and means of it.

#include "engine/input/expression.hpp"

#include <string>
#include <vector>

namespace minamo {

class History {
 public:
  /// \throws std::runtime_error if the file cannot be read or has no row.
  explicit History(const std::string& path);

  const std::vector<std::string>& columns() const { return columns_; }

  /// Mean over time, from one time to the other, of an expression in the columns: linear between rows, of which those
  /// within the times count. NaN if no row is there, or a field that it uses is empty.
  double mean(const std::string& expression, double from, double to) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;  ///< NaN for an empty field
};

}  // namespace minamo
