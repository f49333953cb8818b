// minamo-mpi for tests: with "random_map": SEED in the scene every block of cells goes to a rank at random, and stays
// there.

#include "systems/ranks/rank_map.hpp"
#include "systems/scene/part.hpp"
#include "systems/scene/scene.hpp"
#include "tools/mpi/mpi_communicator.hpp"
#include "tools/mpi/solve_petsc.hpp"
#include "tools/program/minamo.hpp"

#include <random>

namespace {

using namespace minamo;

/// Of the first blocks of the curve, more than a small scene has.
RankMap random_map(std::uint64_t seed, int ranks) {
  constexpr std::uint64_t blocks = 4096;
  std::mt19937_64 random(seed);
  RankMap map;
  map.most_imbalance = std::numeric_limits<double>::infinity();
  for (std::uint64_t key = 0; key < blocks; ++key) {
    map.begin.push_back(key);
    map.rank.push_back(static_cast<int>(random() % static_cast<std::uint64_t>(ranks)));
  }
  return map;
}

Contribution read_random_map(Input& input, Scene&) {
  const auto seed = static_cast<std::uint64_t>(
      input.integer("random_map", {.doc = "of the random numbers", .fallback = 1, .at_least = 0}));
  return [seed](const Scene&, Recipe& recipe) {
    recipe.seed([seed](const Scene&, World& world, SeedProblems&) {
      world.resource<RankMap>() = random_map(seed, all_ranks()->size());
    });
  };
}

}  // namespace

int main(int argc, char** argv) {
  const MpiSession session;
  return run(argc, argv, [](SystemRegistry& registry) {
    add_petsc(registry);
    registry.add(Part{"random_map", "which rank has which block", read_random_map});
  });
}
