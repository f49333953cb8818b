#pragma once
/// \file
/// Scenes of tests, and the methods that they run with.

#include "support/scene_run.hpp"

#include <catch2/catch.hpp>

namespace minamo::scene_run {

/// A scene with the methods of the paper this project reproduces, spelled out: a test does not follow a new default.
inline Json paper(Json scene) {
  scene["transfer"] = {{"scheme", "tpic"}, {"inertia", "lumped"}, {"spin", "gradient"}};
  scene["integrator"] = {{"scheme", "newmark"}};
  scene["stabilization"] = {{"scheme", "pspg"}};
  scene["quadrature"] = {{"scheme", "particles"}};
  scene["volume"] = {{"scheme", "none"}};
  scene["solver"] = {{"scheme", "umfpack"}};
  return scene;
}

inline Json with_method(const Json& scene, const std::string& transfer, const std::string& integrator) {
  return with(scene,
              {R"(/transfer={"scheme": ")" + transfer + "\"}", R"(/integrator={"scheme": ")" + integrator + "\"}"});
}

/// Every transfer scheme with every integrator.
inline Json any_method(const Json& scene) {
  const std::string transfer = GENERATE("pic", "flip", "tpic", "tpic2", "apic", "xpic", "fmpm");
  const std::string integrator = GENERATE("newmark", "midpoint");
  return with_method(scene, transfer, integrator);
}

}  // namespace minamo::scene_run
