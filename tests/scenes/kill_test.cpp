// A run that is killed leaves files that can be read, whenever that happens: before, after and in the middle of every
// write, which the kernel cuts short at the end of a page of 4096 bytes.

#include "support/build.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"
#include "support/xml.hpp"

#include "engine/storage/hdf5.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <functional>

#include <fcntl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t page_bytes = 4096;

struct PlacedWrite {
  std::string path;
  std::uint64_t offset;
  std::string bytes;
};

std::string bytes_of_process(pid_t pid, std::uint64_t address, std::uint64_t count) {
  const int memory = open(("/proc/" + std::to_string(pid) + "/mem").c_str(), O_RDONLY | O_CLOEXEC);
  std::string bytes(count, '\0');
  const ssize_t found = pread(memory, bytes.data(), count, static_cast<off_t>(address));
  close(memory);
  if (found != static_cast<ssize_t>(count)) throw std::runtime_error("the memory of the program cannot be read");
  return bytes;
}

/// Runs the program and calls use() before each of its writes at a place of a file; others replace whole files.
/// \return its exit code; -1 if programs may not be watched here
int watch_writes(const std::vector<std::string>& arguments, const std::function<void(const PlacedWrite&)>& use) {
  std::vector<std::string> words{program_path()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t pid = fork();
  if (pid == 0) {
    // Its check for leaks is a debugger, too.
    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(125);
    raise(SIGSTOP);
    execv(argv[0], argv.data());
    _exit(126);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  if (WIFEXITED(status)) return -1;
  ptrace(PTRACE_SETOPTIONS, pid, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  for (int signal = 0;;) {
    ptrace(PTRACE_SYSCALL, pid, nullptr, signal);
    waitpid(pid, &status, 0);
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    if (WIFSIGNALED(status)) return 128 + WTERMSIG(status);
    const bool is_call = WSTOPSIG(status) == (SIGTRAP | 0x80);
    signal = is_call || WSTOPSIG(status) == SIGTRAP ? 0 : WSTOPSIG(status);
    __ptrace_syscall_info call{};
    if (!is_call || ptrace(PTRACE_GET_SYSCALL_INFO, pid, sizeof(call), &call) <= 0) continue;
    if (call.op != PTRACE_SYSCALL_INFO_ENTRY || call.entry.nr != SYS_pwrite64) continue;
    const auto& arguments_of_call = call.entry.args;
    const auto link = "/proc/" + std::to_string(pid) + "/fd/" + std::to_string(arguments_of_call[0]);
    std::error_code closed;
    const auto path = fs::read_symlink(link, closed).string();
    use({path, arguments_of_call[3], bytes_of_process(pid, arguments_of_call[1], arguments_of_call[2])});
  }
}

/// What a file may be if the process is killed in that write: with none of its pages, with some, with all.
std::vector<std::string> states_when_killed(const PlacedWrite& write) {
  const std::string before = text_of(write.path);
  std::vector<std::string> states;
  std::uint64_t done = 0;
  for (;;) {
    std::string state = before;
    state.resize(std::max<std::size_t>(state.size(), done == 0 ? 0 : write.offset + done), '\0');
    std::copy_n(write.bytes.begin(), done, state.begin() + static_cast<std::ptrdiff_t>(write.offset));
    states.push_back(state);
    if (done == write.bytes.size()) return states;
    done = std::min<std::uint64_t>(write.bytes.size(),
                                   ((write.offset + done) / page_bytes + 1) * page_bytes - write.offset);
  }
}

/// How many frames a file has, of which all can be read. \throws std::runtime_error
std::size_t frames_that_can_be_read(const std::string& path) {
  const Hdf5File file(path, Hdf5File::Access::read);
  for (std::size_t k = 0;; ++k) {
    const std::string frame = "/particles/" + std::to_string(k);
    if (!file.has(frame)) return k;
    for (const char* field : {"/id", "/position", "/velocity"})
      if (file.read_bytes(frame + field).empty()) throw std::runtime_error(path + ": a frame is empty");
  }
}

std::size_t times_in(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("a run that is killed in any write leaves frames and an index that can be read", "[scene]") {
  const Folder folder;
  const std::vector<std::string> run{"run",
                                     scene_path("mixer.json"),
                                     "--out",
                                     folder / "out",
                                     "--threads",
                                     "1",
                                     "--quiet",
                                     "--steps",
                                     "12",
                                     "--set",
                                     "/grid/cells=[12, 12]",
                                     "--set",
                                     "/output/every=0.001",
                                     "--set",
                                     R"(/output/surface="vtp")"};
  std::size_t frames = 0;
  std::size_t entries = 0;
  std::size_t looked_at = 0;
  const int code = watch_writes(run, [&](const PlacedWrite& write) {
    const std::string name = fs::path(write.path).filename();
    if (name != "fields.h5" && name != "fields.xdmf" && name != "surface.pvd") return;
    for (const std::string& state : states_when_killed(write)) {
      CAPTURE(name, write.offset, write.bytes.size(), state.size());
      ++looked_at;
      if (name == "fields.h5") {
        std::ofstream(folder / "state.h5", std::ios::binary) << state;
        const std::size_t found = frames_that_can_be_read(folder / "state.h5");
        REQUIRE(found >= frames);
        frames = found;
      } else {
        REQUIRE(is_well_formed(state));
        if (name == "fields.xdmf") {
          const std::size_t found = times_in(state, "<Time");
          REQUIRE((found >= entries || times_in(state, "<?minamo") > 0));
          if (found > entries) entries = found;
        }
      }
    }
  });
  if (code == -1) {
    WARN("programs may not be watched here");
    return;
  }
  CHECK(code == 0);
  CHECK(frames == 13);
  CHECK(looked_at > 100);
  CHECK(is_well_formed(text_of(folder / "out/fields.xdmf")));
  CHECK(times_in(text_of(folder / "out/fields.xdmf"), "<Time") == 13);
  CHECK(times_in(text_of(folder / "out/surface.pvd"), "timestep") == 13);
}
