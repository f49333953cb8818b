#include "engine/run/simulation.hpp"
#include "support/scene_run.hpp"
#include "systems/step/time_plan.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace minamo;

namespace {

struct Log {
  std::vector<double> steps;
  std::vector<double> frames;  ///< times
  int starts = 0;
  static constexpr ComponentInfo info{"log", "", "1", Lifetime::state};
};
/// What goes wrong, and when.
struct Faults {
  double fail_from = 1e9;        ///< time of the step that throws
  double fail_frame_from = 1e9;  ///< time of the frame that throws
  double longest = 1e9;          ///< longer steps are rejected ...
  double between[2] = {0, 1e9};  ///< ... in this time
  static constexpr ComponentInfo info{"faults", "", "1", Lifetime::constant};
};
struct Step {
  void operator()(Read<Clock> clock, Read<Faults> faults, Update<Log> log) const {
    log->steps.push_back(clock->step);
    if (clock->time >= faults->fail_from) throw std::runtime_error("no");
    const bool in_time = clock->time >= faults->between[0] && clock->time < faults->between[1];
    if (in_time && clock->step > faults->longest) throw StepRejected("too long");
  }
};
struct Frame {
  void operator()(Read<Clock> clock, Read<Faults> faults, Update<Log> log) const {
    if (clock->time >= faults->fail_frame_from) throw std::runtime_error("no room");
    log->frames.push_back(clock->time);
  }
};
struct Start {
  void operator()(Update<Log> log) const { ++log->starts; }
};

struct Recorded {
  std::vector<double> ends;  ///< of steps [s]
  static constexpr ComponentInfo info{"recorded", "", "1", Lifetime::state};
};
struct Record {
  void operator()(Read<Clock> clock, Read<Log>, Update<Recorded> recorded) const {
    recorded->ends.push_back(clock->end_of_step);
  }
};

/// A run of nothing but its clock.
struct Run {
  World world;
  Faults& set_faults = world.resource<Faults>();  // constants are set before schedules are made
  Schedule start{{make_system<Start>("start")}, world};
  Schedule step{{make_system<Step>("step"), make_system<Record>("record")}, world};
  Schedule frame{{make_system<Frame>("frame")}, world};
  std::vector<double> checkpoints;  ///< times
  std::vector<std::string> rejections;
  std::atomic<bool> stop = false;

