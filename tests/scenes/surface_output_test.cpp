// The surface of every frame as a file.

#include "support/program.hpp"
#include "support/program_output.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace minamo;

namespace {

/// What a binary PLY file says.
struct Ply {
  std::size_t points = 0;
  std::size_t elements = 0;
  std::string data;
};

Ply ply_of(const std::string& path) {
  const std::string text = text_of(path);
  const std::string end = "end_header\n";
  const std::size_t header = text.find(end);
  REQUIRE(text.starts_with("ply\nformat binary_little_endian 1.0\n"));
  REQUIRE(header != std::string::npos);
  const auto count_of = [&](const std::string& element) {
    const std::size_t at = text.find("element " + element + " ");
    return at < header ? std::stoul(text.substr(at + element.size() + 9)) : 0;
  };
  return {count_of("vertex"), count_of("edge") + count_of("face"), text.substr(header + end.size())};
}

std::vector<std::string> run(const std::string& scene, const std::string& format, const std::string& end) {
  return {"run",
          scene_path(scene + ".json"),
          "--quiet",
          "--out",
          "out",
          "--set",
          "/output/surface=\"" + format + "\"",
          "--set",
          "/time/end=" + end,
          "--set",
          "/output/every=0.02",
          "--set",
          "/output/checkpoint=0.02"};
}

std::vector<std::string> threaded(std::vector<std::string> arguments, const std::string& threads) {
  arguments.insert(arguments.end(), {"--threads", threads});
  return arguments;
}

}  // namespace

TEST_CASE("every frame has a file of its surface, whole in numbers", "[scene]") {
  const auto [scene, bytes_of_element] =
      GENERATE(table<std::string, std::size_t>({{"dam_break", 8}, {"dam_break_3d", 13}}));
  CAPTURE(scene);
  const Folder folder;
  REQUIRE(output_of_program(folder / "", threaded(run(scene, "ply", "0.04"), "1")).code == 0);
  for (const char* name : {"0000.ply", "0001.ply", "0002.ply"}) {
    const Ply ply = ply_of(folder / ("out/surface/" + std::string(name)));
    CHECK(ply.points > 10);
    CHECK(ply.data.size() == ply.points * 24 + ply.elements * bytes_of_element);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "out/surface/0003.ply"));
}

TEST_CASE("the index of surfaces has the times of the frames", "[scene]") {
  const Folder folder;
  REQUIRE(output_of_program(folder / "", threaded(run("dam_break", "vtp", "0.04"), "1")).code == 0);
  CHECK(text_of(folder / "out/surface.pvd").find("<DataSet timestep=\"0.04\" file=\"surface/0002.vtp\"/>") !=
        std::string::npos);
  CHECK(text_of(folder / "out/surface/0002.vtp").find("NumberOfPolys=\"0\"") != std::string::npos);
}

TEST_CASE("a run that goes on, and one on two threads, writes the same surfaces", "[scene]") {
  const Folder whole;
  const Folder in_two;
  REQUIRE(output_of_program(whole / "", threaded(run("dam_break_3d", "vtp", "0.06"), "2")).code == 0);
  REQUIRE(output_of_program(in_two / "", threaded(run("dam_break_3d", "vtp", "0.02"), "1")).code == 0);
  auto rest = threaded(run("dam_break_3d", "vtp", "0.06"), "1");
  rest.emplace_back("--resume");
  REQUIRE(output_of_program(in_two / "", rest).code == 0);
  for (const char* name : {"surface/0000.vtp", "surface/0001.vtp", "surface/0003.vtp", "surface.pvd"}) {
    CAPTURE(name);
    CHECK(text_of(in_two / ("out/" + std::string(name))) == text_of(whole / ("out/" + std::string(name))));
  }
}

TEST_CASE("a run says where its surface cannot be written", "[scene]") {
  const Folder folder;
  std::filesystem::create_directories(folder / "out/surface/0001.ply");  // a folder in the place of the file
  const ProgramOutput output = output_of_program(folder / "", threaded(run("dam_break", "ply", "0.04"), "1"));
  CHECK(output.code == 3);
  CHECK(output.err.find("surface/0001.ply") != std::string::npos);
}
