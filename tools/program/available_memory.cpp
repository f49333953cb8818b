#include "tools/program/available_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include <sys/resource.h>
#include <unistd.h>

namespace minamo {

namespace {

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double kibibyte = 1024;

/// The number after a word of a file.
std::optional<double> number_after(const fs::path& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string word; file >> word;) {
    double number = 0;
    if (word == name && file >> number) return number;
  }
  return {};
}

/// The number that a file holds; nothing for "max", or if there is no such file.
std::optional<double> number_in(const fs::path& path) {
  std::ifstream file(path);
  double number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

/// What is left in one group. Pages of files that nobody uses are given up when memory runs short.
double left_in_group(const fs::path& group, const char* limit, const char* usage, const char* reclaimable) {
  const auto most = number_in(group / limit);
  if (!most) return unlimited;
  return *most - number_in(group / usage).value_or(0) + number_after(group / "memory.stat", reclaimable).value_or(0);
}

/// What is left in a group and in those that it lies in.
double left_in_groups(const fs::path& root, const fs::path& group) {
  double left = unlimited;
  fs::path place = root;
  const auto look = [&] {
    left = std::min({left, left_in_group(place, "memory.max", "memory.current", "inactive_file"),
                     left_in_group(place, "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")});
  };
  look();
  for (const fs::path& step : group.relative_path()) {
    place /= step;
    look();
  }
  return left;
}

/// Version 2 has one hierarchy, a line `0::/path`; version 1 one per resource, `4:memory:/path`.
double left_in_control_groups(const fs::path& proc, const fs::path& groups) {
  double left = unlimited;
  std::ifstream file(proc / "self" / "cgroup");
  for (std::string line; std::getline(file, line);) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string resources = line.substr(first + 1, second - first - 1);
    if (!resources.empty() && resources != "memory") continue;
    left = std::min(left, left_in_groups(groups / resources, line.substr(second + 1)));
  }
  return left;
}

double left_of_address_space(const fs::path& proc) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double pages = number_in(proc / "self" / "statm").value_or(0);
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

AvailableMemory available_memory(const fs::path& proc, const fs::path& groups) {
  AvailableMemory least{unlimited, "no limit"};
  const auto take = [&least](double bytes, const char* source) {
    if (bytes < least.bytes) least = {std::max(0.0, bytes), source};
  };
  if (const auto free = number_after(proc / "meminfo", "MemAvailable:"))
    take(*free * kibibyte, "free memory of the machine");
  take(left_in_control_groups(proc, groups), "left of the control group's memory");
  take(left_of_address_space(proc), "left of the address space, ulimit -v");
  return least;
}

}  // namespace minamo
