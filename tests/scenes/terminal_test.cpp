// The program on a terminal: a line of progress within its width, which leaves nothing behind.

#include "support/build.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>

#include <pty.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace minamo;

namespace {

using CommandLine = std::vector<std::string>;

/// The program with a terminal of its own.
class ProgramOnTerminal {
 public:
  ProgramOnTerminal(const CommandLine& arguments, unsigned short columns) {
    winsize size = of(columns);
    std::vector<std::string> words{program_path()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (pid_ < 0) throw std::runtime_error("no terminal");
    if (pid_ > 0) return;
    setenv("TERM", "xterm", 1);
    execv(argv[0], argv.data());
    _exit(127);
  }
  ~ProgramOnTerminal() {
    close(terminal_);
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  ProgramOnTerminal(const ProgramOnTerminal&) = delete;
  ProgramOnTerminal& operator=(const ProgramOnTerminal&) = delete;

  void resize(unsigned short columns) const {
    const winsize size = of(columns);
    ioctl(terminal_, TIOCSWINSZ, &size);
  }
  /// Reads what is printed, until that is enough or the program has ended.
  void read(const std::function<bool(const std::string&)>& is_enough) {
    std::array<char, 4096> part{};
    while (!is_enough(printed_)) {
      const ssize_t count = ::read(terminal_, part.data(), part.size());
      if (count <= 0) break;
      printed_.append(part.data(), static_cast<std::size_t>(count));
    }
  }
  std::string rest() {
    read([](const std::string&) { return false; });
    return printed_;
  }
  int code() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  static winsize of(unsigned short columns) {
    return {.ws_row = 24, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  std::string printed_;
};

/// What a terminal of so many columns shows at the end: lines, with all that has scrolled out of sight.
std::vector<std::string> shown_at_end(const std::string& printed, std::size_t columns) {
  std::vector<std::string> lines{""};
  std::size_t at = 0;
  const std::string erase = "\033[K";
  for (std::size_t k = 0; k < printed.size(); ++k) {
    if (printed.compare(k, erase.size(), erase) == 0) {
      lines.back().resize(std::min(lines.back().size(), at));
      k += erase.size() - 1;
    } else if (printed[k] == '\033') {  // colours
      k = printed.find('m', k);
    } else if (printed[k] == '\r') {
      at = 0;
    } else if (printed[k] == '\n') {
      lines.emplace_back();
    } else {
      if (at == columns) {
        lines.emplace_back();
        at = 0;
      }
      if (lines.back().size() <= at) lines.back().resize(at + 1, ' ');
      lines.back()[at++] = printed[k];
    }
  }
  return lines;
}

/// The lines of progress that were shown in turn.
std::vector<std::string> progress_lines(const std::string& printed) {
  std::vector<std::string> lines;
  for (std::size_t k = printed.find('\r'); k != std::string::npos; k = printed.find('\r', k + 1)) {
    const std::string line = printed.substr(k + 1, printed.find_first_of("\r\n\033", k + 1) - k - 1);
    if (line.find(" %") != std::string::npos) lines.push_back(line);
  }
  return lines;
}

std::size_t longest_line(const std::vector<std::string>& lines) {
  const auto is_shorter = [](const std::string& a, const std::string& b) { return a.size() < b.size(); };
  const auto longest = std::max_element(lines.begin(), lines.end(), is_shorter);
  return longest == lines.end() ? 0 : longest->size();
}

/// Some seconds of a dam break.
CommandLine seconds_of_dam_break(const std::string& out, const CommandLine& more) {
  CommandLine arguments{
      "run", scene_path("paper/dam_break_tpic.json"), "--out", out, "--threads", "1", "--set", "/grid/cells=[20, 20]"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("progress is a line within the width of the terminal, and gone at the end", "[scene]") {
  const Folder folder;
  const auto columns = static_cast<unsigned short>(GENERATE(30, 200));
  ProgramOnTerminal program(seconds_of_dam_break(folder / "out", {"--set", "/time/end=0.3"}), columns);
  const std::string printed = program.rest();
  CHECK(program.code() == 0);
  const auto progress = progress_lines(printed);
  CAPTURE(printed);
  REQUIRE_FALSE(progress.empty());
  CHECK(longest_line(progress) < columns);
  CHECK((columns < 200 || longest_line(progress) > 80));
  const auto lines = shown_at_end(printed, 1000);
  CHECK(lines.size() == 2);
  CHECK_THAT(lines.front(), Catch::StartsWith("results in "));
}

TEST_CASE("progress follows the size of the terminal", "[scene]") {
  const Folder folder;
  ProgramOnTerminal program(seconds_of_dam_break(folder / "out", {}), 160);
  const auto lines_from = [&](std::size_t begin, std::size_t count) {
    std::vector<std::string> lines;
    program.read([&](const std::string& printed) {
      lines = progress_lines(printed.substr(std::min(begin, printed.size())));
      return lines.size() > count;
    });
    return lines;
  };
  const auto wide = lines_from(0, 2);
  CHECK(longest_line(wide) > 80);
  program.resize(40);
  const auto both = lines_from(0, wide.size() + 4);  // one may be under way with the old width
  const std::vector<std::string> narrow(both.end() - 3, both.end());
  CHECK(longest_line(narrow) < 40);
  CHECK(longest_line(narrow) > 15);
}

TEST_CASE("progress makes way for warnings and leaves nothing between them", "[scene]") {
  const Folder folder;
  // Steps that are too long are taken back, each with a warning.
  ProgramOnTerminal program(
      seconds_of_dam_break(folder / "out", {"--set", "/time/step=0.1", "--set", R"(/integrator={"scheme": "midpoint"})",
                                            "--set", "/time/end=2", "--set", "/grid/cells=[40, 40]"}),
      300);
  const std::string printed = program.rest();
  CHECK(program.code() == 0);
  REQUIRE_FALSE(progress_lines(printed).empty());
  const auto lines = shown_at_end(printed, 1000);
  CHECK(std::count_if(lines.begin(), lines.end(), [](const auto& line) { return line.starts_with("step "); }) > 2);
  const auto is_progress = [](const auto& line) { return line.find(" left") != std::string::npos; };
  CHECK(std::none_of(lines.begin(), lines.end(), is_progress));
}

TEST_CASE("a quiet run shows no progress", "[scene]") {
  const Folder folder;
  ProgramOnTerminal program(seconds_of_dam_break(folder / "out", {"--set", "/time/end=0.3", "--quiet"}), 80);
  CHECK(program.rest().empty());
  CHECK(program.code() == 0);
}
