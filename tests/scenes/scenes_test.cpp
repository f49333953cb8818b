#include "support/scenes.hpp"

#include "components/matrix.hpp"
#include "components/openings.hpp"

#include <filesystem>

using namespace minamo;
using namespace minamo::scene_run;

namespace {

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const std::string folder : {"", "paper/"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(MINAMO_SOURCE_DIR) + "/scenes/" + folder)) {
      if (entry.path().extension() == ".json") names.push_back(folder + entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The scene with at most 2 particles per cell and direction, on a coarse grid in 3-D, and with a fixed step.
Json quick(const std::string& name) {
  Json scene = scene_of_file(name);
  for (Json& particles : scene["particles"]) particles["per_cell"] = std::min(2, particles.value("per_cell", 2));
  if (scene["dimension"] == 3) {
    for (Json& cells : scene["grid"]["cells"]) cells = std::max(3, cells.get<int>() / 2);
  }
  if (!scene["time"].contains("step")) scene["time"] = {{"end", scene["time"]["end"]}, {"step", 1e-3}};
  return scene;
}

/// Names of the state components of doubles with a number that is not finite.
std::vector<std::string> not_finite(World& world) {
  std::vector<std::string> names;
  for (const auto& [name, storage] : world.components()) {
    if (storage->info().lifetime != Lifetime::state || storage->doubles_per_value() == 0) continue;
    const auto bytes = storage->bytes();
    const std::span numbers(reinterpret_cast<const double*>(bytes.data()), bytes.size() / sizeof(double));
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) names.push_back(name);
  }
  return names;
}

/// Names of the components that the step of a scene names; what systems read if it is there does not count.
std::vector<std::string> named(const Json& scene) {
  std::vector<std::string> names;
  for (const System& system : make_pipeline(read(scene)).step) {
    for (const Access& access : system.access) {
      if (!access.optional) names.emplace_back(access.component);
    }
  }
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

TEST_CASE("every scene runs five steps with a finite state and all its mass", "[scene]") {
  const std::string name = GENERATE(from_range(scene_names()));
  CAPTURE(name);
  SceneRun run(quick(name));
  double mass = total_mass(run.world());
  run.step(5);
  for (const double came_in : run.world().column<opening::MassIn>()) mass += came_in;
  CHECK(not_finite(run.world()).empty());
  // The same numbers in another order, up to 25 000 of them: nothing of it was measured.
  CHECK(total_mass(run.world()) == Approx(mass).epsilon(1e-13));
}

TEST_CASE("PIC and FLIP name no velocity gradient", "[scene]") {
  const std::string scheme = GENERATE("pic", "flip");
  CAPTURE(scheme);
  const auto names = named(with_method(scene_of_file("dam_break.json"), scheme, "newmark"));
  CHECK_FALSE(contains(names, "particle.velocity_gradient"));
  CHECK_FALSE(contains(names, "particle.acceleration_gradient"));
}

TEST_CASE("TPIC names the velocity gradient", "[scene]") {
  CHECK(contains(named(with_method(scene_of_file("dam_break.json"), "tpic", "newmark")), "particle.velocity_gradient"));
}

TEST_CASE("an inviscid scene names no viscosity matrix, a viscous one does", "[scene]") {
  CHECK_FALSE(contains(named(with(of_equal_order(scene_of_file("dam_break.json")), {"/fluid/viscosity=0"})),
                       "matrix.viscosity"));
  CHECK(contains(named(of_equal_order(scene_of_file("dam_break.json"))), "matrix.viscosity"));
}

TEST_CASE("the midpoint rule names no acceleration of particles", "[scene]") {
  const auto names = named(with_method(scene_of_file("dam_break.json"), "tpic", "midpoint"));
  CHECK_FALSE(contains(names, "particle.acceleration"));
  CHECK_FALSE(contains(names, "node.acceleration"));
  CHECK_FALSE(contains(names, "staggered.acceleration"));
}

TEST_CASE("the world of a PIC or FLIP scene has no gradient columns", "[scene]") {
  const std::string scheme = GENERATE("pic", "flip");
  CAPTURE(scheme);
  SceneRun run(with_method(scene_of_file("dam_break.json"), scheme, "newmark"));
  run.step();
  CHECK_FALSE(run.world().has<particle::VelocityGradient<2>>());
  CHECK_FALSE(run.world().has<particle::AccelerationGradient<2>>());
}

TEST_CASE("the world of an inviscid scene has no viscosity matrix", "[scene]") {
  SceneRun run(scene_of_file("paper/rotating_square_flip.json"));
  CHECK_FALSE(run.world().has<matrix::Viscosity<2>>());
}

TEST_CASE("the world of a scene in 2-D has no column of space", "[scene]") {
  SceneRun run(scene_of_file("dam_break.json"));
  CHECK_FALSE(run.world().has<particle::Position<3>>());
}
