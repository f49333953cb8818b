#include "tools/program/study_picture.hpp"

#include "tools/program/shell.hpp"

#include "minamo_plot_study.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

#include <sys/wait.h>

namespace minamo {

namespace {

/// Exit code where no python3 has matplotlib; plot_study.py has no such code.
constexpr int no_matplotlib = 127;

}  // namespace

bool draw_study(const std::filesystem::path& csv, const PictureLabels& labels) {
  // A python3 that comes first in the path need not be the one that the system's packages are for.
  const std::string command = fmt::format(
      "for python in python3 /usr/bin/python3; do\n"
      "\"$python\" -c 'import matplotlib' 2> /dev/null || continue\n"
      "\"$python\" - {} --title {} --error {} --cost {} {} << 'end_of_the_script'\n{}\nend_of_the_script\n"
      "exit\ndone\nexit {}\n",
      in_quotes(csv.string()), in_quotes(labels.title), in_quotes(labels.error),
      labels.cost == Cost::wall ? "wall_s" : "cpu_per_s",
      labels.others.empty() ? "" : "--others " + in_quotes(labels.others), plot_study_script, no_matplotlib);
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == 0) return true;
  const std::string reason = code == no_matplotlib
                                 ? "it needs python3 and matplotlib: sudo apt-get install python3-matplotlib"
                                 : "tools/plot_study.py failed";
  spdlog::warn("{} is not drawn: {}", (csv.parent_path() / "study.png").string(), reason);
  return false;
}

}  // namespace minamo
