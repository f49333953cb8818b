/// \file
/// What the documents say of the program is what the program says of itself, where they point there is something, and
/// figures that stand twice are the same. `tools/catalogue` writes anew what the program prints.

#include "engine/input/input_text.hpp"
#include "support/program_output.hpp"
#include "systems/step/pipeline.hpp"
#include "systems/step/step_table.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
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

/// All documents, by path from the source.
std::vector<std::string> documents() {
  namespace fs = std::filesystem;
  std::vector<std::string> paths;
  for (fs::recursive_directory_iterator at(source), end; at != end; ++at) {
    const std::string name = at->path().filename();
    const bool is_hidden = name.starts_with(".") && name != ".github";
    if (at->is_directory() && (is_hidden || name == "build" || name == "out")) at.disable_recursion_pending();
    if (at->path().extension() == ".md") paths.push_back(fs::relative(at->path(), source));
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

const std::vector<std::string> slot_names = [] {
  std::vector<std::string> names;
  for (const Slot& slot : slots()) names.emplace_back(slot.name);
  return names;
}();

/// A Markdown text without its code: blocks, fenced or indented, and what stands in backticks.
std::string without_code(const std::string& text) {
  std::istringstream lines(text);
  std::string rest;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_fence = line.starts_with("```");
    if (is_fence) inside = !inside;
    if (!inside && !is_fence && !line.starts_with("    ")) rest += line + "\n";
  }
  return std::regex_replace(rest, std::regex("`[^`]*`"), "");
}

const std::regex link_target(R"(\]\(([^)\s]+)\))");

/// A group of every match of the pattern.
std::vector<std::string> matches(const std::string& text, const std::regex& pattern, std::size_t group = 0) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) found.push_back((*at)[group]);
  return found;
}

