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
  std::string_view unit = "1";                                 ///< SI; "1" is dimensionless
  std::string_view doc = {};                                   ///< one line, without unit
  std::optional<double> fallback = {};                         ///< none: the key is required
  double at_least = -std::numeric_limits<double>::infinity();  ///< least that is allowed
  double at_most = std::numeric_limits<double>::infinity();    ///< most that is allowed
  double above = -std::numeric_limits<double>::infinity();     ///< must be more than this
  double below = std::numeric_limits<double>::infinity();      ///< must be less than this
};

/// What a whole number must be. Ranges are closed.
struct Integer {
  std::string_view doc = {};                                         ///< one line
  std::optional<std::int64_t> fallback = {};                         ///< none: the key is required
  std::int64_t at_least = std::numeric_limits<std::int64_t>::min();  ///< least that is allowed
  std::int64_t at_most = std::numeric_limits<std::int64_t>::max();   ///< most that is allowed
};

/// What a string must be: any.
struct Text {
  std::string_view doc = {};                 ///< one line
  std::optional<std::string> fallback = {};  ///< none: the key is required
};

}  // namespace minamo
