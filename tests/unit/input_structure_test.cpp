#include "tests/support/reading.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::reading;

TEST_CASE("an unknown key is reported with the known ones if none is near", "[error]") {
  CHECK(messages(R"({"a": 1, "colour": 3})", [](Input& in) { in.number("a", {}); }) ==
        Messages{"a.json: /colour: unknown key\n  expected  one of [\"a\"]\n  got       3 (number)"});
}

TEST_CASE("one misspelt required key is one problem", "[error]") {
  CHECK(messages(R"({"densty": 1000})", [](Input& in) { in.number("density", {.above = 0}); }) ==
        Messages{"a.json: /densty: unknown key\n  got       1000 (number)\n  closest   \"density\""});
}

TEST_CASE("one misspelt object with required keys is one problem", "[error]") {
  Json document = Json::parse(liquid);
  document["fluit"] = document["fluid"];
  document.erase("fluid");
  CHECK(messages(document.dump(), read_liquid) ==
        Messages{"a.json: /fluit: unknown key\n  got       {\"density\":1000} (object)\n  closest   \"fluid\""});
}

TEST_CASE("one misspelt key of a choice is one problem", "[error]") {
  CHECK(messages(with(R"(/bodies=[{"bal": [0, 0, 1]}])"), read_liquid) ==
        Messages{"a.json: /bodies/0/bal: unknown key\n  got       [0,0,1] (list)\n  closest   \"ball\""});
}

TEST_CASE("unknown keys are found in objects and lists", "[error]") {
  const Reading reading = read(with("/fluid/q=1"), read_liquid);
  REQUIRE(reading.problems.size() == 1);
  CHECK(reading.problems[0].pointer == "/fluid/q");
  CHECK(read(with("/bodies/1/q=1"), read_liquid).problems.at(0).pointer == "/bodies/1/q");
}

TEST_CASE("a key of a variant that is not chosen is unknown", "[error]") {
  CHECK(read(with(R"(/transfer={"scheme": "tpic", "blend": 1})"), read_liquid).problems.at(0).pointer ==
        "/transfer/blend");
}

TEST_CASE("a key asked for with has() only is unknown", "[error]") {
  CHECK(messages(R"({"a": 1})", [](Input& in) { CHECK(in.has("a")); }) ==
        Messages{"a.json: /a: unknown key\n  got       1 (number)"});
}

TEST_CASE("problems come in the order of reading", "[error]") {
  std::vector<std::string> pointers;
  for (const Problem& problem : read(R"({"c": 1, "dx": 1, "a": "1", "e": 1})", [](Input& in) {
                                  in.number("a", {});
                                  in.number("ddx", {});
                                  in.text("c", {});
                                }).problems)
    pointers.push_back(problem.pointer);
  CHECK(pointers == std::vector<std::string>{"/a", "/dx", "/c", "/e"});
}

TEST_CASE("an absent optional object gives its defaults", "[unit]") {
  const auto rule = [](Input& in) {
    double value = 0;
    in.object("a", "", Input::Presence::optional, [&](Input& a) { value = a.number("b", {.fallback = 3.0}); });
    return value;
  };
  CHECK(value_of<double>("{}", rule) == 3);
}

TEST_CASE("an object read only if present is left out", "[unit]") {
  const Reading reading = read("{}", [](Input& in) {
    in.object("a", "", Input::Presence::only_if_present, [](Input& a) { a.number("b", {}); });
  });
  CHECK(reading.problems.empty());
  CHECK(reading.echo == Json::object());
}

TEST_CASE("every element that is not an object is reported", "[error]") {
  CHECK(messages(with("/bodies=[1, {\"where\": \"\"}, []]"), read_liquid) ==
        Messages{"a.json: /bodies/0: wrong type\n  expected  an object\n  got       1 (number)",
                 "a.json: /bodies/2: wrong type\n  expected  an object\n  got       [] (list)"});
}

TEST_CASE("a list gives every element with its number", "[unit]") {
  std::vector<std::string> pointers;
  read(R"({"a": [{}, {}]})", [&](Input& in) {
    in.list("a", "", 0, [&](Input& a, std::size_t i) { pointers.push_back(a.pointer() + " " + std::to_string(i)); });
  });
  CHECK(pointers == std::vector<std::string>{"/a/0 0", "/a/1 1"});
}

TEST_CASE("after an unknown variant its keys are not reported", "[error]") {
  CHECK(read(with(R"(/transfer={"scheme": "flpi", "blend": 0.5})"), read_liquid).problems.size() == 1);
}