/// The anchors of the headings, as GitHub makes them: small letters, blanks as dashes, no punctuation.
std::set<std::string> anchors(const std::string& text) {
  std::set<std::string> anchors;
  for (const std::string& heading : matches("\n" + text, std::regex(R"(\n#+ ([^\n]+))"), 1)) {
    std::string anchor;
    for (const char letter : heading) {
      const auto byte = static_cast<unsigned char>(letter);
      if (std::isalnum(byte) != 0 || letter == '-' || letter == '_') anchor += static_cast<char>(std::tolower(byte));
      if (letter == ' ') anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

}  // namespace

TEST_CASE("every link of every document leads to a file, and to a heading in it", "[unit]") {
  for (const std::string& document : documents()) {
    for (const std::string& link : matches(without_code(text_of(source + "/" + document)), link_target, 1)) {
      if (link.starts_with("http")) continue;
      CAPTURE(document, link);
      const auto hash = std::min(link.find('#'), link.size());
      const std::filesystem::path folder = std::filesystem::path(source + "/" + document).parent_path();
      const auto file = hash == 0 ? std::filesystem::path(source + "/" + document) : folder / link.substr(0, hash);
      REQUIRE(std::filesystem::exists(file));
      if (hash < link.size()) CHECK(anchors(text_of(file)).contains(link.substr(hash + 1)));
    }
  }
}

TEST_CASE("every file and every key in a command of every document is there", "[unit]") {
  // NAME stands for what is the reader's.
  const std::regex file(R"((?:^|[^\w/.-])((?:tools|scenes|tests|systems|engine|components)/[\w./-]*\w))");
  const std::regex key(R"(--set '?/(?!pointer)(\w+))");
  const std::string schema = text_of(source + "/scenes/schema/scene.schema.json");
  for (const std::string& document : documents()) {
    const std::string text = text_of(source + "/" + document);
    for (const std::string& path : matches(text, file, 1)) {
      CAPTURE(document, path);
      CHECK((path.find("NAME") != std::string::npos || std::filesystem::exists(source + "/" + path)));
    }
    for (const std::string& name : matches(text, key, 1)) {
      CAPTURE(document, name);
      CHECK_THAT(schema, Catch::Contains('"' + name + "\":"));
    }
  }
}

TEST_CASE("the boxes of the step in the README are its slots, and lead to folders", "[unit]") {
  const std::regex box(R"x(  click (\w+) "([^"]+)")x");
  std::vector<std::string> slots;
  for (const std::string_view slot : slot_names) {
    const auto& rows = table_of_faces().rows;
    const auto is_in_slot = [&](const Row& row) { return row.slot == slot; };
    if (std::any_of(rows.begin(), rows.end(), is_in_slot)) slots.emplace_back(slot);
  }
  CHECK(matches(text_of(source + "/README.md"), box, 1) == slots);
  for (const std::string& target : matches(text_of(source + "/README.md"), box, 2)) {
    CAPTURE(target);
    CHECK(std::filesystem::is_directory(source + "/" + target));
  }
}

TEST_CASE("the README is read in four minutes", "[unit]") {
  const std::string text = std::regex_replace(text_of(source + "/README.md"), link_target, "]");
  std::istringstream words(text);
  CHECK(std::distance(std::istream_iterator<std::string>(words), {}) <= 1000);
  CHECK(matches(" " + without_code(text), std::regex(R"([^\w.](\d[\d.,]*))")).size() <= 25);
}

TEST_CASE("the README names the commands, a scene of this tree and code that is built", "[unit]") {
  const std::string text = text_of(source + "/README.md");
  CHECK_THAT(text, Catch::Contains("tools/run ") && Catch::Contains("tools/test"));
  CHECK(code_blocks(text, {"json"}) == std::vector{text_of(source + "/scenes/dam_break.json")});
  const std::string example = text_of(source + "/tools/example_system/main.cpp");
  const auto code = code_blocks(text, {"cpp"});
  CHECK_FALSE(code.empty());
  for (const std::string& block : code) CHECK_THAT(example, Catch::Contains(block));
}

TEST_CASE("figures that stand in two documents are the same", "[unit]") {
  const auto [text, one, other] = GENERATE(table<std::string, std::string, std::string>({
      // Distance of interFoam's own runs from its finest.
      {"| 0.008 | 0.018 | 0.031 | 0.051 | 0.093 | 0.137 | 0.207 |", "scenes/RESULTS.md", "interfoam"},
      {"| 0.005 | 0.008 | 0.014 | 0.038 | 0.062 | 0.097 | 0.176 |", "scenes/RESULTS.md", "interfoam"},
      // CPU seconds per simulated second: minamo's, then those of the others as they stand before their ratios.
      {"| 0.526 |", "scenes/COMPARISON.md", "bench"},
      {"| 0.163 |", "scenes/COMPARISON.md", "bench"},
      {"| 3.34 |", "scenes/COMPARISON.md", "bench"},
      {"| 0.857 |", "scenes/COMPARISON.md", "bench"},
      {"| 0.858 |", "scenes/COMPARISON.md", "bench"},
      {"| 0.262 |", "scenes/COMPARISON.md", "bench"},
      {"| 6.29 |", "scenes/COMPARISON.md", "bench"},
      {"| 1.85 |", "scenes/COMPARISON.md", "bench"},
      {"| 2.40", "scenes/COMPARISON.md", "bench"},
      {"| 23.0", "scenes/COMPARISON.md", "bench"},
      {"| 0.06", "scenes/COMPARISON.md", "bench"},
      {"| 0.32", "scenes/COMPARISON.md", "bench"},
      {"| 0.077", "scenes/COMPARISON.md", "bench"},
      {"| 0.61", "scenes/COMPARISON.md", "bench"},
      {" 24.3 ", "scenes/COMPARISON.md", "bench"},
      {"45.7 ", "scenes/COMPARISON.md", "bench"},
  }));
  CAPTURE(text, one);
  CHECK_THAT(text_of(source + "/" + one), Catch::Contains(text));
  const std::string file =
      other == "bench" ? "/tests/bench/RESULTS.md" : "/scenes/reference/dam_break_interfoam/README.md";
  CHECK_THAT(text_of(source + file), Catch::Contains(text));
}

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
  CHECK(first_column(block(text_of(source + "/systems/README.md"), "<!-- slots -->")) == slot_names);
}

TEST_CASE("the code in systems/README.md is that of the examples, which are built and run", "[unit]") {
  std::string examples;
  for (const std::string folder : {"/tools/example_system/", "/tools/example_scheme/", "/tools/example_part/"}) {
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
