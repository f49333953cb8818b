#include "tools/program/terminal.hpp"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace minamo {

namespace {

/// Systems log from several threads.
std::mutex foot_mutex;
bool foot_has_line = false;

void write_to_foot(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

constexpr const char* begin_of_line = "\r";
constexpr const char* erase_rest_of_line = "\033[K";

}  // namespace

bool has_foot() {
  const char* kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

std::size_t columns_of_terminal() {
  constexpr std::size_t usual = 80;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

void show_at_foot(const std::string& line) {
  const std::lock_guard lock(foot_mutex);
  write_to_foot(begin_of_line + line + erase_rest_of_line);
  foot_has_line = true;
}

void clear_foot() {
  const std::lock_guard lock(foot_mutex);
  if (!foot_has_line) return;
  write_to_foot(std::string(begin_of_line) + erase_rest_of_line);
  foot_has_line = false;
}

bool reader_has_gone() {
  pollfd out{.fd = STDOUT_FILENO, .events = POLLOUT, .revents = 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

}  // namespace minamo
