/// \file
/// A target for libFuzzer: what `minamo check` and `minamo study` make of a text before anything runs. Writes nothing.
/// What must hold beyond "no crash": a text is understood or refused with a message that a terminal can show, and what
/// was understood reads again as itself.

#include "engine/schedule/schedule.hpp"
#include "systems/step/register.hpp"
#include "systems/step/scene_size.hpp"
#include "tools/program/scene_file.hpp"
#include "tools/program/study_variant.hpp"

#include <cstdint>
#include <cstdlib>
#include <iostream>

using namespace minamo;

namespace {

const SystemRegistry& registry() {
  static const SystemRegistry systems = [] {
    SystemRegistry made;
    register_parts(made);
    return made;
  }();
  return systems;
}

/// The scene that every study varies, whatever file it names.
const Json& scene_of_studies() {
  static const Json scene = parse_json(R"({"dimension": 2,
    "grid": {"low": [0, 0], "high": [1, 0.5], "cells": [8, 4]}, "fluid": {"density": 1000, "viscosity": 1e-3},
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.5, 0.5]}}}], "exact": {"velocity": [0, 0], "pressure": "x"},
    "time": {"end": 0.02, "step": 0.01}})",
                                       "scene.json");
  return scene;
}

[[noreturn]] void fail(const std::string& what) {
  std::cerr << what << '\n';
  std::abort();
}

/// The message of a refusal is text: UTF-8, without what would steer a terminal.
void check_message(const std::string& message) {
  const bool has_controls = std::any_of(message.begin(), message.end(), [](char c) {
    return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f;
  });
  if (message.empty() || has_controls || !Json::accept(Json(message).dump(-1, ' ', false)))
    fail("not a message: " + message);
}

/// Runs what may be refused.
template <class Reading>
void refuse_or(const Reading& reading) {
  try {
    reading();
  } catch (const InputError& error) {
    check_message(error.what());
  } catch (const ScheduleError& error) {
    check_message(error.what());
  }
}

/// As a run would begin, where that takes no time. [1]
void rehearse_if_small(const SceneFile& file) {
  constexpr double most = 1e4;
  const SceneSize size = size_of(file.scene);
  if (size.particles < most && size.places < 10 * most) rehearse(file.scene, "scene.json");
}

void read_as_scene(const Json& json) {
  const SceneFile file = understand_scene(json, "scene.json", registry());
  try {
    if (understand_scene(file.as_run, "again.json", registry()).as_run != file.as_run) fail("reads again as another");
  } catch (const InputError& error) {
    fail(std::string("does not read again: ") + error.what());
  }
  rehearse_if_small(file);
}

void read_as_study(const Json& json) {
  const Study study = read_study(json, "study.json");
  constexpr std::size_t few = 16;  // a study may have a thousand variants, each of which takes milliseconds
  std::size_t count = 1;
  for (const Parameter& parameter : study.parameters) count *= parameter.values.size();
  if (count > few) return;
  for (const Variant& variant : read_variants(study, scene_of_studies(), registry())) rehearse_if_small(variant.scene);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  refuse_or([&] {
    const Json json = parse_json(std::string(data, data + size), "input.json");
    refuse_or([&] { read_as_scene(json); });
    refuse_or([&] { read_as_study(json); });
  });
  return 0;
}
