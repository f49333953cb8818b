// Bodies in fields.h5 and fields.xdmf.

#include "support/program.hpp"
#include "support/program_output.hpp"

#include "engine/storage/hdf5.hpp"

#include <catch2/catch.hpp>

#include <cstring>
#include <fstream>

using namespace minamo;

namespace {

std::vector<double> numbers_of(const Hdf5File& file, const std::string& dataset) {
  const auto bytes = file.read_bytes(dataset);
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// Twenty steps of the mixer with an endless floor, a frame every tenth.
const std::string mixer_on_a_floor = R"({
  "dimension": 2, "grid": {"low": [-0.5, -0.5], "high": [0.5, 0.5], "cells": [20, 20]},
  "fluid": {"density": 1000, "viscosity": 1e-3}, "body_force": [0, -9.81],
  "particles": [{"shape": {"box": {"low": [-0.5, -0.5], "high": [0.5, 0]}}}],
  "bodies": [
    {"name": "bar", "shape": {"box": {"low": [-0.3, -0.04], "high": [0.3, 0.04]}},
     "motion": {"prescribed": {"velocity": [0.5, 0], "rotation": {"rate": "2"}}}},
    {"name": "floor", "shape": {"half_space": {"point": [0, -0.43], "normal": [0.1, 1]}}}],
  "time": {"end": 0.1, "step": 5e-3}, "output": {"every": 0.05}})";

struct MixerRun {
  Folder folder;
  MixerRun() {
    std::ofstream(folder / "mixer.json") << mixer_on_a_floor;
    REQUIRE(output_of_program(folder / "", {"run", "mixer.json", "--out", "out", "--threads", "1", "--quiet"}).code ==
            0);
  }
};

}  // namespace

TEST_CASE("frames have the place of every body, and the points of those that move", "[scene]") {
  const MixerRun run;
  const Hdf5File file(run.folder / "out/fields.h5", Hdf5File::Access::read);
  const auto outline = numbers_of(file, "/bodies/outlines/bar/points");
  REQUIRE(outline.size() == 8);
  for (int frame = 0; frame < 3; ++frame) {
    CAPTURE(frame);
    const std::string group = "/bodies/" + std::to_string(frame) + "/bar";
    const double time = 0.05 * frame;
    const auto position = numbers_of(file, group + "/position");
    CHECK(position[0] == Approx(0.5 * time).margin(1e-12));
    CHECK(position[1] == Approx(0).margin(1e-12));
    CHECK(numbers_of(file, group + "/angle")[0] == Approx(2 * time).margin(1e-12));
    CHECK(numbers_of(file, group + "/velocity") == std::vector<double>{0.5, 0});
    CHECK(numbers_of(file, group + "/spin") == std::vector<double>{2});
    const auto rotation = numbers_of(file, group + "/rotation");
    CHECK(rotation[0] == Approx(std::cos(2 * time)));
    CHECK(rotation[1] == Approx(-std::sin(2 * time)).margin(1e-12));
    const auto points = numbers_of(file, group + "/points");
    REQUIRE(points.size() == outline.size());
    for (std::size_t k = 0; k < points.size(); k += 2) {
      for (std::size_t d = 0; d < 2; ++d) {
        const double turned = rotation[2 * d] * outline[k] + rotation[2 * d + 1] * outline[k + 1];
        CHECK(points[k + d] == Approx(position[d] + turned).margin(1e-14));
      }
    }
  }
  CHECK_FALSE(file.has("/bodies/1/floor/points"));
  CHECK(file.has("/bodies/1/floor/position"));
  // The floor ends at the sides of the grid.
  const auto floor = numbers_of(file, "/bodies/outlines/floor/points");
  CHECK(floor.size() == 8);
  for (const double x : floor) CHECK(std::abs(x) < 0.5 + 1e-9);
}

TEST_CASE("fields.xdmf has a grid per body in every frame, resting ones with the points of the start", "[scene]") {
  const MixerRun run;
  const std::string xdmf = text_of(run.folder / "out/fields.xdmf");
  const auto count = [&](const std::string& text) {
    std::size_t found = 0;
    for (auto at = xdmf.find(text); at != std::string::npos; at = xdmf.find(text, at + 1)) ++found;
    return found;
  };
  CHECK(count("CollectionType=\"Spatial\"") == 3);
  CHECK(count("<Grid Name=\"bar\"") == 3);
  CHECK(count("<Grid Name=\"floor\"") == 3);
  CHECK(count("fields.h5:/bodies/2/bar/points") == 1);
  CHECK(count("fields.h5:/bodies/outlines/floor/points") == 3);
  CHECK(count("<Grid") == count("</Grid>"));
}
