#pragma once
/// \file
/// What the program prints, stdout and stderr apart.

#include "support/build.hpp"
#include "support/folder.hpp"

#include <cstdlib>
#include <string>
#include <vector>

#include <sys/wait.h>

namespace minamo {

struct ProgramOutput {
  int code = 0;  ///< exit code; -1: killed
  std::string out;
  std::string err;
};

namespace detail {
inline std::string in_quotes(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted += '\'';
}
}  // namespace detail

/// Runs the program in a folder and waits for its end.
/// \param before  what the shell does first, as in "ulimit -f 100 && "
inline ProgramOutput output_of_program(const std::string& folder, const std::vector<std::string>& arguments,
                                       const std::string& before = {}) {
  const Folder caught;
  std::string line = "cd ";
  line.append(detail::in_quotes(folder)).append(" && ").append(before).append(detail::in_quotes(program_path()));
  for (const std::string& argument : arguments) line.append(" ").append(detail::in_quotes(argument));
  line.append(" > ").append(detail::in_quotes(caught / "out"));
  line.append(" 2> ").append(detail::in_quotes(caught / "err"));
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(caught / "out"), text_of(caught / "err")};
}

}  // namespace minamo
