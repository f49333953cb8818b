#pragma once
/// \file
/// Points of others next to those of a study: their error and cost, measured elsewhere, and what our variants cost at
/// the same error.

#include "tools/program/study_table.hpp"

#include <string>
#include <vector>

namespace minamo {

/// A point that somebody else's code has reached.
struct OtherPoint {
  std::string code;
  std::string setting;
  double cost = 0;   ///< as the study measures it [s]
  double error = 0;  ///< [1]
};

/// Reads a table with the columns code, setting, cost and error, and perhaps more; fields have no commas.
/// \throws InputError with all problems of the file.
std::vector<OtherPoint> read_others(const std::string& path);

/// A point of others and the cheapest variant that is at least as accurate; none if no variant is.
struct AtEqualError {
  OtherPoint other;
  const StudyRow* ours = nullptr;
};

/// One per point of the others, in their order. The rows are those of the table.
std::vector<AtEqualError> at_equal_error(const StudyTable& table, const std::vector<OtherPoint>& others);

/// Aligned columns; the ratio is their cost over ours.
std::string as_text(const StudyTable& table, const std::vector<AtEqualError>& pairs);

/// The same as a table for other programs.
std::string as_csv(const StudyTable& table, const std::vector<AtEqualError>& pairs);

}  // namespace minamo
