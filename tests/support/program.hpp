#pragma once
/// \file
/// The program minamo as a user runs it.

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace minamo {

struct ProgramEnd {
  int code;            ///< exit code
  std::string output;  ///< of stdout and stderr together
};

/// A running minamo, in a folder of its own choice. Killed if it is still there in the end.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int signal) const;
  /// \throws std::runtime_error after a minute.
  ProgramEnd wait();

 private:
  pid_t pid_;
  std::string output_file_;
};

ProgramEnd run_program(const std::vector<std::string>& arguments);

/// Of a scene in scenes/.
std::string scene_path(const std::string& name);

/// Waits for a file to have more than so many bytes. \throws std::runtime_error after a minute.
void wait_for_file(const std::string& path, std::size_t bytes);

}  // namespace minamo
