/// \file
/// Every NAME.json next to this file is broken in one way; NAME.txt is what the program says about it, NAME.args, where
/// there is one, holds further arguments, one a line, NAME.obj is a mesh of the scene.

#include "support/build.hpp"
#include "support/program_output.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

const fs::path broken_scenes = fs::path(MINAMO_SOURCE_DIR) / "tests" / "error";

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(broken_scenes)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.insert(entry.path().filename().string());
  return files;
}

const std::string scene = R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [8, 8]},
  "fluid": {"density": 1000, "viscosity": 0}, "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.5, 0.5]}}}],
  "time": {"end": 0.02, "step": 0.01}})";

/// A folder with a valid scene, `scene.json`.
class SceneFolder : public Folder {
 public:
  SceneFolder() { std::ofstream(*this / "scene.json") << scene; }
};

/// The scene and its mesh, if there is one. \return the names of the files
std::set<std::string> copy_scene(const std::string& name, const fs::path& folder) {
  std::set<std::string> files;
  for (const char* kind : {".json", ".obj"}) {
    if (!fs::exists(broken_scenes / (name + kind))) continue;
    fs::copy_file(broken_scenes / (name + kind), folder / (name + kind));
    files.insert(name + kind);
  }
  return files;
}

}  // namespace

TEST_CASE("a broken scene is refused with every problem told", "[error]") {
  // In one start, which takes longer than to read a scene.
  const Folder folder;
  std::vector<std::string> arguments{"check"};
  std::set<std::string> files;
  for (const std::string& name : names()) {
    if (fs::exists(broken_scenes / (name + ".args"))) continue;
    const auto copied = copy_scene(name, folder / "");
    files.insert(copied.begin(), copied.end());
    arguments.push_back(name + ".json");
  }
  const ProgramOutput check = output_of_program(folder / "", arguments);
  std::size_t at = 0;
  for (std::size_t k = 1; k < arguments.size(); ++k) {
    const std::string text = text_of(broken_scenes / fs::path(arguments[k]).replace_extension(".txt"));
    CAPTURE(arguments[k]);
    REQUIRE(check.err.substr(std::min(at, check.err.size()), text.size()) == text);
    at += text.size();
  }
  CHECK(at == check.err.size());
  CHECK(check.code == 2);
  CHECK(check.out.empty());
  CHECK(files_in(folder / "") == files);
}

TEST_CASE("of a broken scene nothing is run", "[error]") {
  // All of them; under the sanitizers, where a start takes ten times as long, those with arguments and a sample.
  const std::size_t stride = is_address_sanitized() ? 8 : 1;
  std::vector<std::string> tried;
  const std::vector<std::string> all = names();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k % stride == 0 || fs::exists(broken_scenes / (all[k] + ".args"))) tried.push_back(all[k]);
  }
  const std::string name = GENERATE_COPY(from_range(tried));
  CAPTURE(name);
  const Folder folder;
  const std::set<std::string> files = copy_scene(name, folder / "");
  std::vector<std::string> arguments{"run", name + ".json"};
  for (std::string& argument : lines_of(broken_scenes / (name + ".args"))) arguments.push_back(std::move(argument));

  const ProgramOutput run = output_of_program(folder / "", arguments);
  CHECK(run.err == text_of(broken_scenes / (name + ".txt")));
  CHECK(run.code == 2);
  CHECK(run.out.empty());
  CHECK(files_in(folder / "") == files);
}

TEST_CASE("every broken scene has a text, and every text a scene", "[error]") {
  std::set<std::string> scenes;
  std::set<std::string> texts;
  for (const auto& entry : fs::directory_iterator(broken_scenes)) {
    const fs::path& path = entry.path();
    if (path.extension() == ".json") scenes.insert(path.stem().string());
    if (path.extension() == ".txt") texts.insert(path.stem().string());
    if (path.extension() == ".args") CHECK(fs::exists(broken_scenes / (path.stem().string() + ".json")));
  }
  CHECK(scenes == texts);
}

