#include "support/program.hpp"

#include "support/build.hpp"
#include "support/folder.hpp"

#include <csignal>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>

namespace minamo {

namespace {

constexpr auto patience = std::chrono::seconds(60);
constexpr auto glance = std::chrono::milliseconds(5);

std::string new_file() {
  std::string name = (std::filesystem::temp_directory_path() / "minamo_output_XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) throw std::runtime_error(name + ": cannot be made");
  close(file);
  return name;
}

}  // namespace

Program::Program(const std::vector<std::string>& arguments) : pid_(-1), output_file_(new_file()) {
  std::vector<std::string> words{program_path()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("cannot start " + words[0]);
  if (pid_ > 0) return;
  const int file = open(output_file_.c_str(), O_WRONLY);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  execv(argv[0], argv.data());
  _exit(127);
}

Program::~Program() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::error_code ignored;
  std::filesystem::remove(output_file_, ignored);
}

void Program::send(int signal) const { kill(pid_, signal); }

ProgramEnd Program::wait() {
  const auto give_up = std::chrono::steady_clock::now() + patience;
  int status = 0;
  while (waitpid(pid_, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > give_up) throw std::runtime_error("the program does not end");
    std::this_thread::sleep_for(glance);
  }
  pid_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(output_file_)};
}

ProgramEnd run_program(const std::vector<std::string>& arguments) { return Program(arguments).wait(); }

std::string scene_path(const std::string& name) { return std::string(MINAMO_SOURCE_DIR) + "/scenes/" + name; }

void wait_for_file(const std::string& path, std::size_t bytes) {
  const auto give_up = std::chrono::steady_clock::now() + patience;
  std::error_code missing;
  while (true) {
    const auto size = std::filesystem::file_size(path, missing);
    if (!missing && size > bytes) return;
    if (std::chrono::steady_clock::now() > give_up) throw std::runtime_error(path + " does not grow");
    std::this_thread::sleep_for(glance);
  }
}

}  // namespace minamo
