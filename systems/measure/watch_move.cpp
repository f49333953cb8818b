#include "systems/measure/watch_move.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

template <int Dim>
void WatchMove<Dim>::operator()(Read<Clock> clock, Read<Grid<Dim>> grid, Read<measure::MaxSpeed> speed,
                                Update<Warnings> warnings) const {
  const double cells = speed->value * clock->step / grid->spacing;
  if (!(cells > longest_sound_move)) return;
  warnings->add("long step",
                fmt::format("the fastest particle crosses {:.3g} cells in the step of {:.4g} s that ends at t = {:.6g} "
                            "s, where results lose accuracy: \"time\": {{\"step\": {:.3g}}} gives a CFL number of 1, "
                            "and {{\"cfl\": 1}} keeps it there",
                            cells, clock->step, clock->end_of_step, clock->step / cells));
}

template struct WatchMove<2>;
template struct WatchMove<3>;

}  // namespace minamo
