/// \file
/// systems/EQUATIONS.md and the code have the same equations.

#include "support/folder.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <regex>
#include <set>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

const fs::path sources = MINAMO_SOURCE_DIR;

std::set<int> numbers_in(const std::string& text, const std::regex& pattern) {
  std::set<int> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    numbers.insert(std::stoi((*at)[1]));
  }
  return numbers;
}

const std::regex mention(R"(\(E(\d+)\))");

/// Those of the lines that `list systems` prints.
std::set<int> numbers_of_systems_in(const std::string& text) {
  static const std::regex line(R"re(doc =\s*((?:"[^"]*"\s*)+);)re");
  std::set<int> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at) {
    numbers.merge(numbers_in((*at)[1], mention));
  }
  return numbers;
}

std::set<int> numbers_in_code() {
  std::set<int> numbers;
  for (const char* folder : {"systems", "components"}) {
    for (const auto& entry : fs::recursive_directory_iterator(sources / folder)) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      numbers.merge(numbers_in(text_of(entry.path()), mention));
    }
  }
  return numbers;
}

std::string document() { return text_of(sources / "systems/EQUATIONS.md"); }

/// The entries of the document, `**(E3)** ...` up to an empty line, by number.
std::map<int, std::string> entries() {
  std::istringstream lines(document());
  std::map<int, std::string> entries;
  int number = 0;  // none
  for (std::string line; std::getline(lines, line);) {
    std::smatch begin;
    if (std::regex_search(line, begin, std::regex(R"(^\*\*\(E(\d+)\)\*\*)"))) {
      number = std::stoi(begin[1]);
      CAPTURE(line);
      CHECK_FALSE(entries.contains(number));
    }
    if (line.empty()) number = 0;
    if (number != 0) entries[number] += line + "\n";
  }
  return entries;
}

}  // namespace

TEST_CASE("every equation of the code has an entry, and every entry is in the code", "[unit]") {
  std::set<int> described;
  for (const auto& [number, text] : entries()) described.insert(number);
  CHECK(described == numbers_in_code());
}

TEST_CASE("equations are numbered without gaps", "[unit]") {
  const auto all = entries();
  CHECK(all.size() == static_cast<std::size_t>(all.rbegin()->first));
}

TEST_CASE("the files that an entry names have its number", "[unit]") {
  for (const auto& [number, text] : entries()) {
    const std::regex path(R"(`(systems/[^`]+)`)");
    std::size_t files = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), path), end; at != end; ++at, ++files) {
      CAPTURE(number, (*at)[1].str());
      CHECK(numbers_in(text_of(sources / (*at)[1].str()), mention).contains(number));
    }
    CAPTURE(number);
    CHECK(files > 0);
  }
}

TEST_CASE("an entry names the files of all systems that say they compute it", "[unit]") {
  const auto all = entries();
  std::size_t mentions = 0;
  for (const auto& entry : fs::recursive_directory_iterator(sources / "systems")) {
    if (entry.path().extension() != ".hpp") continue;
    const std::string file = fs::relative(entry.path(), sources).generic_string();
    for (const int number : numbers_of_systems_in(text_of(entry.path()))) {
      CAPTURE(number, file);
      CHECK(all.at(number).find("`" + file + "`") != std::string::npos);
      ++mentions;
    }
  }
  CHECK(mentions > 150);
}

TEST_CASE("an equation mentioned in the document has an entry", "[unit]") {
  const auto all = entries();
  for (const int number : numbers_in(document(), mention)) {
    CAPTURE(number);
    CHECK(all.contains(number));
  }
}