TEST_CASE("a command line that cannot be is refused", "[error]") {
  using Case = std::tuple<std::vector<std::string>, std::string>;
  const auto [arguments, err] = GENERATE(values<Case>({
      {std::vector<std::string>{}, "minamo: no command\n  expected  one of "},
      {{"rum"}, "minamo: unknown command\n  expected  one of "},
      {{"run"}, "SCENE is required\n  options are shown by --help\n"},
      {{"run", "scene.json", "--threads", "0"},
       "--threads: expected a whole number >= 1, got \"0\"\n  options are shown by --help\n"},
      {{"run", "scene.json", "--threads", "two"},
       "--threads: expected a whole number >= 1, got \"two\"\n  options are shown by --help\n"},
      {{"run", "scene.json", "--steps", "-1"},
       "--steps: expected a whole number >= 0, got \"-1\"\n  options are shown by --help\n"},
      {{"run", "scene.json", "again.json"},
       "the following argument was not expected: again.json\n  options are shown by --help\n"},
      {{"run", "scene.json", "--thread", "1"},
       "minamo run: unknown option\n  expected  one of [\"--help\", \"--out\", \"--threads\", \"--set\", \"--steps\", "
       "\"--resume\", \"--overwrite\", \"--profile\", \"--quiet\"]\n  got       \"--thread\" (string)\n  closest   "
       "\"--threads\"\n"},
      {{"study", "--qiet"},
       "minamo study: unknown option\n  expected  one of [\"--help\", \"--out\", \"--threads\", \"--quiet\"]\n"
       "  got       \"--qiet\" (string)\n  closest   \"--quiet\"\n"},
      {{"run", "scene.json", "--set", "/time/end=1", "/time/step=1"},
       "the following argument was not expected: /time/step=1\n  options are shown by --help\n"},
      {{"run", "--profile", "scene.json", "other.json"},
       "--profile: \"scene.json\" is there and is no trace; write --profile=FILE, or SCENE before --profile\n"},
      {{"run", "scene.json", "--profile=scene.json"}, "--profile: \"scene.json\" is there and is no trace; "},
      {{"run", "--profile", "trace.json", "--steps", "1"},
       "minamo run: SCENE is required: --profile has taken the word after it for its FILE\n"
       "  expected  write --profile=FILE, or SCENE before --profile\n  got       \"trace.json\" (string)\n"},
      {{"run", "scent.json"}, "scent.json: no such file\n  closest   \"scene.json\"\n"},
      {{"run", "unlike"}, "unlike: no such file\n"},
      {{"run", "."}, ".: is a folder\n  expected  a JSON file\n"},
      {{"graph", "sub/scene.json"}, "sub/scene.json: no such file\n"},
      {{"check", "scent.json"}, "scent.json: no such file\n  closest   \"scene.json\"\n"},
  }));
  CAPTURE(arguments);
  const SceneFolder folder;
  const ProgramOutput run = output_of_program(folder / "", arguments);
  CHECK_THAT(run.err, Catch::StartsWith(err));
  CHECK(run.code == 2);
  CHECK(run.out.empty());
  CHECK(files_in(folder / "") == std::set<std::string>{"scene.json"});
}

TEST_CASE("an output folder that cannot be made or used is refused before anything is run", "[error]") {
  const auto [out, err] = GENERATE(table<std::string, std::string>({
      {"scene.json", "scene.json: is a file\n"},
      {"scene.json/out", "scene.json/out: cannot be made: Not a directory\n"},
      {"/proc/out", "/proc/out: cannot be made: No such file or directory\n"},
      {"full", "full: history.csv cannot be removed: Directory not empty\n"},
  }));
  CAPTURE(out);
  const SceneFolder folder;
  fs::create_directories(folder / "full/history.csv/something");
  const ProgramOutput run = output_of_program(folder / "", {"run", "scene.json", "--out", out});
  CHECK(run.err == err + "  expected  a folder for the results (--out)\n");
  CHECK(run.code == 2);
  CHECK(run.out.empty());
}

TEST_CASE("a valid scene of another folder leaves its output in this one", "[error]") {
  const SceneFolder folder;
  fs::create_directory(folder / "here");
  const ProgramOutput run = output_of_program(folder / "here", {"run", "../scene.json", "--quiet"});
  CHECK(run.err.empty());
  CHECK(run.code == 0);
  CHECK(files_in(folder / "") == std::set<std::string>{"here", "scene.json"});
  CHECK(fs::exists(folder / "here/out/scene/history.csv"));
}

TEST_CASE("check tells the problems of every file and which files are valid", "[error]") {
  const SceneFolder folder;
  std::ofstream(folder / "thick.json") << std::string(scene).replace(scene.find("1000"), 4, "-1");
  std::ofstream(folder / "cut.json") << scene.substr(0, 16);
  const ProgramOutput run = output_of_program(folder / "", {"check", "thick.json", "scene.json", "cut.json"});
  CHECK(run.code == 2);
  CHECK_THAT(run.out, Catch::StartsWith("scene.json: valid, 144 particles\n  grid "));
  CHECK_THAT(run.out, !Catch::Contains("thick") && !Catch::Contains("cut"));
  CHECK(run.err == "thick.json: /fluid/density: out of range\n"
                   "  expected  a number > 0 [kg/m^3]\n"
                   "  got       -1 (number)\n"
                   "cut.json: line 1, column 17: unexpected end of input\n"
                   "  expected  string literal\n");
  CHECK(output_of_program(folder / "", {"check", "scene.json"}).code == 0);
}