  Outcome operator()(const TimePlan& plan, Beginning beginning = Beginning::start) {
    return run_simulation(world, start, step, frame, plan,
                          {.after_step = {},
                           .after_rejection = [&](const Clock&, const std::string& why) { rejections.push_back(why); },
                           .write_checkpoint = [&] { checkpoints.push_back(clock().time); }},
                          stop, beginning);
  }
  const Clock& clock() { return world.resource<Clock>(); }
  const StepControl& control() { return world.resource<StepControl>(); }
  Faults& faults() { return set_faults; }
  Log& log() { return world.resource<Log>(); }
  /// Whole numbers of steps of a tenth.
  std::vector<long> recorded() {
    std::vector<long> tenths;
    for (const double end : world.resource<Recorded>().ends) tenths.push_back(std::lround(10 * end));
    return tenths;
  }
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
TimePlan tenths(double end, std::int64_t record_every) {
  TimePlan plan = fixed(end, 0.1, 1);
  plan.record_every = record_every;
  plan.unrecorded = 1;
  return plan;
}

}  // namespace

TEST_CASE("a loop taken step by step is the run", "[unit]") {
  Run whole;
  Run by_hand;
  for (Run* run : {&whole, &by_hand}) run->faults() = {.longest = 0.03, .between = {0.5, 0.6}};
  const TimePlan plan = GENERATE(fixed(1, 0.05, 0.2), chosen(1, 0.07, 0.2));
  whole(plan);
  TimeLoop loop(by_hand.world, by_hand.step, by_hand.frame, plan, {});
  loop.begin(by_hand.start);
  while (!loop.is_over()) loop.take_step();
  CHECK(by_hand.log().steps == whole.log().steps);
  CHECK(by_hand.log().starts == 1);
  CHECK(by_hand.clock().time == 1);
  // The end is a frame here, too.
  CHECK(by_hand.log().frames == whole.log().frames);
}

TEST_CASE("a run with a fixed step ends exactly at its end", "[unit]") {
  Run run;
  run(fixed(5.0, 1e-3, 1));
  CHECK(run.clock().time == 5.0);
  CHECK(run.clock().index == 5000);
}

TEST_CASE("every n-th step is recorded, and the last", "[unit]") {
  Run run;
  SECTION("at the end") {
    run(tenths(1.0, 4));
    CHECK(run.recorded() == std::vector<long>{4, 8, 10});
  }
  SECTION("once, where its turn is at the end") {
    run(tenths(1.0, 5));
    CHECK(run.recorded() == std::vector<long>{5, 10});
  }
  SECTION("after the largest number of steps") {
    TimePlan plan = tenths(1.0, 4);
    plan.max_steps = 6;
    run(plan);
    CHECK(run.recorded() == std::vector<long>{4, 6});
  }
  SECTION("not where the run is interrupted") {
    run.stop = true;
    run(tenths(1.0, 4));
    CHECK(run.recorded().empty());
  }
  CHECK(run.log().steps.size() == static_cast<std::size_t>(run.clock().index));
}

TEST_CASE("the last attempt counts, not the first, for the last step to be recorded", "[unit]") {
  Run run;
  run.faults() = {.longest = 0.06, .between = {0.9, 1}};
  run(tenths(1.0, 100));
  CHECK(run.clock().index == 11);
  CHECK(run.recorded() == std::vector<long>{10});
}

TEST_CASE("a fixed step that does not divide the end is shortened once", "[unit]") {
  Run run;
  run(fixed(1.0, 0.22, 1));
  REQUIRE(run.log().steps.size() == 5);
  CHECK(run.log().steps[3] == Approx(0.22).epsilon(2e-15));
  CHECK(run.log().steps[4] == Approx(0.12).epsilon(2e-15));  // 1 - 4 x 0.22, a rounding
  CHECK(run.clock().time == 1.0);
}

TEST_CASE("a sliver that a fixed step would leave at the end is shared with the step before", "[unit]") {
  Run run;
  run(fixed(1.0, 0.3, 1));
  REQUIRE(run.log().steps.size() == 4);
  CHECK(run.log().steps[1] == 0.3);
  CHECK(run.log().steps[2] == Approx(0.2).epsilon(2e-15));
  CHECK(run.log().steps[3] == Approx(0.2).epsilon(2e-15));
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
  REQUIRE(run.log().steps.size() == 16);  // four times 2 x 0.07 + 2 x 0.055
  CHECK(run.log().steps[1] == 0.07);
  CHECK(run.log().steps[2] == Approx(0.055).epsilon(2e-15));  // half of 0.25 - 0.14, roundings
  CHECK(run.log().steps[3] == Approx(0.055).epsilon(2e-15));
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

TEST_CASE("checkpoints are written at the start, at their interval and at the end", "[unit]") {
  Run run;
  TimePlan plan = fixed(1.0, 0.01, 1);
  plan.checkpoint_every = 0.3;
  run(plan);
  // Times are multiples of the step, one rounding each.
  REQUIRE(run.checkpoints.size() == 5);
  CHECK(run.checkpoints[0] == 0);
  CHECK(run.checkpoints[1] == Approx(0.3).epsilon(1e-15));
  CHECK(run.checkpoints[3] == Approx(0.9).epsilon(1e-15));
  CHECK(run.checkpoints[4] == 1);
}

TEST_CASE("an interrupted run ends after the step, with a checkpoint", "[unit]") {
  Run run;
  run.stop = true;
  CHECK(run(fixed(1.0, 0.01, 1)).ending == Ending::interrupted);
  CHECK(run.clock().index == 1);
  CHECK(run.checkpoints == std::vector<double>{0, 0.01});
}

TEST_CASE("a run whose step throws ends as failed, with its message and a checkpoint of the time before", "[unit]") {
  Run run;
  run.faults().fail_from = 0.495;
  const Outcome outcome = run(fixed(1.0, 0.01, 1));
  CHECK(outcome.ending == Ending::failed);
  CHECK_THAT(outcome.message, Catch::Contains("no"));
  CHECK(run.clock().index == 50);
  CHECK(run.clock().time == 0.5);
  CHECK(run.checkpoints == std::vector<double>{0, 0.5});
  CHECK(run.log().steps.size() == 50);  // the state is that of the last accepted step
}

TEST_CASE("a rejected step is taken back and made in halves that meet the times of whole steps again", "[unit]") {
  Run run;
  run.faults() = {.longest = 0.03, .between = {0.3, 0.35}};
  CHECK(run(fixed(1.0, 0.1, 0.5)).ending == Ending::done);
  // 0.1 and 0.05 are rejected at 0.3; four steps of 0.025, then four of 0.05 after which 0.1 is wanted again.
  const std::vector<double> steps{0.1, 0.1, 0.1, 0.025, 0.025, 0.025, 0.025, 0.05, 0.05, 0.05, 0.05, 0.1, 0.1, 0.1};
  REQUIRE(run.log().steps.size() == steps.size() + 1);
  CHECK(run.log().steps.back() == Approx(0.1).epsilon(2e-15));  // 1 - 0.9, a rounding
  run.log().steps.pop_back();
  CHECK(run.log().steps == steps);
  CHECK(run.rejections == std::vector<std::string>{"too long", "too long"});
  CHECK(run.control().rejected == 2);
  CHECK(run.clock().time == 1.0);
  CHECK(run.log().frames.size() == 3);
  CHECK(run.log().frames[1] == 0.5);
}

TEST_CASE("a chosen step is halved and doubled like a fixed one", "[unit]") {
  Run run;
  run.faults() = {.longest = 0.03, .between = {0.25, 0.3}};
  CHECK(run(chosen(0.5, 0.0625, 10)).ending == Ending::done);
  REQUIRE(run.log().steps.size() == 13);  // 4 x 1/16, 4 x 1/64, 4 x 1/32, and what is left
  CHECK(run.log().steps[4] == 0.015625);
  CHECK(run.log().steps[8] == 0.03125);
  CHECK(run.clock().time == 0.5);
}

TEST_CASE("a step that is rejected at its shortest ends the run with the last accepted state", "[unit]") {
  Run run;
  run.faults() = {.longest = 0, .between = {0.5, 1}};
  const Outcome outcome = run(fixed(1.0, 0.1, 1));
  CHECK(outcome.ending == Ending::failed);
  CHECK_THAT(outcome.message, Catch::Contains("too long") && Catch::Contains("shortest"));
  CHECK(run.clock().time == 0.5);
  CHECK(run.control().rejected == 1 + StepControl::most_halvings);
  CHECK(run.log().steps.size() == 5);
  CHECK(run.checkpoints.back() == 0.5);
}

TEST_CASE("a step whose frame cannot be written is not taken", "[unit]") {
  Run run;
  run.faults().fail_frame_from = 0.45;
  const Outcome outcome = run(fixed(1.0, 0.1, 0.2));
  CHECK(outcome.message == "no room");
  CHECK(run.clock().index == 5);
  CHECK(run.log().steps.size() == 5);
  CHECK(run.log().frames.size() == 3);  // 0, 0.2, 0.4
}

TEST_CASE("a run that goes on meets the times of one that never stopped", "[unit]") {
  const auto plan = GENERATE(fixed(1.0, 0.03, 0.25), chosen(1.0, 0.07, 0.25));
  Run whole;
  whole(plan);
  Run parts;
  TimePlan first = plan;
  first.max_steps = 5;
  parts(first);
  const auto extra_frame = parts.log().frames.size() - 1;
  parts.log().frames.erase(parts.log().frames.begin() + static_cast<std::ptrdiff_t>(extra_frame));
  parts(plan, Beginning::continuation);
  CHECK(parts.log().starts == 1);
  CHECK(parts.log().steps == whole.log().steps);
  CHECK(parts.log().frames == whole.log().frames);
  CHECK(parts.clock().time == whole.clock().time);
}

TEST_CASE("a run that ended between two steps goes on to the next of them", "[unit]") {
  Run run;
  run(fixed(1.0, 0.3, 1));
  run(fixed(1.5, 0.3, 1), Beginning::continuation);
  REQUIRE(run.log().steps.size() == 6);
  CHECK(run.log().steps[4] == Approx(0.2).epsilon(2e-15));  // 1.2 - 1, a rounding
  CHECK(run.log().steps[5] == Approx(0.3).epsilon(2e-15));  // up to the end
}

TEST_CASE("a scene without step or CFL number has one", "[unit]") {
  const Json scene = scene_run::with(scene_run::scene_of_file("dam_break.json"), {R"(/time={"end": 5})"});
  Input::Document document(scene, "scene.json");
  CHECK(read_scene(document.root(), scene_run::registry()).time.cfl == 1);
  CHECK(document.echo()["time"] == Json({{"end", 5}, {"cfl", 1}}));
  CHECK(scene_run::read(scene_run::with(scene, {"/time/max_step=0.01"})).time.max_step == 0.01);
}

TEST_CASE("the step from a CFL number solves (v + b dt) dt = cfl h", "[unit]") {
  const auto [v, b] = GENERATE(std::pair{"0", "-9.81"}, std::pair{"2", "-9.81"}, std::pair{"2", "0"});
  CAPTURE(v, b);
  Json json = scene_run::with(scene_run::scene_of_file("dam_break.json"),
                              {R"(/time={"end": 5, "cfl": 0.4})", R"(/quadrature={"scheme": "mixed"})",
                               std::string("/body_force=[0, ") + b + "]"});
  json["particles"][0]["velocity"] = {std::atof(v), 0};
  const Scene scene = scene_run::read(json);
  World world;
  world.resize<Particles>(1);
  world.column<particle::Velocity<2>>()[0] = {std::atof(v), 0};
  const double dt = make_time_plan(scene).choose_step(world);
  // A root to rounding.
  CHECK((std::atof(v) + std::abs(std::atof(b)) * dt) * dt == Approx(0.4 * 0.0146).epsilon(4e-15));
}

TEST_CASE("the step from a CFL number sees the force where the particles are", "[unit]") {
  // None in the middle of the box, where there is no liquid.
  const Scene scene =
      scene_run::read(scene_run::with(scene_run::scene_of_file("dam_break.json"),
                                      {R"(/time={"end": 5, "cfl": 0.4})", R"(/quadrature={"scheme": "mixed"})",
                                       R"b(/body_force=["100*(x - 0.292)", "100*(y - 0.292)"])b"}));
  World world;
  world.resize<Particles>(2);
  world.column<particle::Velocity<2>>();
  world.column<particle::Position<2>>()[0] = {0.292, 0.292};
  world.column<particle::Position<2>>()[1] = {0.292, 0.092};
  const double dt = make_time_plan(scene).choose_step(world);
  CHECK(20 * dt * dt == Approx(0.4 * 0.0146).epsilon(4e-15));
}

TEST_CASE("steps from a CFL number are short for the body force where waves would grow", "[unit]") {
  Json json = scene_run::with(scene_run::scene_of_file("dam_break.json"), {R"(/time={"end": 5})"});
  World world;
  world.resize<Particles>(1);
  world.column<particle::Velocity<2>>()[0] = {0, 0};
  world.column<particle::Position<2>>()[0] = {0.1, 0.1};
  const auto of_fall = [&](const std::vector<std::string>& method) {
    const Scene scene = scene_run::read(scene_run::with(json, method));
    return make_time_plan(scene).choose_step(world) / std::sqrt(0.0146 / 9.81);
  };
  CHECK(of_fall({R"(/quadrature={"scheme": "mixed"})"}) == Approx(1).epsilon(1e-14));
  CHECK(of_fall({}) == Approx(1.0 / 6).epsilon(1e-14));
  // nu = h sqrt(|b| h)/pi^(3/2): viscosity damps waves of two cells while they would swing.
  const double damped = 1000 * 0.0146 * std::sqrt(9.81 * 0.0146) / std::pow(std::numbers::pi, 1.5);
  const auto thick = [](double viscosity) { return "/fluid/viscosity=" + std::to_string(viscosity); };
  CHECK(of_fall({thick(0.99 * damped)}) == Approx(1.0 / 6).epsilon(1e-14));
  CHECK(of_fall({thick(1.01 * damped)}) == Approx(1).epsilon(1e-14));
  CHECK(of_fall({R"(/integrator={"scheme": "newmark"})"}) == Approx(1.0 / 8).epsilon(1e-14));
  const std::string on_nodes = R"(/discretization={"scheme": "equal_order"})";
  CHECK(of_fall({on_nodes, R"(/integrator={"scheme": "midpoint"})"}) == Approx(1.0 / 3).epsilon(1e-14));
  CHECK(of_fall({on_nodes, R"(/integrator={"scheme": "newmark"})"}) == Approx(1.0 / 8).epsilon(1e-14));
}

TEST_CASE("no step is chosen from a force that is not finite", "[unit]") {
  const Scene scene =
      scene_run::read(scene_run::with(scene_run::scene_of_file("paper/dam_break_tpic.json"),
                                      {R"(/time={"end": 5, "cfl": 0.4})", R"b(/body_force=["1/(x - 0.292)", 0])b"}));
  World world;
  world.resize<Particles>(1);
  world.column<particle::Velocity<2>>();
  world.column<particle::Position<2>>()[0] = {0.292, 0.292};
  CHECK_THROWS_WITH(make_time_plan(scene).choose_step(world),
                    Catch::Contains("body_force is not finite at (0.292, 0.292) m"));
}

TEST_CASE("the step from a CFL number is at most max_step and the time between frames", "[unit]") {
  const Json still = scene_run::with(scene_run::scene_of_file("paper/dam_break_tpic.json"), {"/body_force=[0, 0]"});
  World world;
  world.resize<Particles>(1);
  world.column<particle::Velocity<2>>();
  const Scene bounded = scene_run::read(scene_run::with(still, {R"(/time={"end": 5, "cfl": 0.4, "max_step": 0.01})"}));
  CHECK(make_time_plan(bounded).choose_step(world) == 0.01);
  const Scene unbounded = scene_run::read(scene_run::with(still, {R"(/time={"end": 5, "cfl": 0.4})"}));
  CHECK(make_time_plan(unbounded).choose_step(world) == 0.1);
}

TEST_CASE("what moves may take twice the step of what rests, without bodies", "[unit]") {
  const bool with_bodies = GENERATE(false, true);
  Json json = read_json(std::string(MINAMO_SOURCE_DIR) + "/scenes/dam_break.json");
  json["time"] = {{"end", 5}, {"cfl", 100}};
  json["output"] = {{"every", 5}};
  if (with_bodies)
    json["bodies"] = Json::parse(R"([{"name": "post", "shape": {"ball": {"center": [0.4, 0], "radius": 0.1}}}])");
  const Scene scene = scene_run::read(json);
  World world;
  world.resize<Particles>(1);
  const double h = scene.grid.spacing;
  const double fall = std::sqrt(h / 9.81);
  const auto step_at = [&](double froude) {
    world.column<particle::Velocity<2>>()[0] = {froude * std::sqrt(9.81 * h), 0};
    return make_time_plan(scene).choose_step(world);
  };
  CHECK(step_at(0) == Approx(fall / 6));
  CHECK(step_at(0.5) == Approx(fall / 6));
  CHECK(step_at(0.75) == Approx(with_bodies ? fall / 6 : fall / 4));
  CHECK(step_at(1) == Approx(with_bodies ? fall / 6 : fall / 3));
  CHECK(step_at(10) == Approx(with_bodies ? fall / 6 : fall / 3));
}

TEST_CASE("a step that is rejected after a continuation between two ticks still goes on in time", "[unit]") {
  Run run;
  run(fixed(0.0047, 0.001, 1));
  REQUIRE(run.clock().time == 0.0047);
  run.log().steps.clear();
  run.faults() = {.fail_from = 1e9, .fail_frame_from = 1e9, .longest = 2.5e-4, .between = {0.0047, 0.006}};
  run(fixed(0.01, 0.001, 1), Beginning::continuation);
  for (const double step : run.log().steps) CHECK(step > 1e-5);
  CHECK(run.control().rejected > 0);
  CHECK(run.clock().time == 0.01);
}

TEST_CASE("a continuation shares the sliver before the next tick with the step after it", "[unit]") {
  Run run;
  run(fixed(0.3999, 0.1, 1));
  run.log().steps.clear();
  run(fixed(1.0, 0.1, 1), Beginning::continuation);
  REQUIRE(run.log().steps.size() == 7);
  CHECK(run.log().steps[0] == Approx(0.05005).epsilon(8e-15));
  CHECK(run.log().steps[1] == Approx(0.05005).epsilon(8e-15));
  CHECK(run.log().steps[2] == 0.1);
  CHECK(run.clock().time == 1.0);
}
