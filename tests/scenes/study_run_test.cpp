#include "support/folder.hpp"
#include "support/program.hpp"
#include "support/program_output.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

/// Two schemes, two resolutions; `further` adds keys.
std::string small_study(const std::string& vary = "", const std::string& further = "") {
  return R"({"title": "Small", "scene": ")" + std::string(MINAMO_SOURCE_DIR) + R"(/scenes/taylor_green.json",
    "vary": {"/transfer/scheme": ["pic", "tpic"], "cells": [6, 12])" +
         vary + R"(}, "time_step": "0.16/cells", "error": "velocity")" + further + "}";
}

/// A folder with a study and what a run of it left in out/.
class StudyRun : public Folder {
 public:
  explicit StudyRun(const std::string& study) {
    std::ofstream(*this / "small.json") << study;
    output = output_of_program(*this / "", {"study", "small.json", "--out", "out", "--threads", "1"});
  }
  /// Rows of fields, none of which has a comma of its own.
  std::vector<std::vector<std::string>> csv() const {
    std::istringstream text(text_of(*this / "out/study.csv"));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(text, line);) {
      std::istringstream in(line);
      rows.emplace_back();
      for (std::string field; std::getline(in, field, ',');) rows.back().push_back(field);
    }
    return rows;
  }
  ProgramOutput output;
};

/// The small study as it is, run once for all tests that look at what it leaves.
const StudyRun& plain_study() {
  static const StudyRun study(small_study());
  return study;
}

bool has_matplotlib() {
  return std::system(
             "python3 -c 'import matplotlib' 2> /dev/null || /usr/bin/python3 -c 'import matplotlib' 2> /dev/null") ==
         0;
}

}  // namespace

TEST_CASE("a study runs every combination as `minamo run` does", "[scene]") {
  const StudyRun& study = plain_study();
  CHECK(study.output.code == 0);
  for (const std::string variant : {"pic_cells6", "pic_cells12", "tpic_cells6", "tpic_cells12"}) {
    CAPTURE(variant);
    const std::string folder = study / ("out/" + variant);
    REQUIRE(fs::exists(folder + "/scene.json"));
    REQUIRE(output_of_program(study / "", {"run", folder + "/scene.json", "--out", variant, "--quiet"}).code == 0);
    CHECK(text_of(study / (variant + "/history.csv")) == text_of(folder + "/history.csv"));
  }
}

TEST_CASE("study.csv has the errors of the summaries, and finer is more accurate and slower", "[scene]") {
  const StudyRun& study = plain_study();
  const auto csv = study.csv();
  REQUIRE(csv.size() == 5);
  CHECK(csv[0][0] == "/transfer/scheme");
  CHECK(csv[2][0] == "pic");
  CHECK(csv[2][1] == "12");
  const auto summary = nlohmann::json::parse(text_of(study / "out/tpic_cells12/summary.json"));
  CHECK(std::stod(csv[4][2]) == summary["errors"]["velocity"].get<double>());
  CHECK(std::stod(csv[4][2]) < std::stod(csv[3][2]));
  CHECK(std::stod(csv[4][3]) > 0.5);  // the order
  CHECK(csv[3][3].empty());
}

TEST_CASE("the table of a study has a line per variant", "[scene]") {
  const StudyRun& study = plain_study();
  CHECK_THAT(study.output.out, Catch::StartsWith("Small\ntransfer  cells  error [1]  order  wall [s]  steps"));
  CHECK(std::count(study.output.out.begin(), study.output.out.end(), '\n') == 8);
}

