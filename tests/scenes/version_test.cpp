/// \file
/// What the program tells of its own build.

#include "support/folder.hpp"
#include "support/program.hpp"

#include "minamo_version.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace minamo;

namespace {

using Json = nlohmann::ordered_json;

Json build_of_a_run() {
  const Folder folder;
  const ProgramEnd end = run_program({"run", std::string(MINAMO_SOURCE_DIR) + "/scenes/dam_break.json", "--out",
                                      folder / "out", "--steps", "0", "--quiet"});
  REQUIRE(end.code == 0);
  const Json summary = Json::parse(text_of(folder / "out/summary.json"));
  CHECK(summary["version"] == version);
  return summary["build"];
}

}  // namespace

TEST_CASE("what --version prints begins with the version", "[scene]") {
  const ProgramEnd end = run_program({"--version"});
  CHECK(end.code == 0);
  CHECK_THAT(end.output, Catch::StartsWith("minamo " + std::string(version) + "\n"));
}

TEST_CASE("summary.json and --version tell the same of the build", "[scene]") {
  const Json build = build_of_a_run();
  const std::string text = run_program({"--version"}).output;
  for (const auto& [name, fact] : build["packages"].items()) CHECK_THAT(text, Catch::Contains(fact.get<std::string>()));
  for (const std::string name : {"compiler", "type", "flags"}) {
    CAPTURE(name);
    REQUIRE(build.contains(name));
    CHECK_THAT(text, Catch::Contains(build[name].get<std::string>()));
  }
}

TEST_CASE("the packages that a run may depend on are told with a version", "[scene]") {
  const Json packages = build_of_a_run()["packages"];
  const std::string package = GENERATE("oneTBB", "Eigen", "SuiteSparse", "HDF5");
  CAPTURE(package);
  REQUIRE(packages.contains(package));
  CHECK_THAT(packages[package].get<std::string>(), Catch::Matches("[0-9]+\\.[0-9]+.*"));
}

TEST_CASE("the compiler told is the one that compiled", "[scene]") {
  CHECK_THAT(build_of_a_run()["compiler"].get<std::string>(), Catch::EndsWith(__VERSION__) || Catch::Contains("Clang"));
}
