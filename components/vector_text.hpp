#pragma once
/// \file
/// Places and vectors in messages.

#include "components/types.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <string>

namespace minamo {

template <int Dim>
std::string place_text(const Vec<Dim>& x) {
  std::string text = fmt::format("x = {:.6g}, y = {:.6g}", x[0], x[1]);
  if constexpr (Dim == 3) text += fmt::format(", z = {:.6g}", x[2]);
  return text;
}

template <int Dim>
std::string vector_text(const Vec<Dim>& v) {
  std::string text;
  for (const double x : v)
    text += fmt::format("{}{}", text.empty() ? "" : ", ", std::isnan(x) ? "nan" : fmt::format("{:.6g}", x));
  return "[" + text + ']';
}

}  // namespace minamo
