/// \file
/// main() of the test programs: Catch2's, and `--write-ctest-file FILE`, which writes the list of tests for ctest.
/// MINAMO_TEST_THREADS=N is what a test may have; without it all the processor has.

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace {

bool is_quick(const std::string& tag) { return tag == "unit" || tag == "property" || tag == "error"; }

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
constexpr bool is_sanitized = true;
#elif defined(MINAMO_ADDRESS_SANITIZER)
constexpr bool looks_for_races = false;
constexpr bool is_sanitized = true;
#else
constexpr bool looks_for_races = false;
constexpr bool is_sanitized = false;
#endif

/// ctest runs as many tests at a time as there are processors. More threads in each would wait for one another, which
/// is a sixth of the time with the sanitizers; those that are about threads count for two.
const char* threads_of(const Catch::TestCase& test) {
  const bool parallel = std::count(test.tags.begin(), test.tags.end(), "threads") > 0;
  if (parallel) return " PROCESSORS 2";
  return looks_for_races ? "" : " ENVIRONMENT MINAMO_TEST_THREADS=1";
}

std::string quoted(const std::string& text) { return "[===[" + text + "]===]"; }

void write_ctest_file(const std::filesystem::path& file, const std::filesystem::path& program) {
  std::ofstream script(file);
  const auto& registry = Catch::getRegistryHub().getTestCaseRegistry();
  for (const Catch::TestCase& test : registry.getAllTests()) {
    if (test.isHidden()) continue;
    std::string labels;
    for (const std::string& tag : test.tags) labels += (labels.empty() ? "" : ";") + tag;
    // A quick test takes milliseconds to seconds; the sanitizers and a busy machine make that minutes.
    const bool quick = !is_sanitized && std::any_of(test.tags.begin(), test.tags.end(), is_quick);
    const int timeout_s = quick ? 120 : 1200;
    script << "add_test(" << quoted(test.name) << ' ' << quoted(program.string()) << ' '
           << quoted(as_test_spec(test.name)) << ")\n"
           << "set_tests_properties(" << quoted(test.name) << " PROPERTIES LABELS " << quoted(labels) << " TIMEOUT "
           << timeout_s << threads_of(test) << ")\n";
  }
}

}  // namespace

int main(int argc, char* argv[]) {
  if (argc == 3 && std::string_view(argv[1]) == "--write-ctest-file") {
    write_ctest_file(argv[2], std::filesystem::canonical("/proc/self/exe"));
    return 0;
  }
  const char* threads = std::getenv("MINAMO_TEST_THREADS");
  tbb::task_arena arena(threads ? std::atoi(threads) : tbb::task_arena::automatic);
  return arena.execute([&] { return Catch::Session().run(argc, argv); });
}
