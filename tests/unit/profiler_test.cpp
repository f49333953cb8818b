#include "engine/run/profiler.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>

using namespace minamo;
using namespace std::chrono_literals;

namespace {

const Profiler::Time noon = std::chrono::steady_clock::now();

/// A file that is gone when its test ends.
struct TraceFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("minamo_trace_" + std::to_string(std::random_device{}()) + ".json"))
          .string();
  TraceFile() = default;
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;
  ~TraceFile() { std::filesystem::remove(path); }
};

nlohmann::json events_of(const Profiler& profiler) {
  const TraceFile file;
  profiler.write_trace(file.path);
  return nlohmann::json::parse(std::ifstream(file.path)).at("traceEvents");
}

}  // namespace

TEST_CASE("a row counts its calls and adds up their time", "[unit]") {
  Profiler profiler;
  const std::size_t row = profiler.add_row("solve");
  profiler.record(row, noon, noon + 2ms);
  profiler.record(row, noon + 5ms, noon + 6ms);
  REQUIRE(profiler.rows().size() == 1);
  CHECK(profiler.rows()[0].name == "solve");
  CHECK(profiler.rows()[0].calls == 2);
  CHECK(profiler.rows()[0].seconds == Approx(3e-3).epsilon(1e-15));
}

TEST_CASE("rows of one name are shown as one, in the order in which the names came", "[unit]") {
  Profiler profiler;
  const std::size_t first = profiler.add_row("solve");
  profiler.add_row("assemble");
  const std::size_t second = profiler.add_row("solve");
  profiler.record(first, noon, noon + 1ms);
  profiler.record(second, noon, noon + 1ms);
  const auto rows = profiler.rows();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].name == "solve");
  CHECK(rows[0].calls == 2);
  CHECK(rows[1].name == "assemble");
}

TEST_CASE("different rows may be recorded at the same time", "[unit]") {
  Profiler profiler(true);
  const std::size_t left = profiler.add_row("left");
  const std::size_t right = profiler.add_row("right");
  const auto record_many = [&profiler](std::size_t row) {
    for (int call = 0; call < 1000; ++call) profiler.record(row, noon, noon + 1us);
  };
  std::thread other(record_many, right);
  record_many(left);
  other.join();
  CHECK(profiler.rows()[left].calls == 1000);
  CHECK(profiler.rows()[right].calls == 1000);
}

TEST_CASE("a lap records one call and ends where the next begins", "[unit]") {
  Profiler profiler;
  const std::size_t row = profiler.add_row("solve");
  Profiler::Time begin = std::chrono::steady_clock::now();
  const Profiler::Time first = begin;
  { const Lap lap(profiler, row, begin); }
  CHECK(profiler.rows()[row].calls == 1);
  CHECK(profiler.rows()[row].seconds == std::chrono::duration<double>(begin - first).count());
}

TEST_CASE("the table shows the largest row first and the sum last", "[unit]") {
  Profiler profiler;
  profiler.record(profiler.add_row("assemble"), noon, noon + 1ms);
  profiler.record(profiler.add_row("solve"), noon, noon + 3ms, 6e6);
  profiler.add_row("never");
  CHECK(profiler.table(8e-3) == "system        calls      seconds      us/call    GB/s     share\n"
                                "solve             1       0.0030       3000.0    2.00    37.5 %\n"
                                "assemble          1       0.0010       1000.0       -    12.5 %\n"
                                "never             0       0.0000            -       -     0.0 %\n"
                                "sum                       0.0040                         50.0 %\n");
}

TEST_CASE("without a wall time the table has no shares", "[unit]") {
  Profiler profiler;
  profiler.record(profiler.add_row("solve"), noon, noon + 3ms);
  CHECK_THAT(profiler.table(0), !Catch::Contains("%"));
}

TEST_CASE("the trace has a complete event in us for every call", "[unit]") {
  Profiler profiler(true);
  const std::size_t row = profiler.add_row("say \"solve\"");
  const Profiler::Time begin = std::chrono::steady_clock::now();
  profiler.record(row, begin, begin + 1500ns);
  profiler.record(row, begin + 2ms, begin + 3ms);
  const auto events = events_of(profiler);
  REQUIRE(events.size() == 2);
  CHECK(events[0].at("name") == "say \"solve\"");
  CHECK(events[0].at("ph") == "X");
  // Times are written with three digits behind the point.
  CHECK(events[0].at("dur").get<double>() == Approx(1.5).epsilon(0).margin(1e-3));
  CHECK(events[1].at("ts").get<double>() - events[0].at("ts").get<double>() == Approx(2000).epsilon(0).margin(2e-3));
}

TEST_CASE("the trace numbers threads in order of their first call", "[unit]") {
  Profiler profiler(true);
  const std::size_t early = profiler.add_row("early");
  const std::size_t late = profiler.add_row("late");
  // The thread that records first, by the time of its call, is not the one that was numbered first.
  profiler.record(late, noon + 5ms, noon + 6ms);
  std::thread([&profiler, early] { profiler.record(early, noon, noon + 1ms); }).join();
  const auto events = events_of(profiler);
  REQUIRE(events.size() == 2);
  CHECK(events[0].at("name") == "early");
  CHECK(events[0].at("tid") == 0);
  CHECK(events[1].at("tid") == 1);
}

TEST_CASE("calls of one thread share a row of the trace", "[unit]") {
  Profiler profiler(true);
  profiler.record(profiler.add_row("left"), noon, noon + 1ms);
  profiler.record(profiler.add_row("right"), noon + 1ms, noon + 2ms);
  const auto events = events_of(profiler);
  REQUIRE(events.size() == 2);
  CHECK(events[0].at("tid") == events[1].at("tid"));
}

TEST_CASE("a profiler that keeps no events writes a trace without events", "[unit]") {
  Profiler profiler;
  profiler.record(profiler.add_row("solve"), noon, noon + 1ms);
  CHECK_FALSE(profiler.keeps_events());
  CHECK(events_of(profiler).empty());
}

TEST_CASE("a trace that cannot be written names the file and the reason", "[unit][error]") {
  CHECK_THROWS_WITH(Profiler(true).write_trace("/no/such/folder/trace.json"),
                    "/no/such/folder/trace.json: cannot be written (No such file or directory)");
}
