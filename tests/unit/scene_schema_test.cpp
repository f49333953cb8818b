/// \file
/// The JSON Schema of scenes against the scenes that we ship.

#include "support/folder.hpp"

#include "engine/input/input_text.hpp"
#include "systems/scene/scene.hpp"
#include "systems/step/register.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

namespace {

Input::Document described() {
  SystemRegistry registry;
  register_parts(registry);
  Input::Document document = Input::Document::describe();
  describe_scene(document.root(), registry);
  return document;
}

const Json& schema_of_scenes() {
  static const Json schema = described().schema();
  return schema;
}

/// The schemas that say something of a key: of the object itself, and of the alternatives that bring it.
std::vector<Json> schemas_of(const Json& schema, const std::string& key) {
  std::vector<Json> found;
  if (!schema.is_object()) return found;
  if (schema.contains("$ref")) {  // a shape made of shapes
    return schemas_of(schema_of_scenes().at(Json::json_pointer(schema["$ref"].get<std::string>().substr(1))), key);
  }
  if (schema.contains("properties") && schema["properties"].value(key, Json(false)).is_object()) {
    found.push_back(schema["properties"][key]);
  } else if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    found.push_back(schema["additionalProperties"]);
  }
  if (schema.contains("items") && key.find_first_not_of("0123456789") == std::string::npos) {
    found.push_back(schema["items"]);
  }
  for (const char* choice : {"allOf", "oneOf"}) {
    for (const Json& part : schema.value(choice, Json::array())) {
      const auto more = schemas_of(part, key);
      found.insert(found.end(), more.begin(), more.end());
    }
  }
  return found;
}

/// Pointers of the keys that none of the schemas knows.
std::vector<std::string> unknown_keys(const std::vector<Json>& schemas, const Json& value, const std::string& pointer) {
  std::vector<std::string> unknown;
  for (const auto& [key, below] : value.items()) {
    std::vector<Json> of_key;
    for (const Json& schema : schemas) {
      const auto more = schemas_of(schema, key);
      of_key.insert(of_key.end(), more.begin(), more.end());
    }
    const std::string at = pointer + "/" + key;
    if (of_key.empty()) unknown.push_back(at);
    if (of_key.empty() || !below.is_structured()) continue;
    const auto deeper = unknown_keys(of_key, below, at);
    unknown.insert(unknown.end(), deeper.begin(), deeper.end());
  }
  return unknown;
}

/// A small scene as it would run.
Json as_run(const std::string& liquid) {
  SystemRegistry registry;
  register_parts(registry);
  const Json json = Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [8, 8]},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}}], "time": {"end": 1}, )" +
                                liquid + "}");
  Input::Document document(json, "a.json");
  read_scene(document.root(), registry);
  document.require_valid();
  return document.echo();
}

std::vector<std::string> scene_files() {
  std::vector<std::string> files;
  for (const std::string folder : {"/scenes", "/scenes/paper"}) {
    for (const auto& entry : std::filesystem::directory_iterator(MINAMO_SOURCE_DIR + folder)) {
      if (entry.path().extension() == ".json") files.push_back(entry.path().string());
    }
  }
  return files;
}

}  // namespace

TEST_CASE("every key of every scene is in the schema", "[unit]") {
  const std::string file = GENERATE(from_range(scene_files()));
  CAPTURE(file);
  CHECK(unknown_keys({schema_of_scenes()}, read_json(file), "").empty());
}

TEST_CASE("the schema does not know every key", "[unit]") {
  const Json scene = Json::parse(R"({"transfer": {"scheme": "flip", "blend": 1, "blond": 1}, "particles": [{"bal": {}}],
                                     "walls": {"x": "slip", "w": "slip"}})");
  CHECK(unknown_keys({schema_of_scenes()}, scene, "") ==
        std::vector<std::string>{"/transfer/blond", "/particles/0/bal", "/walls/w"});
}

TEST_CASE("the schema holds in two and in three dimensions", "[unit]") {
  const std::string list = GENERATE("/properties/grid/properties/low", "/properties/grid/properties/cells",
                                    "/properties/body_force", "/properties/particles/items/properties/velocity");
  CAPTURE(list);
  const Json lengths = schema_of_scenes().at(Json::json_pointer(list));
  CHECK(lengths["minItems"] == 2);
  CHECK(lengths["maxItems"] == 3);
  CHECK_FALSE(lengths.contains("default"));
}

TEST_CASE("the defaults of the schema are those of a scene that names none", "[unit]") {
  const std::string part = GENERATE("discretization", "transfer", "integrator", "quadrature", "solver", "volume");
  CAPTURE(part);
  const Json properties = schema_of_scenes().at("properties").at(part).at("properties");
  const Json echo = as_run(R"("fluid": {"density": 1000, "viscosity": 0})")[part];
  CHECK(properties["scheme"]["default"] == echo["scheme"]);
}

TEST_CASE("particles need not name the only liquid that has a name", "[unit]") {
  const Json echo = as_run(R"("fluids": {"water": {"density": 1000, "viscosity": 0}})");
  CHECK(echo["particles"][0]["fluid"] == "water");
}

TEST_CASE("describing a scene finds no problems", "[unit]") { CHECK(described().problems().empty()); }