TEST_CASE("exactly one key of a choice must be there", "[error]") {
  CHECK(messages(with("/bodies=[{}, {\"ball\": [0, 0, 1], \"where\": \"\"}]"), read_liquid) ==
        Messages{"a.json: /bodies/0: missing key\n  expected  exactly one of [\"ball\", \"where\"]",
                 "a.json: /bodies/1: keys that exclude each other\n  expected  exactly one of [\"ball\", \"where\"]\n"
                 "  got       [\"ball\", \"where\"]"});
}

TEST_CASE("a problem that rules cannot express shows the value", "[error]") {
  CHECK(messages(R"({"a": 3})", [](Input& in) {
          in.problem("a", "too many", "fewer than " + std::to_string(static_cast<int>(in.number("a", {}))));
        }) == Messages{"a.json: /a: too many\n  expected  fewer than 3\n  got       3 (number)"});
}

TEST_CASE("a further problem with a wrong value is left out", "[error]") {
  const auto rule = [](Input& in) {
    in.numbers("a", 2, {});
    in.problem("a", "too large");
  };
  CHECK(read(R"({"a": [1, "2"]})", rule).problems.size() == 1);
}

TEST_CASE("a document with problems is not valid", "[error]") {
  const Json json = Json::object();
  Input::Document document(json, "a.json");
  document.root().number("a", {});
  CHECK_THROWS_AS(document.require_valid(), InputError);
}

TEST_CASE("a document without problems is valid", "[unit]") {
  const Json json = Json::object();
  Input::Document document(json, "a.json");
  document.finish();
  CHECK_NOTHROW(document.require_valid());
}

TEST_CASE("objects are read under the names that the user chose", "[unit]") {
  std::vector<std::string> names;
  double sum = 0;
  const auto rules = [&](Input& input) {
    input.named_objects("growth", "what grows", [&](Input& one, const std::string& name) {
      names.push_back(name);
      sum += one.number("start", {.doc = "start", .fallback = 3});
    });
  };
  const Reading reading = read(R"({"growth": {"b": {"start": 1}, "a": {}}})", rules);
  CHECK(reading.problems.empty());
  CHECK(names == std::vector<std::string>{"b", "a"});
  CHECK(sum == 4);
  CHECK(reading.echo.dump() == R"({"growth":{"b":{"start":1},"a":{"start":3}}})");
  CHECK(read("{}", rules).echo.dump() == R"({"growth":{}})");
}

TEST_CASE("problems below names that the user chose have their place", "[error]") {
  const auto rules = [](Input& input) {
    input.named_objects("growth", "what grows",
                        [](Input& one, const std::string&) { one.number("start", {.doc = "start"}); });
  };
  CHECK(messages(R"({"growth": {"a": 1, "b": {}, "c": {"start": 1, "stop": 2}}})", rules) ==
        Messages{"a.json: /growth/a: wrong type\n  expected  an object\n  got       1 (number)",
                 "a.json: /growth/b/start: missing key\n  expected  a number",
                 "a.json: /growth/c/stop: unknown key\n  expected  one of [\"start\"]\n  got       2 (number)"});
  CHECK(messages(R"({"growth": 1})", rules) ==
        Messages{"a.json: /growth: wrong type\n  expected  an object of objects\n  got       1 (number)"});
}

TEST_CASE("the names of an object are known before it is read", "[unit]") {
  std::vector<std::string> names;
  const auto rules = [&](Input& input) {
    names = input.names("growth");
    input.named_objects("growth", "what grows", [](Input&, const std::string&) {});
  };
  read(R"({"growth": {"b": {}, "a": {}}})", rules);
  CHECK(names == std::vector<std::string>{"b", "a"});
  read(R"({"growth": 1})", rules);
  CHECK(names.empty());
}

TEST_CASE("an optional expression may be absent", "[unit]") {
  const auto given = [](const std::string& text) {
    return value_of<std::size_t>(text, [](Input& input) {
      const auto one = input.optional_expression("p", place_and_time, {.doc = "pressure"});
      const auto list = input.optional_expressions("v", 2, place_and_time, {.doc = "velocity"});
      return (one ? 1U : 0U) + (list ? 10 * list->size() : 0U);
    });
  };
  CHECK(given("{}") == 0);
  CHECK(given(R"({"p": "x"})") == 1);
  CHECK(given(R"({"p": 2, "v": ["x", 1]})") == 21);
}
