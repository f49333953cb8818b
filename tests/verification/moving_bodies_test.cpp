/// \file
/// Bodies that move fast, close to others, or where there is no room: what particles beside them may not do.

#include "support/scene_run.hpp"

#include "components/measure.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

double fastest(World& world) { return world.resource<measure::MaxSpeed>().value; }

}  // namespace

TEST_CASE("a fast paddle throws no particle much faster than it moves itself", "[verification]") {
  SceneRun run(with(scene_of_file("paddle.json"), {"/constants/stroke=0.1", "/constants/omega=12"}));
  double most = 0;
  for (int k = 0; k < 125; ++k) {
    run.step();
    most = std::max(most, fastest(run.world()));
  }
  // The paddle reaches 1.2 m/s, and the crest that runs up it 3.0 m/s; 5.6 m/s with unlimited slopes in (E87).
  CHECK(most < 4);
}
