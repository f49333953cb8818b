#include "systems/step/fit_for_ranks.hpp"

#include <set>

namespace minamo {

void require_fit_for_ranks(const Pipeline& pipeline, const std::string& scene) {
  std::set<std::string> others;
  for (const auto* systems : {&pipeline.start, &pipeline.step, &pipeline.output}) {
    for (const System& system : *systems) {
      if (system.on_ranks == OnRanks::one_process) others.insert(system.name);
    }
  }
  std::vector<Problem> problems;
  for (const std::string& system : others) {
    problems.push_back({scene,
                        {},
                        "a system of this scene does not run on several ranks",
                        "systems that do, or one process",
                        shown(Json(system)),
                        {}});
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace minamo
