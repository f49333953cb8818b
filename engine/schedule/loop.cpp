#include "engine/schedule/loop.hpp"

#include "engine/run/step_control.hpp"

#include <algorithm>

namespace minamo {

namespace {

bool is_same(const Access& x, const Access& y) {
  if (is_of_table(x.mode) || is_of_table(y.mode)) return x.mode == y.mode && x.table == y.table;
  return x.component == y.component;
}

/// What a whole list does to a component that it has touched before.
void combine(Access& so_far, const Access& next) {
  const bool writes = next.mode == Mode::write || next.mode == Mode::update;
  if (so_far.mode == Mode::read && writes) so_far.mode = Mode::update;
  so_far.optional = so_far.optional && next.optional;
}

/// The accesses of a list as those of one system: a component that is written before it is read is written.
std::vector<Access> accesses_of(const std::vector<System>& body, const Access& control) {
  std::vector<Access> all{control};
  for (const System& system : body) {
    for (const Access& access : system.access) {
      const auto known =
          std::find_if(all.begin(), all.end(), [&](const Access& earlier) { return is_same(earlier, access); });
      if (known == all.end()) {
        all.push_back(access);
      } else {
        combine(*known, access);
      }
    }
  }
  return all;
}

}  // namespace

System detail::make_loop(std::string name, std::vector<System> body, int most_passes, const Access& control,
                         std::function<LoopControl&(World&)> control_of) {
  System loop{std::move(name), accesses_of(body, control), {}, {}};
  loop.prepare = [body, control_of](World& world) {
    control_of(world);
    for (const System& system : body) system.prepare(world);
  };
  loop.again = [control_of, most_passes, name = loop.name](World& world, int pass) {
    LoopControl& now = control_of(world);
    if (pass == 0) now.enough = false;
    if (now.enough) return false;
    if (pass == most_passes) {
      throw StepRejected(name + ": not enough after " + std::to_string(most_passes) + " passes");
    }
    now.pass = pass;
    return true;
  };
  loop.run = [body, again = loop.again](World& world) {
    for (int pass = 0; again(world, pass); ++pass) {
      for (const System& system : body) system.run(world);
    }
  };
  loop.without = [name = loop.name, body, most_passes, control, control_of](const Absent& absent) {
    std::vector<System> less;
    for (const System& system : body) less.push_back(system.without ? system.without(absent) : system);
    return detail::make_loop(name, std::move(less), most_passes, control, control_of);
  };
  const bool is_fit = std::none_of(body.begin(), body.end(),
                                   [](const System& system) { return system.on_ranks == OnRanks::one_process; });
  if (is_fit) loop.on_ranks = OnRanks::exchanges;
  loop.body = std::move(body);
  return loop;
}

}  // namespace minamo
