#include "tools/program/minamo.hpp"

#include "engine/run/step_control.hpp"
#include "support/folder.hpp"

#include <catch2/catch.hpp>
#include <spdlog/spdlog.h>

#include <chrono>
#include <thread>

using namespace minamo;

namespace {

/// A user's system that rejects the sixth step at its full length, late enough for the history next to it to be
/// written.
template <int Dim>
struct RefuseSixth {
  static constexpr std::string_view doc = "rejects a step";
  void operator()(Read<Clock> clock, Read<particle::Mass>) const {
    if (clock->index != 5 || clock->step < 9e-4) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    throw StepRejected("refuse_sixth: no");
  }
};

std::string history_with(const std::string& after, const std::string& threads, const Folder& folder,
                         const std::string& steps = "12", const std::string& every = "1") {
  const std::string scene = MINAMO_SOURCE_DIR "/scenes/paper/dam_break_tpic.json";
  const std::string out = folder / ("out_" + after + threads);
  const std::string systems = R"(/systems=[{"use": "refuse_sixth", "after": ")" + after + "\"}]";
  const std::string interval = "/output/history=" + every;
  const std::vector<const char*> arguments{"minamo",  "run",       scene.c_str(),   "--steps",      steps.c_str(),
                                           "--quiet", "--set",     systems.c_str(), "--set",        interval.c_str(),
                                           "--out",   out.c_str(), "--threads",     threads.c_str()};
  const auto add = [](SystemRegistry& registry) { registry.add<RefuseSixth>("refuse_sixth"); };
  spdlog::drop("minamo");  // the program makes it, once per process
  REQUIRE(run(static_cast<int>(arguments.size()), arguments.data(), add) == 0);
  return text_of(out + "/history.csv");
}

}  // namespace

TEST_CASE("a step that a system rejects after the history leaves no row", "[scene]") {
  const Folder folder;
  const std::string expected = history_with("sort", "1", folder);
  CHECK(std::count(expected.begin(), expected.end(), '\n') == 2 + 12);
  CHECK(history_with("record", "1", folder) == expected);
  CHECK(history_with("measure", "2", folder) == expected);
  CHECK(history_with("g2p", "2", folder) == expected);
}

TEST_CASE("a last step that a system rejects after the history leaves no row out of turn", "[scene]") {
  const Folder folder;
  const std::string expected = history_with("sort", "1", folder, "6", "4");
  CHECK(std::count(expected.begin(), expected.end(), '\n') == 2 + 2);
  CHECK_THAT(expected, Catch::Contains("\n6,"));
  CHECK(history_with("record", "1", folder, "6", "4") == expected);
  CHECK(history_with("record", "2", folder, "6", "4") == expected);
}
