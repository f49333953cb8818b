#include "engine/simulation.hpp"
#include "support/scene_run.hpp"
#include "systems/setup/time_plan.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace minamo;

namespace {

struct Log {
  std::vector<double> steps;
  std::vector<double> frames;  ///< times
  int starts = 0;
  double fail_from = 1e9;  ///< time of the step that throws
  static constexpr ComponentInfo info{"log", "", "1", Lifetime::state};
};
struct Step {
  void operator()(Read<Clock> clock, Update<Log> log) const {
    if (clock->time >= log->fail_from) throw std::runtime_error("no");
    log->steps.push_back(clock->step);
  }
};
struct Frame {
  void operator()(Read<Clock> clock, Update<Log> log) const { log->frames.push_back(clock->time); }
};
struct Start {
  void operator()(Update<Log> log) const { ++log->starts; }
};

/// A run of nothing but its clock.
struct Run {
  World world;
  Schedule start{{make_system<Start>("start")}, world};
  Schedule step{{make_system<Step>("step")}, world};
  Schedule frame{{make_system<Frame>("frame")}, world};
  int checkpoints = 0;
  std::atomic<bool> stop = false;

  Outcome operator()(const TimePlan& plan) {
    return run_simulation(world, start, step, frame, plan,
                          {.after_step = {}, .write_checkpoint = [&] { ++checkpoints; }}, stop);
  }
  const Clock& clock() { return world.resource<Clock>(); }
  Log& log() { return world.resource<Log>(); }
};

TimePlan fixed(double end, double step, double every) {
  return {.end = end, .step = step, .choose_step = {}, .frame_every = every, .checkpoint_every = {}, .max_steps = {}};
}
TimePlan chosen(double end, double step, double every) {
  return {.end = end,
          .step = {},
          .choose_step = [step](World&) { return step; },
          .frame_every = every,
          .checkpoint_every = {},
          .max_steps = {}};
}

}  // namespace

TEST_CASE("a run with a fixed step ends exactly at its end", "[unit]") {
  Run run;
  run(fixed(5.0, 1e-3, 1));
  CHECK(run.clock().time == 5.0);
  CHECK(run.clock().index == 5000);
}

TEST_CASE("a fixed step that does not divide the end is shortened once", "[unit]") {
  Run run;
  run(fixed(1.0, 0.3, 1));
  REQUIRE(run.log().steps.size() == 4);
  CHECK(run.log().steps[2] == 0.3);
  CHECK(run.log().steps[3] == Approx(0.1).epsilon(1e-14));  // 1 - 3 x 0.3, a rounding
  CHECK(run.clock().time == 1.0);
}

TEST_CASE("frames fall on the start, on multiples of their interval and on the end", "[unit]") {
  Run run;
  run(fixed(1.0, 0.01, 0.25));
  // Times are multiples of the step, one rounding each.
  REQUIRE(run.log().frames.size() == 5);
  CHECK(run.log().frames.front() == 0);
  CHECK(run.log().frames[1] == Approx(0.25).epsilon(1e-15));
  CHECK(run.log().frames[3] == Approx(0.75).epsilon(1e-15));
  CHECK(run.log().frames.back() == 1.0);
}

TEST_CASE("a frame between two fixed steps is taken after the second", "[unit]") {
  Run run;
  run(fixed(1.0, 0.2, 0.3));
  CHECK(run.log().frames.size() == 4);  // 0, 0.4 for 0.3, 0.6, 1.0 for 0.9 and the end
}

TEST_CASE("a chosen step is shortened to meet frames and the end", "[unit]") {
  Run run;
  run(chosen(1.0, 0.07, 0.25));
  REQUIRE(run.log().frames.size() == 5);
  CHECK(run.log().frames[1] == 0.25);
  CHECK(run.log().frames[2] == 0.5);
  CHECK(run.clock().time == 1.0);
  CHECK(run.log().steps.size() == 16);  // four times 3 x 0.07 + 0.04
}

TEST_CASE("a run stops after its largest number of steps, with a frame", "[unit]") {
  Run run;
  TimePlan plan = fixed(1.0, 0.01, 0.25);
  plan.max_steps = 3;
  CHECK(run(plan).ending == Ending::done);
  CHECK(run.clock().index == 3);
  CHECK(run.log().frames.size() == 2);
}

TEST_CASE("a run of no steps has its start and a frame", "[unit]") {
  Run run;
  TimePlan plan = fixed(1.0, 0.01, 0.25);
  plan.max_steps = 0;
  run(plan);
  CHECK(run.log().starts == 1);
  CHECK(run.log().frames == std::vector<double>{0});
}

TEST_CASE("checkpoints are written at their interval", "[unit]") {
  Run run;
  TimePlan plan = fixed(1.0, 0.01, 1);
  plan.checkpoint_every = 0.2;
  run(plan);
  CHECK(run.checkpoints == 5);
}

TEST_CASE("an interrupted run ends after the step, with a checkpoint", "[unit]") {
  Run run;
  run.stop = true;
  CHECK(run(fixed(1.0, 0.01, 1)).ending == Ending::interrupted);
  CHECK(run.clock().index == 1);
  CHECK(run.checkpoints == 1);
}

TEST_CASE("a run whose step throws ends as failed, with its message and a checkpoint of the time before", "[unit]") {
  Run run;
  run.log().fail_from = 0.495;
  const Outcome outcome = run(fixed(1.0, 0.01, 1));
  CHECK(outcome.ending == Ending::failed);
  CHECK_THAT(outcome.message, Catch::Contains("no"));
  CHECK(run.clock().index == 50);
  CHECK(run.clock().time == 0.5);
  CHECK(run.checkpoints == 1);
}

TEST_CASE("the step from a CFL number solves (v + b dt) dt = cfl h", "[unit]") {
  const auto [v, b] = GENERATE(std::pair{"0", "-9.81"}, std::pair{"2", "-9.81"}, std::pair{"2", "0"});
  CAPTURE(v, b);
  Json json = scene_run::with(scene_run::scene_of_file("dam_break.json"),
                              {R"(/time={"end": 5, "cfl": 0.4})", std::string("/body_force=[0, ") + b + "]"});
  json["particles"][0]["velocity"] = {std::atof(v), 0};
  const Scene scene = scene_run::read(json);
  World world;
  world.resize<Particles>(1);
  world.column<particle::Velocity<2>>()[0] = {std::atof(v), 0};
  const double dt = make_time_plan(scene).choose_step(world);
  // A root to rounding.
  CHECK((std::atof(v) + std::abs(std::atof(b)) * dt) * dt == Approx(0.4 * 0.0146).epsilon(1e-13));
}

TEST_CASE("the step from a CFL number is at most max_step and the time between frames", "[unit]") {
  const Json still = scene_run::with(scene_run::scene_of_file("dam_break.json"), {"/body_force=[0, 0]"});
  World world;
  world.resize<Particles>(1);
  world.column<particle::Velocity<2>>();
  const Scene bounded = scene_run::read(scene_run::with(still, {R"(/time={"end": 5, "cfl": 0.4, "max_step": 0.01})"}));
  CHECK(make_time_plan(bounded).choose_step(world) == 0.01);
  const Scene unbounded = scene_run::read(scene_run::with(still, {R"(/time={"end": 5, "cfl": 0.4})"}));
  CHECK(make_time_plan(unbounded).choose_step(world) == 0.1);
}