TEST_CASE("repeated runs leave the errors, and points of others stand next to them", "[scene]") {
  const Folder folder;
  std::ofstream(folder / "others.csv") << "code,setting,cost,error\nAbc,coarse,1000,0.9\n";
  std::ofstream(folder / "small.json") << small_study("", R"(, "cost": "cpu", "repeat": 2, "others": "others.csv")");
  const ProgramOutput run = output_of_program(folder / "", {"study", "small.json", "--out", "out", "--threads", "1"});
  CHECK(run.code == 0);
  CHECK_THAT(run.err, Catch::Contains("run 2 of 2 of every variant"));
  CHECK_THAT(run.out, Catch::Contains("cpu [s/s]") && Catch::Contains("At equal error"));
  CHECK_THAT(text_of(folder / "out/others.csv"),
             Catch::StartsWith("code,setting,transfer,cells,their error,our error,their cost,our cost,ratio\n"
                               "Abc,coarse,"));
  const StudyRun& once = plain_study();
  std::istringstream again(text_of(folder / "out/study.csv"));
  const auto csv = once.csv();
  for (std::size_t k = 0; k < csv.size(); ++k) {
    std::string line;
    std::getline(again, line);
    CHECK_THAT(line, Catch::StartsWith(csv[k][0] + ',' + csv[k][1] + ',' + csv[k][2] + ','));
  }
}

TEST_CASE("a study draws its picture", "[scene]") {
  if (!has_matplotlib()) {
    WARN("not tested: python3 has no matplotlib (python3-matplotlib)");
    return;
  }
  const StudyRun& study = plain_study();
  const std::string picture = text_of(study / "out/study.png");
  CHECK_THAT(picture, Catch::StartsWith("\x89PNG"));
  CHECK(picture.size() > 10000);
  CHECK_THAT(study.output.err, Catch::EndsWith("results in out: study.csv, study.png\n"));
}

TEST_CASE("without matplotlib a study says what to install and leaves the rest", "[scene]") {
  const Folder folder;
  std::ofstream(folder / "small.json") << small_study();
  fs::create_directory(folder / "matplotlib");
  std::ofstream(folder / "matplotlib/__init__.py") << "raise ImportError\n";
  setenv("PYTHONPATH", (folder / "").c_str(), 1);
  const ProgramOutput run = output_of_program(folder / "", {"study", "small.json", "--out", "out", "--quiet"});
  unsetenv("PYTHONPATH");
  CHECK(run.code == 0);
  CHECK(run.err ==
        "out/study.png is not drawn: it needs python3 and matplotlib: sudo apt-get install python3-matplotlib\n");
  CHECK(fs::exists(folder / "out/study.csv"));
  CHECK_FALSE(fs::exists(folder / "out/study.png"));
}

TEST_CASE("a variant that fails is a row, and the study goes on", "[scene]") {
  // The force leaves the range of numbers after half the time.
  const StudyRun study(small_study(R"json(, "/body_force": [[0, "1/(t < 0.1)"], [0, 0]])json"));
  CHECK(study.output.code == 0);
  std::istringstream csv(text_of(study / "out/study.csv"));
  std::string line;
  std::getline(csv, line);
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    REQUIRE(std::getline(csv, line));
    CHECK_THAT(line, Catch::Contains(i % 2 == 0 ? ",failed," : ",done,"));
  }
  CHECK_THAT(study.output.err, Catch::Contains("pic_cells6_body_force_0_1_t_0.1"));
}

TEST_CASE("an interrupted study stops after the step and keeps what is done", "[scene]") {
  const Folder folder;
  // The third variant would take hours.
  std::ofstream(folder / "long.json") << R"({"scene": ")" << MINAMO_SOURCE_DIR << R"(/scenes/taylor_green.json",
    "vary": {"/time/end": [0.01, 1000], "/transfer/scheme": ["pic", "tpic"]}, "error": "velocity"})";
  Program program({"study", folder / "long.json", "--out", folder / "out"});
  wait_for_file(folder / "out/end1000_pic/history.csv", 1000);
  program.send(SIGINT);
  const ProgramEnd end = program.wait();
  CHECK(end.code == 130);
  CHECK_THAT(end.output, Catch::Contains("interrupted after 2 of 4 variants"));
  const std::string csv = text_of(folder / "out/study.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK_THAT(csv, Catch::Contains(",interrupted,"));
  CHECK(fs::exists(folder / "out/study.png") == has_matplotlib());
}
