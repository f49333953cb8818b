/// \file
/// Broken study files, and what the program says about them.

#include "support/program_output.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

using Case = std::tuple<std::string, std::string>;

/// A folder with a scene and a study.
class StudyFolder : public Folder {
 public:
  explicit StudyFolder(const std::string& study) {
    fs::copy_file(fs::path(MINAMO_SOURCE_DIR) / "scenes/taylor_green.json", *this / "scene.json");
    std::ofstream(*this / "a.json") << study;
  }
};

/// A study is refused with a text, and nothing is written.
void check_refused(const std::string& study, const std::string& text) {
  CAPTURE(study);
  const StudyFolder folder(study);
  const ProgramOutput run = output_of_program(folder / "", {"study", "a.json"});
  CHECK(run.err == text);
  CHECK(run.code == 2);
  CHECK(run.out.empty());
  CHECK_FALSE(fs::exists(folder / "out"));
}

}  // namespace

TEST_CASE("a study file with keys missing or misspelt is refused with every problem told", "[error]") {
  const auto [study, text] = GENERATE(values<Case>({
      {R"({})", "a.json: /scene: missing key\n"
                "  expected  a string\n"
                "a.json: /vary: missing key\n"
                "  expected  an object\n"
                "a.json: /error: missing key\n"
                "  expected  one of [\"overlap\", \"pressure\", \"velocity\"]\n"},
      {R"({"scene": "scene.json", "vary": {}, "error": "velocty"})",
       "a.json: /vary: nothing is varied\n"
       "  expected  at least one list of values\n"
       "a.json: /error: unknown name\n"
       "  expected  one of [\"overlap\", \"pressure\", \"velocity\"]\n"
       "  got       \"velocty\" (string)\n"
       "  closest   \"velocity\"\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8]}, "eror": "velocity"})", "a.json: /eror: unknown key\n"
                                                                                 "  got       \"velocity\" (string)\n"
                                                                                 "  closest   \"error\"\n"},
  }));
  check_refused(study, text);
}

TEST_CASE("a study that varies or sets what it cannot is refused", "[error]") {
  const auto [study, text] = GENERATE(values<Case>({
      {R"({"scene": "scene.json", "vary": {"cells": 8, "/transfer/scheme": []}, "error": "velocity"})",
       "a.json: /vary/cells: wrong type\n"
       "  expected  a list of at least one value\n"
       "  got       8 (number)\n"
       "a.json: /vary/~1transfer~1scheme: empty list\n"
       "  expected  a list of at least one value\n"
       "  got       [] (list)\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8, 8.5, 8, [2, 3]]}, "error": "velocity"})",
       "a.json: /vary/cells/1: wrong value\n"
       "  expected  a whole number >= 3, the cells along x, or a list of them per direction\n"
       "  got       8.5 (number)\n"
       "a.json: /vary/cells/2: given twice\n"
       "  expected  a list of different values\n"
       "  got       8 (number)\n"
       "a.json: /vary/cells/3: wrong value\n"
       "  expected  a whole number >= 3, the cells along x, or a list of them per direction\n"
       "  got       [2,3] (list)\n"},
      {R"({"scene": "scene.json", "vary": {"cels": [8]}, "error": "velocity"})",
       "a.json: /vary/cels: used nowhere\n"
       "  expected  a JSON pointer like /transfer/scheme, \"cells\", or a name that time_step uses\n"
       "  got       \"cels\" (string)\n"
       "  closest   \"cells\"\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8]}, "set": {"transfer": 1}, "error": "velocity"})",
       "a.json: /set/transfer: not a JSON pointer\n"
       "  expected  /key/key, like /transfer/scheme\n"
       "  got       \"transfer\" (string)\n"},
  }));
  check_refused(study, text);
}

TEST_CASE("a study whose time step or error makes no sense is refused", "[error]") {
  const auto [study, text] = GENERATE(values<Case>({
      {R"({"scene": "scene.json", "vary": {"cells": [8]}, "time_step": "0.1/cell", "error": "velocity"})",
       "a.json: /time_step: not an expression: unknown name \"cell\" at character 5\n"
       "  expected  a number > 0 or an expression in cells [s]\n"
       "  got       \"0.1/cell\" (string)\n"
       "  closest   \"cells\"\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": {"history": "overlap", "target": 0, "from": 3, "to": 2}})",
       "a.json: /error/target: out of range\n"
       "  expected  a number other than 0\n"
       "  got       0 (number)\n"
       "a.json: /error/to: no time in between\n"
       "  expected  a time after from = 3 s\n"
       "  got       2 (number)\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": {"farthst": 3}})",
       "a.json: /error/farthst: unknown key\n"
       "  got       3 (number)\n"
       "  closest   \"farthest\"\n"},
  }));
  check_refused(study, text);
}

