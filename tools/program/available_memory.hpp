#pragma once
/// \file
/// How much memory the process may still take.

#include <filesystem>
#include <string>

namespace minamo {

struct AvailableMemory {
  double bytes = 0;
  std::string source;  ///< what says so, as the messages name it
};

/// The smallest of: free memory of the machine, what is left in the control groups of the process, what is left of its
/// address space (`ulimit -v`).
/// \param proc, groups  where /proc and /sys/fs/cgroup are; a test has its own.
AvailableMemory available_memory(const std::filesystem::path& proc = "/proc",
                                 const std::filesystem::path& groups = "/sys/fs/cgroup");

}  // namespace minamo
