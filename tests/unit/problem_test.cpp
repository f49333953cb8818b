#include "engine/input/problem.hpp"

#include <catch2/catch.hpp>

using namespace minamo;

TEST_CASE("a problem names file, place, what, expected, got and closest", "[unit]") {
  const Problem problem{
      "dam_break.json", "/transfer/scheme", "unknown name", R"(one of ["apic", "flip"])", R"("apci" (string))", "apic"};
  CHECK(problem.text() == "dam_break.json: /transfer/scheme: unknown name\n"
                          "  expected  one of [\"apic\", \"flip\"]\n"
                          "  got       \"apci\" (string)\n"
                          "  closest   \"apic\"");
}

TEST_CASE("a problem leaves out what is empty", "[unit]") {
  CHECK(Problem{"a.json", {}, "no such file", {}, {}, {}}.text() == "a.json: no such file");
}

TEST_CASE("a closest value that is JSON is shown as it is", "[unit]") {
  CHECK(Problem{"a", "/cells", "unequal", {}, {}, "[40, 20]"}.text() == "a: /cells: unequal\n  closest   [40, 20]");
}

TEST_CASE("an input error says all its problems", "[unit]") {
  const InputError error({{"a", "/x", "missing key", {}, {}, {}}, {"a", "/y", "unknown key", {}, {}, {}}});
  CHECK(std::string(error.what()) == "a: /x: missing key\na: /y: unknown key");
}

TEST_CASE("the closest name differs by few letters", "[unit]") {
  const std::vector<std::string> known{"apic", "flip", "pic", "tpic", "viscosity"};
  const auto [name, closest] = GENERATE(table<std::string, std::string>({{"apci", "apic"},
                                                                         {"flop", "flip"},
                                                                         {"FLIP", "flip"},
                                                                         {"viscosty", "viscosity"},
                                                                         {"viskositie", "viscosity"},
                                                                         {"newmark", ""},
                                                                         {"", ""},
                                                                         {"q", ""}}));
  CAPTURE(name);
  CHECK(closest_name(name, known) == closest);
}

TEST_CASE("a value is shown with its type", "[unit]") {
  const auto [json, text] = GENERATE(table<std::string, std::string>({{R"("apci")", R"("apci" (string))"},
                                                                      {"-3", "-3 (number)"},
                                                                      {"true", "true (boolean)"},
                                                                      {"null", "null"},
                                                                      {"[1,2]", "[1,2] (list)"},
                                                                      {"{}", "{} (object)"}}));
  CHECK(shown(Json::parse(json)) == text);
}

TEST_CASE("a long value is cut between characters", "[unit]") {
  CHECK(shown(Json(std::string(58, 'a') + "éé")) == "\"" + std::string(58, 'a') + "... (string)");
}
