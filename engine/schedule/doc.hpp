#pragma once
/// \file
/// What a system says of itself.

#include <string_view>

namespace minamo {

/// One line with the equation's number. `static constexpr Doc doc = "(E8) wall conditions on v_f^n";` in a kernel notes
/// the file, too.
struct Doc {
  std::string_view text;
  std::string_view file;  ///< that declares the kernel, as the compiler names it; may be empty

  // std::source_location is not for clang 14.
  constexpr Doc(const char* line, const char* declared_in = __builtin_FILE())  // NOLINT(google-explicit-constructor)
      : text(line), file(declared_in) {}
  constexpr explicit Doc(std::string_view line) : text(line) {}
};

}  // namespace minamo
