#pragma once
/// \file
/// What a value of an input must be, as the reading code states it. The reading is in input.hpp.

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace minamo {

/// What a number must be. Ranges are closed unless `above`/`below` say otherwise.
struct Number {
  std::string_view unit = "1";
  std::string_view doc = {};            ///< one line, without unit
  std::optional<double> fallback = {};  ///< none: the key is required
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();
  double below = std::numeric_limits<double>::infinity();
};

struct Integer {
  std::string_view doc = {};
  std::optional<std::int64_t> fallback = {};
  std::int64_t at_least = std::numeric_limits<std::int64_t>::min();
  std::int64_t at_most = std::numeric_limits<std::int64_t>::max();
};

struct Text {
  std::string_view doc = {};
  std::optional<std::string> fallback = {};
};

}  // namespace minamo
