#include "tools/program/interrupt.hpp"

#include <csignal>

namespace minamo {

const std::atomic<bool>& stop_on_signal() {
  static std::atomic<bool> stop_requested{false};
  const auto request_stop = [](int signal) {
    stop_requested = true;
    std::signal(signal, SIG_DFL);
  };
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  std::signal(SIGUSR1, request_stop);
  return stop_requested;
}

}  // namespace minamo
