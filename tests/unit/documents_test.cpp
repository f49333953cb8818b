/// \file
/// What the README files say of the program is what the program says of itself. `tools/catalogue` writes it anew.

#include "engine/input_text.hpp"
#include "support/program_output.hpp"
#include "systems/pipeline.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <regex>
#include <set>

using namespace minamo;

namespace {

const std::string source = MINAMO_SOURCE_DIR;

/// The text between a line and the next `<!-- end -->`.
std::string block(const std::string& text, const std::string& begin) {
  const auto from = text.find(begin + "\n");
  if (from == std::string::npos) return "no line " + begin;
  const auto first = from + begin.size() + 1;
  return text.substr(first, text.find("<!-- end -->", first) - first);
}

/// The code blocks of a Markdown text in one of the languages.
std::vector<std::string> code_blocks(const std::string& text, const std::set<std::string>& languages) {
  std::istringstream lines(text);
  std::vector<std::string> blocks;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_fence = line.starts_with("```");
    if (is_fence && !inside && languages.contains(line.substr(3))) {
      blocks.emplace_back();
      inside = true;
    } else if (is_fence) {
      inside = false;
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

/// What stands in the first column of a Markdown table, without backticks.
std::vector<std::string> first_column(const std::string& table) {
  std::istringstream lines(table);
  std::vector<std::string> column;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("| `")) column.push_back(line.substr(3, line.find('`', 3) - 3));
  }
  return column;
}

}  // namespace

TEST_CASE("tables in the README files are those that the program prints", "[unit]") {
  const auto [file, arguments] = GENERATE(table<std::string, std::vector<std::string>>({
      {"scenes/README.md", {"schema", "--table"}},
      {"systems/README.md", {"list", "systems"}},
      {"systems/README.md", {"list", "components"}},
  }));
  std::string command = "<!-- minamo";
  for (const std::string& argument : arguments) command += " " + argument;
  command += " -->";
  CAPTURE(file, command);
  CHECK(block(text_of(source + "/" + file), command) == output_of_program("/", arguments).out);
}

TEST_CASE("the schema that the scenes name is the one that the program prints", "[unit]") {
  CHECK(text_of(source + "/scenes/schema/scene.schema.json") == output_of_program("/", {"schema"}).out);
}

TEST_CASE("every scene names the schema, which is there", "[unit]") {
  const std::string folder = GENERATE("/scenes", "/scenes/paper", "/tools/example_system");
  for (const auto& entry : std::filesystem::directory_iterator(source + folder)) {
    if (entry.path().extension() != ".json") continue;
    CAPTURE(entry.path().string());
    const std::filesystem::path schema = read_json(entry.path().string()).value("$schema", "missing");
    CHECK(std::filesystem::exists(entry.path().parent_path() / schema));
  }
}

TEST_CASE("systems/README.md has the slots of a step in order", "[unit]") {
  CHECK(first_column(block(text_of(source + "/systems/README.md"), "<!-- slots -->")) == slot_names());
}

TEST_CASE("the code in systems/README.md is that of the examples, which are built and run", "[unit]") {
  std::string examples;
  for (const std::string folder : {"/tools/example_system/", "/tools/example_scheme/"}) {
    for (const std::string file : {"main.cpp", "scene.json", "CMakeLists.txt"}) {
      examples += text_of(source + folder + file);
    }
  }
  const auto blocks = code_blocks(text_of(source + "/systems/README.md"), {"cpp", "json", "cmake"});
  CHECK(blocks.size() >= 10);
  for (const std::string& code : blocks) CHECK_THAT(examples, Catch::Contains(code));
}

TEST_CASE("the scene to begin with in scenes/README.md is valid, has as many particles as it says, and runs",
          "[unit]") {
  const std::string text = text_of(source + "/scenes/README.md");
  const Folder folder;
  std::ofstream(folder / "pool.json") << code_blocks(text, {"json"}).at(0);
  const ProgramOutput check = output_of_program(folder / "", {"check", "pool.json"});
  CHECK(check.err.empty());
  CHECK_THAT(text, Catch::Contains("`" + check.out.substr(0, check.out.find('\n')) + "`"));
  CHECK(output_of_program(folder / "", {"run", "pool.json", "--steps", "3", "--quiet"}).code == 0);
}

TEST_CASE("scenes/README.md names every column and every key that a run writes", "[unit]") {
  const std::string text = text_of(source + "/scenes/README.md");
  const Folder folder;
  REQUIRE(output_of_program(folder / "",
                            {"run", source + "/scenes/poiseuille.json", "--steps", "0", "--quiet", "--out", "out"})
              .code == 0);
  std::istringstream history(text_of(folder / "out/history.csv"));
  std::string header;
  std::getline(history, header);
  std::istringstream columns(header);
  for (std::string name; std::getline(columns, name, ',');) CHECK_THAT(text, Catch::Contains("`" + name + "`"));
  const Json summary = read_json(folder / "out/summary.json");
  for (const Json& object : {summary, summary["build"], summary["conservation"], summary["systems"][0]}) {
    for (const auto& [key, value] : object.items()) CHECK_THAT(text, Catch::Contains("`" + key + "`"));
  }
}

TEST_CASE("scenes/README.md names every function of expressions", "[unit]") {
  const std::string text = text_of(source + "/scenes/README.md");
  std::set<std::string> words;
  const std::regex word("[a-z0-9]+");
  for (std::sregex_iterator at(text.begin(), text.end(), word), end; at != end; ++at) words.insert(at->str());
  for (const std::string& name : known_names({})) {
    CAPTURE(name);
    CHECK(words.contains(name));
  }
}

TEST_CASE("the README of a folder of scenes lists every scene in it", "[unit]") {
  const std::string folder = GENERATE("/scenes", "/scenes/paper");
  const std::string text = text_of(source + folder + "/README.md");
  for (const auto& entry : std::filesystem::directory_iterator(source + folder)) {
    const auto& path = entry.path();
    if (path.extension() != ".json") continue;
    const std::string link = "[" + path.stem().string() + "](" + path.filename().string() + ")";
    CHECK_THAT(text, Catch::Contains(link));
  }
}
