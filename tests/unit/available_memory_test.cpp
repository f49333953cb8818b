#include "support/folder.hpp"
#include "tools/program/available_memory.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

/// A machine with 8 GB free whose process is in the control groups of `lines`.
class Machine {
 public:
  explicit Machine(const std::string& lines) {
    write("proc/meminfo", "MemTotal: 16000000 kB\nMemAvailable: 8000000 kB\n");
    write("proc/self/cgroup", lines);
  }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  AvailableMemory available() const { return available_memory(folder_ / "proc", folder_ / "groups"); }

 private:
  Folder folder_;
};

constexpr double free_bytes = 8e6 * 1024;

}  // namespace

TEST_CASE("without limits the free memory of the machine is available", "[unit]") {
  const Machine machine("0::/user\n");
  CHECK(machine.available().bytes == free_bytes);
  CHECK(machine.available().source == "free memory of the machine");
}

TEST_CASE("of a control group is available what its limit and use leave, files that nobody uses included", "[unit]") {
  const Machine machine("0::/user/job\n");
  machine.write("groups/user/job/memory.max", "1000000\n");
  machine.write("groups/user/job/memory.current", "700000\n");
  machine.write("groups/user/job/memory.stat", "anon 600000\ninactive_file 50000\n");
  CHECK(machine.available().bytes == 350000);
  CHECK(machine.available().source == "left of the control group's memory");
}

TEST_CASE("the limit of a group around that of the process holds as well", "[unit]") {
  const Machine machine("0::/user/job\n");
  machine.write("groups/user/memory.max", "500000\n");
  machine.write("groups/user/job/memory.max", "max\n");
  CHECK(machine.available().bytes == 500000);
}

TEST_CASE("control groups of version 1 are looked at in the hierarchy of the memory", "[unit]") {
  const Machine machine("5:devices:/\n4:memory:/job\n0::/\n");
  machine.write("groups/memory/memory.limit_in_bytes", "9223372036854771712\n");
  machine.write("groups/memory/job/memory.limit_in_bytes", "1000000\n");
  machine.write("groups/memory/job/memory.usage_in_bytes", "400000\n");
  CHECK(machine.available().bytes == 600000);
}

TEST_CASE("a group that takes more than its limit leaves nothing", "[unit]") {
  const Machine machine("0::/\n");
  machine.write("groups/memory.max", "1000\n");
  machine.write("groups/memory.current", "2000\n");
  CHECK(machine.available().bytes == 0);
}
