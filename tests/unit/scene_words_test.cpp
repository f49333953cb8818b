/// \file
/// Words of other programs: every one of them, at the place where one would write it, is answered with what it is here.

#include "engine/input/input.hpp"
#include "support/build.hpp"
#include "support/scene_run.hpp"
#include "systems/scene/scene.hpp"
#include "systems/scene/scene_words.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <set>

using namespace minamo;

namespace {

using Of = OtherWord::Of;

/// A scene with an object at every place.
Json scene_of_all_places() {
  return Json::parse(R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [8, 8]},
    "fluid": {"density": 1000, "viscosity": 1e-3},
    "surface_tension": {"coefficient": 0.072}, "transfer": {"scheme": "flip"}, "solver": {"scheme": "block"},
    "bodies": [{"name": "a", "shape": {"ball": {"center": [0.5, 0.5], "radius": 0.1}},
                "motion": {"prescribed": {"velocity": [0, 0], "rotation": {"rate": 0}}}}],
    "openings": [{"name": "in", "side": "x_low", "inflow": {"velocity": [1, 0]}}],
    "probes": [{"name": "P", "at": [0.5, 0.5]}],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.5, 0.5]}}}],
    "time": {"end": 0.1, "step": 0.01}, "output": {"every": 0.05}})");
}

std::vector<Problem> problems_of(const Json& scene) {
  Input::Document document(scene, "a.json");
  read_scene(document.root(), scene_run::registry());
  document.finish();
  return document.problems();
}

std::string last_step(const std::string& pointer) { return pointer.substr(pointer.rfind('/') + 1); }

/// Where the key of a word would stand that names no place itself.
std::string place_of_key(const OtherWord& other) {
  static const std::map<std::string, std::string> places{{"low", "/particles/0/shape/box"},
                                                         {"high", "/particles/0/shape/box"},
                                                         {"center", "/particles/0/shape/ball"},
                                                         {"radius", "/particles/0/shape/ball"},
                                                         {"radii", "/particles/0/shape/ellipsoid"},
                                                         {"angle", "/particles/0/shape/box"},
                                                         {"from", "/particles/0/shape/capsule"},
                                                         {"to", "/particles/0/shape/capsule"},
                                                         {"normal", "/particles/0/shape/half_space"},
                                                         {"vertices", "/particles/0/shape/polygon"},
                                                         {"file", "/particles/0/shape/mesh"},
                                                         {"scale", "/particles/0/shape/mesh"},
                                                         {"move", "/particles/0/shape/mesh"},
                                                         {"shape", "/particles/0"},
                                                         {"coefficient", "/surface_tension"},
                                                         {"contact_angle", "/surface_tension"},
                                                         {"yield_stress", "/fluid/rheology/herschel_bulkley"},
                                                         {"consistency", "/fluid/rheology/herschel_bulkley"},
                                                         {"index", "/fluid/rheology/herschel_bulkley"},
                                                         {"bingham", "/fluid/rheology"},
                                                         {"carreau", "/fluid/rheology"},
                                                         {"power_law", "/fluid/rheology"},
                                                         {"prescribed", "/bodies/0/motion"},
                                                         {"free", "/bodies/0/motion"},
                                                         {"rotation", "/bodies/0/motion/prescribed"},
                                                         {"inflow", "/openings/0"},
                                                         {"outflow", "/openings/0"},
                                                         {"side", "/openings/0"},
                                                         {"level", "/openings/0/inflow"},
                                                         {"scheme", "/transfer"},
                                                         {"blend", "/transfer"},
                                                         {"at", "/probes/0"}};
  if (other.means == "rate")
    return other.word == "flow_rate" || other.word == "q" || other.word == "flux" || other.word == "discharge" ||
                   other.word == "volume_flow"
               ? "/openings/0/inflow"
               : "/bodies/0/motion/prescribed/rotation";
  const auto found = places.find(std::string(other.means));
  return found == places.end() ? "/particles/0/shape" : found->second;
}

/// Where a word would stand, and what the message calls it there.
struct Place {
  std::string pointer;  ///< of the object
  std::string closest;
};

Place place_of(const OtherWord& other) {
  const std::string means(other.means);
  if (means.front() != '/') return {place_of_key(other), means};
  const std::string key = last_step(means);
  if (key == other.word) return {"", means};  // right, in the wrong object
  std::string parent = means.substr(0, means.rfind('/'));
  if (const auto star = parent.find('*'); star != std::string::npos) parent.replace(star, 1, "0");
  return {parent, key};
}

/// The scene with an object there, of which a key has another name.
Json with_word(const Place& place, const std::string& key, const std::string& word) {
  Json scene = scene_of_all_places();
  if (place.pointer.starts_with("/particles/0/shape")) scene["particles"][0]["shape"] = Json::object();
  if (place.pointer.starts_with("/particles/0/shape/mesh")) scene["dimension"] = 3;
  if (place.pointer.starts_with("/fluid/rheology")) scene["fluid"] = {{"density", 1000}};
  if (place.pointer == "/openings/0/inflow") scene["openings"][0]["inflow"] = Json::object();
  if (key == "max_step") scene["time"].erase("step");
  Json& object = scene[Json::json_pointer(place.pointer)];
  if (object.is_null()) object = Json::object();
  object.erase(key);
  object[word] = 1;
  return scene;
}

std::vector<OtherWord> words_of(Of of) {
  std::vector<OtherWord> words;
  for (const OtherWord& other : scene_words()) {
    if (other.of == of) words.push_back(other);
  }
  return words;
}

