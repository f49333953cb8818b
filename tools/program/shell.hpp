#pragma once
/// \file
/// Other programs, called through the shell.

#include <string>

namespace minamo {

/// As one word of a shell.
std::string in_quotes(const std::string& word);

struct ProgramText {
  std::string text;  ///< of its standard output
  int code = 0;      ///< that it ended with; -1 if a signal ended it
};

/// Runs a line of the shell to its end. \throws std::runtime_error if no process can be started.
ProgramText text_of_program(const std::string& command);

}  // namespace minamo
