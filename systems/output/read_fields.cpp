#include "systems/output/read_fields.hpp"

#include "components/fluids.hpp"
#include "components/rheology.hpp"
#include "engine/run/communicator.hpp"
#include "systems/scene/scene.hpp"
#include "systems/transfer/scheme.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <span>

namespace minamo {

namespace {

/// A field, and what a scene must have so that its particles have it; empty: any scene.
struct KnownField {
  std::string name;
  std::string of = {};
};

const std::vector<KnownField>& known_fields() {
  static const std::vector<KnownField> known{{"position"},
                                             {"velocity"},
                                             {"pressure"},
                                             {"id"},
                                             {"mass"},
                                             {"volume"},
                                             {"velocity_gradient", "a transfer scheme with a velocity gradient"},
                                             {"shear_rate", "a liquid with a rheology"},
                                             {"viscosity", "a liquid with a rheology"},
                                             {"fluid", R"(several liquids, "fluids")"}};
  return known;
}

std::vector<std::string> names_of(const std::vector<KnownField>& fields) {
  std::vector<std::string> names;
  for (const KnownField& field : fields) names.push_back(field.name);
  return names;
}

bool has(const Scene& scene, const std::string& field) {
  if (field == "velocity_gradient") {
    const auto* scheme = scene.facts.find<TransferScheme>();
    return scheme == nullptr || scheme->carries_gradient;
  }
  if (field == "shear_rate" || field == "viscosity") return scene.facts.find<Rheology>() != nullptr;
  return field != "fluid" || scene.facts.find<Fluids>() != nullptr;
}

/// What programs that read results count on, and which liquid a particle is of.
const std::vector<std::string>& minimal_fields() {
  static const std::vector<std::string> names{"velocity", "pressure", "fluid"};
  return names;
}

Json schema_of(const std::vector<std::string>& names) {
  const Json list{{"type", "array"}, {"items", {{"enum", names}}}, {"uniqueItems", true}};
  return {{"description",
           R"(of the particles: "all", "minimal" (id, position, velocity, pressure, fluid), or a list of names; )"
           R"(id and position are always there)"},
          {"type", {"string", "array"}},
          {"oneOf", {{{"enum", {"all", "minimal"}}}, list}}};
}

/// Checks an entry of the list.
void check_name(Input& input, const std::string& at, const Json& entry, const Scene& scene) {
  const auto& known = known_fields();
  const std::vector<std::string> names = names_of(known);
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const KnownField& field) { return entry == field.name; });
  if (found == known.end()) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : std::string();
    input.problem(at, "unknown field", one_of_text(names), shown(entry), closest_name(name, names));
  } else if (!has(scene, found->name)) {
    input.problem(at, "is not a field of this scene", found->of, shown(entry));
  }
}

std::optional<std::vector<std::string>> read_names(Input& input, const Scene& scene) {
  const std::vector<std::string> names = names_of(known_fields());
  const Json value = input.raw("fields", schema_of(names), "all");
  if (input.describing() || value == "all") return {};
  if (value == "minimal") return minimal_fields();
  if (!value.is_array()) {
    const std::vector<std::string> words{"all", "minimal"};
    const std::string word = value.is_string() ? value.get<std::string>() : std::string();
    input.problem("fields", value.is_string() ? "unknown choice" : "wrong type",
                  R"("all", "minimal" or a list of fields)", shown(value), closest_name(word, words));
    return {};
  }
  std::vector<std::string> chosen;
  for (std::size_t k = 0; k < value.size(); ++k) {
    const std::string at = fmt::format("fields/{}", k);
    check_name(input, at, value[k], scene);
    if (!value[k].is_string()) continue;
    const auto name = value[k].get<std::string>();
    if (std::find(chosen.begin(), chosen.end(), name) != chosen.end())
      input.problem(at, "is there twice", "every field once", shown(value[k]));
    chosen.push_back(name);
  }
  return chosen;
}

}  // namespace

FieldsChoice read_fields(Input& input, const Scene& scene) {
  FieldsChoice choice{.names = read_names(input, scene)};
  choice.in_single = input.choice("precision", std::vector<std::string>{"single", "double"},
                                  "of the numbers in fields.h5; checkpoints have all digits", "single") == "single";
  choice.compression = static_cast<int>(
      input.integer("compression", {.doc = "of fields.h5, by deflate after a shuffle of bytes: 0 none, 1 fast, 9 least",
                                    .fallback = 0,
                                    .at_least = 0,
                                    .at_most = 9}));
  if (choice.compression > 0 && all_ranks() != nullptr)
    input.problem("compression", "not on several ranks", "0, or one process", shown(Json(choice.compression)));
  return choice;
}

}  // namespace minamo
