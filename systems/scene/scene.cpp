#include "systems/scene/scene.hpp"

#include "systems/scene/scene_checks.hpp"
#include "systems/scene/scene_words.hpp"

#include <spdlog/fmt/fmt.h>

namespace minamo {

namespace {

/// The dimension. Where the key is missing or wrong, that of the grid, so that its lists are not blamed as well.
int read_dimension(Input& input) {
  const auto dimension = input.integer(
      "dimension", {.doc = "of space, and the length of every list of coordinates", .at_least = 2, .at_most = 3});
  if (input.sound("dimension")) return static_cast<int>(dimension);
  return input.elements("grid/low") == 3 ? 3 : 2;
}

void read_systems(Input& input, const SystemRegistry& registry, Scene& scene) {
  constexpr std::size_t most = 100;  // where each could stand is found by trying
  if (const auto count = input.elements("systems"); count > most)
    input.problem("systems", "too many", fmt::format("at most {}", most), std::to_string(*count));
  std::vector<std::string> names;
  for (const Slot& slot : slots()) names.emplace_back(slot.name);
  input.list("systems", "extra systems in the step", 0, [&](Input& extra, std::size_t) {
    const std::string use = extra.known_name("use", registry.names(), "name of the system, see `minamo list systems`");
    const std::string after = extra.choice("after", names, "slot of the step that it follows");
    if (extra.describing() || !extra.sound("use")) return;
    scene.systems.push_back({registry.make(use, scene.dimension, &extra), after});
  });
}

/// \param described  the dimension in description mode, where the document does not tell.
Scene read_scene(Input& input, const SystemRegistry& registry, std::optional<int> described) {
  input.use_words(scene_words());
  input.optional_text("$schema", "JSON Schema of scenes, for editors; a run takes no notice");
  const std::string title = input.text("title", {.doc = "shown in pictures and reports", .fallback = ""});
  const int dimension = read_dimension(input);
  Scene scene(registry, described.value_or(dimension));
  scene.title = title;
  scene.constants = input.named_numbers("constants", "numbers that expressions may use by name");
  check_constants(input, scene.constants);
  input.use_constants(scene.constants);
  scene.scope = scene_scope(scene.constants);
  std::vector<Contribution> contributions;
  for (const Part& part : registry.in_order<Part>()) {
    if (input.has(part.name) && input.elements(part.name).value_or(1) > 0) scene.keys.insert(part.name);
  }
  for (const Part& part : registry.in_order<Part>()) contributions.push_back(part.read(input, scene));
  read_systems(input, registry, scene);
  if (input.describing() || !input.sound("")) return scene;
  for (const Contribution& contribute : contributions) {
    if (contribute) contribute(scene, scene.recipe);
  }
  return scene;
}

}  // namespace

ExpressionScope scene_scope(const std::map<std::string, double>& constants) {
  return {{"x", "y", "z", "t"}, constants};
}

std::vector<Expression> read_vector(Input& input, const std::string& key, const Scene& scene, const Number& rule) {
  const auto dimension = static_cast<std::size_t>(scene.dimension);
  auto vector = input.expressions(key, dimension, scene.scope, rule);
  for (std::size_t d = 0; d < dimension; ++d) {
    check_coordinates(input, fmt::format("{}/{}", key, d), vector[d], scene.dimension);
  }
  return vector;
}

Scene read_scene(Input& input, const SystemRegistry& registry) { return read_scene(input, registry, {}); }

void describe_scene(Input& input, const SystemRegistry& registry) {
  for (const int dimension : {2, 3}) read_scene(input, registry, dimension);
}

}  // namespace minamo
