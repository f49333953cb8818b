#include "tests/support/reading.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::reading;

TEST_CASE("a problem may lie below a key, at a pointer", "[error]") {
  const auto rule = [](Input& in) {
    in.raw("walls", Json::object(), Json());
    in.problem("walls/x/1", "unknown name");
  };
  CHECK(messages(R"({"walls": {"x": ["slip", "slop"]}})", rule) ==
        Messages{"a.json: /walls/x/1: unknown name\n  got       \"slop\" (string)"});
}

TEST_CASE("a key is sound as long as no problem is known at it or under it", "[unit]") {
  const auto [text, is_sound] = GENERATE(table<std::string, bool>(
      {{R"({"a": {"b": 1}})", true}, {R"({"a": {"b": "1"}})", false}, {R"({"a": 1})", false}, {"{}", false}}));
  CAPTURE(text);
  const Json json = Json::parse(text);
  Input::Document document(json, "a.json");
  document.root().object("a", "", Input::Presence::required, [](Input& a) { a.number("b", {}); });
  CHECK(document.root().sound("a") == is_sound);
  CHECK(document.root().sound("ab"));
}

TEST_CASE("the elements of a list are counted before it is read", "[unit]") {
  const Json json = Json::parse(R"({"grid": {"low": [0, 0, 0], "high": 1}})");
  Input::Document document(json, "a.json");
  CHECK(document.root().elements("grid/low") == 3U);
  CHECK(document.root().elements("grid/high") == std::nullopt);
  CHECK(document.root().elements("mesh/low") == std::nullopt);
}

TEST_CASE("an absent raw value is its fallback", "[unit]") {
  CHECK(value_of<Json>("{}", [](Input& in) { return in.raw("walls", Json::object(), "slip"); }) == "slip");
}

TEST_CASE("an unknown key names the choice that excludes it", "[error]") {
  CHECK(messages(with(R"(/transfer={"scheme": "tpic", "blend": 1})"), read_liquid) ==
        Messages{"a.json: /transfer/blend: unknown key with scheme \"tpic\"\n"
                 "  expected  one of [\"scheme\"]\n"
                 "  got       1 (number)"});
}

TEST_CASE("a wrong number leaves its name to expressions", "[error]") {
  CHECK(messages(R"({"constants": {"H": "1"}, "a": "2*H"})", [](Input& in) {
          in.expression("a", {{}, in.named_numbers("constants", "")}, {});
        }).size() == 1);
}

TEST_CASE("a list read in two sizes has no single default", "[unit]") {
  Input::Document document = Input::Document::describe();
  for (const std::size_t size : {2U, 3U}) document.root().numbers("b", size, {.unit = "m", .doc = "b", .fallback = 0});
  CHECK(document.schema()["properties"]["b"]["minItems"] == 2);
  CHECK(document.schema()["properties"]["b"]["maxItems"] == 3);
  CHECK_FALSE(document.schema()["properties"]["b"].contains("default"));
  CHECK_THAT(document.key_table(), Catch::Contains("| /b | list of 2 or 3 numbers [m] | 0 each | b |"));
}

TEST_CASE("many names are not listed", "[unit]") {
  CHECK(one_of_text(std::vector<std::string>{"a", "b"}) == R"(one of ["a", "b"])");
  CHECK(one_of_text(std::vector<std::string>(100, "a")) == "a known name");
}
