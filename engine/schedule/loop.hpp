#pragma once
/// \file
/// A list of systems repeated within the step until one of them says that it is enough, as nonlinear equations need.

#include "engine/schedule/system.hpp"

namespace minamo {

/// What a loop and its systems tell each other. Every loop has a component of its own that derives from this; a system
/// of the loop updates it and sets `enough`.
struct LoopControl {
  int pass = 0;         ///< 0, 1, 2, ...; set by the loop
  bool enough = false;  ///< set by one of its systems: no further pass
};

namespace detail {
System make_loop(std::string name, std::vector<System> body, int most_passes, const Access& control,
                 std::function<LoopControl&(World&)> control_of);
}

/// A system that runs `body` in the order of the list, again and again, in the same order whatever the number of
/// threads. To the schedule it is one system, which reads what its body reads before it writes it; every system of the
/// body has a row of its own in the profile.
/// The loop throws StepRejected if after `most_passes` none of its systems has said that it is enough, so that the step
/// is taken back and made again at half its length.
template <ResourceComponent Control>
requires std::is_base_of_v<LoopControl, Control> System make_loop(std::string name, std::vector<System> body,
                                                                  int most_passes) {
  return detail::make_loop(std::move(name), std::move(body), most_passes, Write<Control>::access(),
                           [](World& world) -> LoopControl& { return world.resource<Control>(); });
}

}  // namespace minamo