/// The problem at a place; there is one.
Problem problem_at(const std::vector<Problem>& problems, const std::string& pointer) {
  std::vector<Problem> there;
  for (const Problem& problem : problems) {
    if (problem.pointer == pointer) there.push_back(problem);
  }
  CHECK(there.size() == 1);
  return there.empty() ? Problem{} : there[0];
}

/// An expression that a person would write with a word.
std::string expression_with(const std::string& word) {
  static const std::set<std::string> constants{"math.pi", "np.pi", "numpy.pi", "M_PI", "PI", "Pi", "e", "time"};
  if (word == "!" || word == "not") return word + " (x < 1)";
  if (word == "and" || word == "or" || std::isalpha(static_cast<unsigned char>(word[0])) == 0)
    return "(x < 1) " + word + " (y < 1)";
  return constants.contains(word) ? "x < 2*" + word : "x < " + word + "(y)";
}

/// Of how many words one is tried: all of them, but a sample where the sanitizers make each ten times dearer.
const std::size_t stride = is_address_sanitized() ? 7 : 1;

}  // namespace

TEST_CASE("a key of another program is answered with ours, and a missing key is not told besides", "[unit]") {
  const std::vector<OtherWord> words = words_of(Of::key);
  REQUIRE(words.size() > 300);
  for (std::size_t k = 0; k < words.size(); k += stride) {
    const OtherWord& other = words[k];
    const std::string word(other.word);
    const Place place = place_of(other);
    const std::string key = last_step(std::string(other.means));
    CAPTURE(word, other.means, place.pointer);
    const auto problems = problems_of(with_word(place, place.pointer.empty() && key == word ? "" : key, word));
    const Problem problem = problem_at(problems, place.pointer + "/" + word);
    CHECK(problem.what == "unknown key");
    CHECK(problem.closest == place.closest);
    for (const Problem& other_problem : problems) {
      if (key != word) CHECK(other_problem.pointer != place.pointer + "/" + key);
    }
  }
}

TEST_CASE("a name of another program is answered with ours", "[unit]") {
  const std::map<std::string, std::string> places{{"slip", "/walls"},
                                                  {"no_slip", "/walls"},
                                                  {"periodic", "/walls/x"},
                                                  {"separating", "/walls"},
                                                  {"equal_order", "/discretization/scheme"},
                                                  {"conforming", "/discretization/scheme"},
                                                  {"apic", "/transfer/scheme"},
                                                  {"flip", "/transfer/scheme"},
                                                  {"tpic", "/transfer/scheme"},
                                                  {"midpoint", "/integrator/scheme"},
                                                  {"newmark", "/integrator/scheme"},
                                                  {"umfpack", "/solver/scheme"},
                                                  {"block", "/solver/scheme"},
                                                  {"none", "/volume/scheme"},
                                                  {"jittered", "/particles/0/arrangement"},
                                                  {"lattice", "/particles/0/arrangement"},
                                                  {"x_low", "/openings/0/side"},
                                                  {"x_high", "/openings/0/side"},
                                                  {"y_low", "/openings/0/side"},
                                                  {"y_high", "/openings/0/side"},
                                                  {"vtp", "/output/surface"},
                                                  {"ply", "/output/surface"}};
  for (const OtherWord& other : words_of(Of::name)) {
    const std::string word(other.word);
    const std::string means(other.means);
    CAPTURE(word, means);
    Json scene = scene_of_all_places();
    std::string pointer;
    if (means == "x" || means == "y") {  // an axis is a key
      pointer = "/walls/" + word;
      scene["walls"] = {{word, "slip"}};
    } else {
      pointer = places.at(means);
      scene[Json::json_pointer(pointer)] = word;
    }
    CHECK(problem_at(problems_of(scene), pointer).closest == means);
  }
}

TEST_CASE("a word of another language in an expression is answered with ours", "[unit]") {
  for (const OtherWord& other : words_of(Of::expression)) {
    const std::string expression = expression_with(std::string(other.word));
    CAPTURE(expression);
    Json scene = scene_of_all_places();
    scene["particles"][0]["shape"] = {{"where", expression}};
    const Problem problem = problem_at(problems_of(scene), "/particles/0/shape/where");
    CHECK(problem.closest == other.means);
  }
}

TEST_CASE("a meaning leads to a key that there is", "[unit]") {
  Input::Document document = Input::Document::describe();
  describe_scene(document.root(), scene_run::registry());
  const std::string table = document.key_table();
  for (const OtherWord& other : words_of(Of::key)) {
    CAPTURE(other.means);
    const std::string pointer = other.means.front() == '/' ? std::string(other.means) : "/" + std::string(other.means);
    CHECK_THAT(table, Catch::Contains(pointer + " |"));
  }
}

TEST_CASE("words are the same whatever their case and what joins their parts", "[unit]") {
  CHECK(are_same_word("time_step", "timeStep"));
  CHECK(are_same_word("time_step", "Time-Step"));
  CHECK(are_same_word("", "_"));
  CHECK_FALSE(are_same_word("time", "timestep"));
  CHECK_FALSE(are_same_word("dt", ""));
}

TEST_CASE("a constant of the scene is not taken for a word of another language", "[unit]") {
  Json scene = scene_of_all_places();
  scene["constants"] = {{"e", 0.1}};
  scene["particles"][0]["shape"] = {{"where", "x < e*yy"}};
  CHECK(problem_at(problems_of(scene), "/particles/0/shape/where").closest == "y");
}
