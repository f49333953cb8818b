/// \file
/// main() of the test programs: Catch2's; `--write-ctest-file FILE`, which writes the list of tests for ctest; and
/// `--group NAME [argument of Catch2]...`, which runs one of them. ctest starts a program per group of cases, because
/// the start takes longer than most cases: a third of a second with the sanitizers.
/// MINAMO_TEST_THREADS=N is what a test may have; without it all the processor has.

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "support/build.hpp"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using Cases = std::vector<const Catch::TestCase*>;

/// What ctest runs at once.
struct Group {
  std::string name;
  Cases cases;
};

bool has_tag(const Catch::TestCase& test, std::string_view tag) {
  return std::find(test.tags.begin(), test.tags.end(), tag) != test.tags.end();
}

/// The name as Catch2 wants it on the command line, where comma, bracket, quote and backslash mean something.
std::string as_test_spec(std::string_view name) {
  std::string spec;
  for (const char letter : name) {
    if (std::string_view(",[]\"\\~*").find(letter) != std::string_view::npos) spec += '\\';
    spec += letter;
  }
  return spec;
}

#if defined(__SANITIZE_THREAD__)
constexpr bool looks_for_races = true;
#else
constexpr bool looks_for_races = false;
#endif

/// Cases that start the program take a second each, others less: a group is small next to what one processor has to do.
std::size_t cases_at_most(const Catch::TestCase& test) {
  if (has_tag(test, "scene")) return 8;
  return has_tag(test, "unit") ? 40 : 12;
}

/// tests/unit/matrix_test.cpp: unit/matrix.
std::string name_of_source(const Catch::TestCase& test) {
  const std::filesystem::path file(test.lineInfo.file);
  const std::string stem = file.stem().string();
  return (file.parent_path().filename() / stem.substr(0, stem.rfind("_test"))).string();
}

/// The cases of a source with the same tags, or a part of them; a long case is a group of its own and has its name.
std::vector<Group> all_groups() {
  std::vector<Group> groups;
  std::map<std::pair<std::string, std::vector<std::string>>, Cases> alike;
  for (const Catch::TestCase& test : Catch::getRegistryHub().getTestCaseRegistry().getAllTests()) {
    if (test.isHidden()) continue;
    if (has_tag(test, "long")) {
      groups.push_back({test.name, {&test}});
    } else {
      alike[{name_of_source(test), test.tags}].push_back(&test);
    }
  }
  for (const auto& [key, cases] : alike) {
    std::string name = key.first;
    const auto sharing = [&, &source = key.first](const auto& other) { return other.first.first == source; };
    if (std::count_if(alike.begin(), alike.end(), sharing) > 1) {
      for (const std::string& tag : key.second) name += ", " + tag;
    }
    const std::size_t most = cases_at_most(*cases.front());
    const std::size_t parts = (cases.size() + most - 1) / most;
    for (std::size_t part = 0; part < parts; ++part) {
      const auto from = cases.begin();
      Group group{name, Cases(from + static_cast<std::ptrdiff_t>(part * cases.size() / parts),
                              from + static_cast<std::ptrdiff_t>((part + 1) * cases.size() / parts))};
      if (parts > 1) group.name += ", " + std::to_string(part + 1) + " of " + std::to_string(parts);
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

/// ctest runs as many tests at a time as there are processors. More threads in each would wait for one another, which
/// is a sixth of the time with the sanitizers; those that are about threads count for two.
const char* threads_of(const Catch::TestCase& test) {
  if (has_tag(test, "threads")) return " PROCESSORS 2";
  return looks_for_races ? "" : " ENVIRONMENT MINAMO_TEST_THREADS=1";
}

/// ctest begins with the dear ones, so that no processor waits for the other at the end.
int cost_of(const Group& group) {
  const Catch::TestCase& test = *group.cases.front();
  if (has_tag(test, "long")) return 40;
  return has_tag(test, "unit") ? 1 : 20;
}

std::string quoted(const std::string& text) { return "[===[" + text + "]===]"; }

void write_ctest_file(const std::filesystem::path& file, const std::filesystem::path& program) {
  std::ofstream script(file);
  for (const Group& group : all_groups()) {
    const Catch::TestCase& test = *group.cases.front();
    std::string labels;
    for (const std::string& tag : test.tags) labels += (labels.empty() ? "" : ";") + tag;
    // A quick group takes milliseconds to seconds; the sanitizers and a busy machine make that minutes.
    const bool quick = !looks_for_races && !minamo::is_address_sanitized() &&
                       (has_tag(test, "unit") || has_tag(test, "property") || has_tag(test, "error"));
    const int timeout_s = quick ? 120 : 1200;
    script << "add_test(" << quoted(group.name) << ' ' << quoted(program.string()) << " --group " << quoted(group.name)
           << ")\n"
           << "set_tests_properties(" << quoted(group.name) << " PROPERTIES LABELS " << quoted(labels) << " TIMEOUT "
           << timeout_s << " COST " << cost_of(group) << threads_of(test) << ")\n";
  }
}

/// Names of the cases of a group, as Catch2 wants them; none if there is no such group.
std::string test_spec_of(std::string_view name) {
  std::string spec;
  for (const Group& group : all_groups()) {
    if (group.name != name) continue;
    for (const Catch::TestCase* test : group.cases) spec += (spec.empty() ? "" : ",") + as_test_spec(test->name);
  }
  return spec;
}

}  // namespace

int main(int argc, char* argv[]) {
  if (argc == 3 && std::string_view(argv[1]) == "--write-ctest-file") {
    write_ctest_file(argv[2], std::filesystem::canonical("/proc/self/exe"));
    return 0;
  }
  std::vector<const char*> arguments(argv, argv + argc);
  std::string spec;
  if (argc >= 3 && std::string_view(argv[1]) == "--group") {
    spec = test_spec_of(argv[2]);
    if (spec.empty()) {
      std::cerr << "no group \"" << argv[2] << "\"; `ctest -N` lists them\n";
      return 2;
    }
    arguments.erase(arguments.begin() + 1);
    arguments[1] = spec.c_str();
  }
  const char* threads = std::getenv("MINAMO_TEST_THREADS");
  tbb::task_arena arena(threads ? std::atoi(threads) : tbb::task_arena::automatic);
  return arena.execute([&] { return Catch::Session().run(static_cast<int>(arguments.size()), arguments.data()); });
}