TEST_CASE("a study whose variants cannot all run is refused, and no problem is told twice", "[error]") {
  const auto [study, text] = GENERATE(values<Case>({
      {R"({"scene": "scent.json", "vary": {"cells": [8]}, "error": "velocity"})",
       "a.json: /scene: no such file\n"
       "  expected  a scene file, from the folder of the study\n"
       "  got       \"scent.json\" (string)\n"
       "  closest   \"scene.json\"\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8, 16], "/transfer/scheme": ["pic", "apci"]}, "error": "velocity"})",
       "scene.json: variant cells8_apci: /transfer/scheme: unknown name\n"
       "  expected  one of [\"apic\", \"flip\", \"fmpm\", \"pic\", \"tpic\", \"tpic2\", \"xpic\"]\n"
       "  got       \"apci\" (string)\n"
       "  closest   \"apic\"\n"},
      {R"({"scene": "scene.json", "vary": {"/particles/3/per_cell": [2, 3]}, "error": "velocity"})",
       "scene.json: variant per_cell2: /particles/3: no such element\n"
       "  expected  an index in [0, 0]\n"
       "  got       \"3\" (string)\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8, 16], "/transfer/scheme": ["pic", "tpic"]},
           "time_step": "12 - cells", "error": "velocity"})",
       "a.json: /time_step: not a time step\n"
       "  expected  a number > 0 [s]\n"
       "  got       -4 s with cells = 16\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8, 16]}, "set": {"/exact": {"velocity": [0, 0]}}, "error": "pressure"})",
       "a.json: /error: the scene has no exact pressure\n"
       "  expected  a scene with /exact/pressure\n"
       "  got       \"pressure\" (string)\n"},
      {R"({"scene": "scene.json", "vary": {"cells": [8, 16]},
           "error": {"history": "kinetic_enrgy", "target": 1, "to": 2}})",
       "a.json: /error/history: not an expression: unknown name \"kinetic_enrgy\" at character 1\n"
       "  expected  an expression in columns of history.csv\n"
       "  got       \"kinetic_enrgy\" (string)\n"
       "  closest   \"kinetic_energy\"\n"
       "a.json: /error/to: after the end of the run\n"
       "  expected  a time up to 0.25 s\n"
       "  got       2 s\n"},
  }));
  check_refused(study, text);
}

TEST_CASE("a study without the table of others that it names is refused", "[error]") {
  const StudyFolder folder(
      R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": "velocity", "others": "none.csv"})");
  const ProgramOutput run = output_of_program(folder / "", {"study", "a.json"});
  CHECK(run.err == "a.json: /others: no such file\n"
                   "  expected  a table of points of others, from the folder of the study\n"
                   "  got       \"" +
                       (folder / "none.csv") + "\" (string)\n");
  CHECK(run.code == 2);
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("a study with an unknown key is told all that it may have", "[error]") {
  check_refused(
      R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": "velocity", "colour": 1})",
      "a.json: /colour: unknown key\n"
      "  expected  one of [\"title\", \"scene\", \"vary\", \"set\", \"time_step\", \"end\", \"error\", \"cost\", "
      "\"repeat\", \"others\"]\n"
      "  got       1 (number)\n");
}

TEST_CASE("a study of a file that is no scene is refused", "[error]") {
  const StudyFolder folder(R"({"scene": "list.json", "vary": {"cells": [8]}, "error": "velocity"})");
  std::ofstream(folder / "list.json") << "[1, 2]";
  const ProgramOutput run = output_of_program(folder / "", {"study", "a.json"});
  CHECK(run.err == "list.json: variant cells8: wrong type\n"
                   "  expected  an object\n"
                   "  got       [1,2] (list)\n");
  CHECK(run.code == 2);
}

TEST_CASE("a scene in the place of a study is one problem, as is a study in the place of a scene", "[error]") {
  const StudyFolder folder(R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": "velocity"})");
  const ProgramOutput study = output_of_program(folder / "", {"study", "scene.json"});
  CHECK(study.code == 2);
  CHECK(study.err == "scene.json: is a scene, not a study\n  expected  a study; scenes are run by `minamo run`\n");
  const std::string command = GENERATE("run", "check");
  CAPTURE(command);
  const ProgramOutput scene = output_of_program(folder / "", {command, "a.json"});
  CHECK(scene.code == 2);
  CHECK(scene.err == "a.json: is a study, not a scene\n  expected  a scene; studies are run by `minamo study`\n");
  CHECK_FALSE(fs::exists(folder / "out"));
}

TEST_CASE("a program that measures the error must be there, and may be executed", "[error]") {
  const StudyFolder folder(R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": {"program": "measure.py"}})");
  const ProgramOutput run = output_of_program(folder / "", {"study", "a.json"});
  CHECK(run.err == "a.json: /error/program: cannot be run\n"
                   "  expected  a program or a script that may be executed\n"
                   "  got       \"" +
                       (folder / "measure.py") + "\" (string)\n");
  CHECK(run.code == 2);
}

TEST_CASE("a table of others that lacks columns or numbers is refused before the first run", "[error]") {
  const auto [others, text] = GENERATE(values<Case>({
      {"code,setting,costs,error\n", ": no column \"cost\"\n"
                                     "  expected  a table with the columns code, setting, cost and error\n"
                                     "  got       code,setting,costs,error\n"
                                     "  closest   \"costs\"\n"},
      {"code,setting,cost,error\nAbc,40 x 40,fast,-1\n", ": line 2: not a number\n"
                                                         "  expected  a number > 0\n"
                                                         "  got       \"fast\"\n" +
                                                             std::string("OTHERS: line 2: not a number\n"
                                                                         "  expected  a number > 0\n"
                                                                         "  got       \"-1\"\n")},
  }));
  const StudyFolder folder(
      R"({"scene": "scene.json", "vary": {"cells": [8]}, "error": "velocity", "others": "others.csv"})");
  std::ofstream(folder / "others.csv") << others;
  const ProgramOutput run = output_of_program(folder / "", {"study", "a.json"});
  std::string expected = "OTHERS" + text;
  for (auto at = expected.find("OTHERS"); at != std::string::npos; at = expected.find("OTHERS"))
    expected.replace(at, 6, folder / "others.csv");
  CHECK(run.err == expected);
  CHECK(run.code == 2);
  CHECK_FALSE(fs::exists(folder / "out"));
}
