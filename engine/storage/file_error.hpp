#pragma once
/// \file
/// What to say of a file that cannot be written.

#include <string>

namespace minamo {

/// ": no space left on device"; nothing for 0, where nobody knows why.
/// \param error  an errno
std::string reason(int error);

/// "PATH: cannot be written: no space left on device".
std::string not_written(const std::string& path, int error);

/// \throws std::runtime_error with that text and the errno of now
[[noreturn]] void throw_not_written(const std::string& path);

}  // namespace minamo
