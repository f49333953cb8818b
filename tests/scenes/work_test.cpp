/// \file
/// Systems from outside that give the liquid energy: what a run tells of it.

#include "tools/program/minamo.hpp"

#include "engine/input/problem.hpp"
#include "engine/schedule/parallel.hpp"
#include "support/folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

using namespace minamo;

namespace {

constexpr double speed_up = 1.01;

/// A user's system that blows, as tools/example_part does.
template <int Dim>
struct Blow {
  static constexpr std::string_view doc = "b_f += 2 m/s^2 along x";
  void operator()(Update<face::BodyForce<Dim>> b_f) const {
    for_each_row(b_f.size(), [&](std::size_t f) { b_f[f][0] += 2; });
  }
};

template <int Dim>
struct BlowAtNodes {
  static constexpr std::string_view doc = "b_I += 2 m/s^2 along x";
  void operator()(Update<node::BodyForce<Dim>> b_i) const {
    for_each_row(b_i.size(), [&](std::size_t i) { b_i[i][0] += 2; });
  }
};

/// One that makes particles faster, and tells nobody.
template <int Dim>
struct Kick {
  static constexpr std::string_view doc = "v_p times 1.01";
  void operator()(Update<particle::Velocity<Dim>> v_p) const {
    for_each_row(v_p.size(), [&](std::size_t p) { v_p[p] *= speed_up; });
  }
};

/// The same, said.
template <int Dim>
struct KickAndSay {
  static constexpr std::string_view doc = "v_p times 1.01, and the energy of it";
  void operator()(Read<particle::Mass> m_p, Update<particle::Velocity<Dim>> v_p, Update<EnergyGiven> given) const {
    for (std::size_t p = 0; p < v_p.size(); ++p) {
      given->value += 0.5 * m_p[p] * v_p[p].squaredNorm() * (speed_up * speed_up - 1);
      v_p[p] *= speed_up;
    }
  }
};

nlohmann::json summary_with(const std::string& systems, const std::string& discretization = "conforming") {
  const Folder folder;
  std::ofstream(folder / "scene.json") << R"({
    "dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [16, 16]}, "walls": {"x": "periodic"},
    "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
    "particles": [{"shape": {"box": {"low": [0, 0], "high": [1, 0.5]}}, "velocity": [0.5, 0]}],
    "time": {"end": 1, "step": 0.01}, "systems": )" +
                                              systems + R"(, "discretization": {"scheme": ")" + discretization + "\"}}";
  const std::string scene = folder / "scene.json";
  const std::string out = folder / "out";
  const std::vector<const char*> arguments{"minamo",    "run",     scene.c_str(), "--out",
                                           out.c_str(), "--steps", "60",          "--quiet"};
  spdlog::drop("minamo");  // the program makes it, once per process
  REQUIRE(minamo::run(static_cast<int>(arguments.size()), arguments.data(), [](SystemRegistry& registry) {
            registry.add<Blow>("blow");
            registry.add<BlowAtNodes>("blow_at_nodes");
            registry.add<Kick>("kick");
            registry.add<KickAndSay>("kick_and_say");
          }) == 0);
  return nlohmann::json::parse(text_of(out + "/summary.json"));
}

}  // namespace

TEST_CASE("work of a force that a system from outside adds is no gain of energy", "[scene]") {
  CHECK(summary_with(R"([{"use": "blow", "after": "material"}])")["warnings"].empty());
  CHECK(summary_with(R"([{"use": "blow_at_nodes", "after": "forces"}])", "equal_order")["warnings"].empty());
}

TEST_CASE("energy that a system from outside gives is told, unless the system says so itself", "[scene]") {
  CHECK_THAT(summary_with(R"([{"use": "kick", "after": "g2p"}])")["warnings"].dump(),
             Catch::Contains("energy rose by"));
  CHECK(summary_with(R"([{"use": "kick_and_say", "after": "g2p"}])")["warnings"].empty());
}
