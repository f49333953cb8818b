#include "tests/support/reading.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::reading;

TEST_CASE("the echo holds every key in reading order with defaults filled in", "[unit]") {
  CHECK(read(liquid, read_liquid).echo.dump() ==
        R"({"title":"","dimension":2,"fluid":{"density":1000,"viscosity":0},)"
        R"("bodies":[{"ball":[0,0,1],"velocity":["y*t",1.5]},{"where":"y < 0.5","velocity":[0,0]}],)"
        R"("transfer":{"scheme":"tpic"}})");
}

TEST_CASE("reading the echo gives the echo", "[unit]") {
  const std::string text =
      GENERATE(as<std::string>(), liquid, with("/transfer={\"scheme\": \"flip\"}"), with("/fluid/viscosity=1e-3"));
  const Json echo = read(text, read_liquid).echo;
  const Reading again = read(echo.dump(), read_liquid);
  CHECK(again.problems.empty());
  CHECK(again.echo.dump() == echo.dump());
}

TEST_CASE("a default in the echo reads back to the same number", "[unit]") {
  const double number = GENERATE(0.1, 1.0 / 3, 1e-300, 5e-324, -0.0, 1e15, 1e300, 9007199254740993.0);
  const auto rule = [&](Input& in) { return in.number("a", {.fallback = number}); };
  const Json echo = read("{}", rule).echo;
  CHECK(Json::parse(echo.dump())["a"].get<double>() == number);
}

TEST_CASE("a raw value stands in the echo as it is, or as its fallback", "[unit]") {
  const auto [text, echo] = GENERATE(
      table<std::string, std::string>({{R"({"a": {"b": 1}})", R"({"a":{"b":1}})"}, {"{}", R"({"a":"slip"})"}}));
  CHECK(read(text, [](Input& in) { in.raw("a", Json::object(), "slip"); }).echo.dump() == echo);
}

namespace {

Input::Document description() {
  Input::Document document = Input::Document::describe();
  read_liquid(document.root());
  document.finish();
  return document;
}

}  // namespace

TEST_CASE("describing finds no problems", "[unit]") { CHECK(description().problems().empty()); }

TEST_CASE("the schema states unit, range, default and description", "[unit]") {
  const Json fluid = description().schema()["properties"]["fluid"];
  CHECK(fluid["properties"]["density"].dump() ==
        R"({"type":"number","exclusiveMinimum":0,"x-unit":"kg/m^3","description":"density"})");
  CHECK(fluid["properties"]["viscosity"].dump() ==
        R"({"type":"number","minimum":0,"x-unit":"Pa s","description":"dynamic viscosity","default":0})");
}

TEST_CASE("the schema requires keys without a default, and the objects that hold them", "[unit]") {
  const Json schema = description().schema();
  CHECK(schema["required"] == Json{"dimension", "fluid", "bodies"});
  CHECK(schema["properties"]["fluid"]["required"] == Json::array({"density"}));
}

TEST_CASE("the schema admits no further keys", "[unit]") {
  const Json schema = description().schema();
  CHECK(schema["additionalProperties"] == false);
  CHECK(schema["properties"]["bodies"]["items"]["additionalProperties"] == false);
}

TEST_CASE("the schema proposes names that other programs may add to, and takes others", "[unit]") {
  const std::vector<std::string> names{"apic", "flip"};
  Input::Document document = Input::Document::describe();
  document.root().known_name("use", names, "a name");
  CHECK(document.schema()["properties"]["use"].dump() ==
        R"({"type":"string","examples":["apic","flip"],"description":"a name"})");
}

TEST_CASE("an optional text may be absent, and then stands neither in the echo nor among the required keys", "[unit]") {
  const auto rule = [](Input& in) { return in.optional_text("a", "a text"); };
  CHECK(read("{}", rule).echo == Json::object());
  CHECK(read(R"({"a": "b"})", rule).echo == Json{{"a", "b"}});
  CHECK(messages(R"({"a": 1})", rule) ==
        Messages{"a.json: /a: wrong type\n  expected  a string\n  got       1 (number)"});
  Input::Document document = Input::Document::describe();
  rule(document.root());
  CHECK(document.schema()["required"] == Json::array());
}

TEST_CASE("the schema has an alternative for every variant", "[unit]") {
  const Json alternatives = description().schema()["properties"]["transfer"]["allOf"][0]["oneOf"];
  REQUIRE(alternatives.size() == 3);
  CHECK(alternatives[0]["properties"]["scheme"] == Json{{"const", "flip"}});
  CHECK(alternatives[0]["properties"]["blend"]["maximum"] == 1);
  CHECK(alternatives[0]["properties"]["order"] == false);
  CHECK(alternatives[0]["required"] == Json::array({"scheme"}));
  CHECK(alternatives[1]["required"] == Json::array());  // the default
  CHECK(alternatives[2]["required"] == Json({"order", "scheme"}));
}

TEST_CASE("the schema has an alternative for every key of a choice", "[unit]") {
  const Json alternatives = description().schema()["properties"]["bodies"]["items"]["allOf"][0]["oneOf"];
  REQUIRE(alternatives.size() == 2);
  CHECK(alternatives[0]["required"] == Json::array({"ball"}));
  CHECK(alternatives[0]["properties"]["where"] == false);
}

TEST_CASE("a key described with two sizes accepts both", "[unit]") {
  Input::Document document = Input::Document::describe();
  for (const std::size_t size : {2, 3}) document.root().numbers("low", size, {.unit = "m", .doc = "corner"});
  const Json low = document.schema()["properties"]["low"];
  CHECK(low["minItems"] == 2);
  CHECK(low["maxItems"] == 3);
}

TEST_CASE("the key table has a row per key", "[unit]") {
  CHECK(description().key_table() ==
        "| Key | Value | Default | Meaning |\n"
        "| --- | --- | --- | --- |\n"
        "| /title | string | \"\" | title |\n"
        "| /dimension | whole number in [2, 3] | required | dimension of space |\n"
        "| /fluid | object | required | the liquid |\n"
        "| /fluid/density | number > 0 [kg/m^3] | required | density |\n"
        "| /fluid/viscosity | number >= 0 [Pa s] | 0 | dynamic viscosity |\n"
        "| /bodies | list of at least 1 object | required | bodies of liquid |\n"
        "| /bodies/*/velocity | list of 2 numbers or expressions in x, y, t [m/s] | [0, 0] | velocity |\n"
        "| /bodies/*/ball | list of 3 numbers [m] | required | centre, radius (instead of where) |\n"
        "| /bodies/*/where | string | required | condition (instead of ball) |\n"
        "| /transfer | object | optional | the transfer |\n"
        "| /transfer/scheme | one of [\"flip\", \"tpic\", \"xpic\"] | \"tpic\" | name |\n"
        "| /transfer/blend | number in [0, 1] | 1 | share (with scheme \"flip\") |\n"
        "| /transfer/order | whole number >= 1 | required | order (with scheme \"xpic\") |\n");
}

TEST_CASE("describing gives values that fit their rules", "[unit]") {
  Input::Document document = Input::Document::describe();
  Input& in = document.root();
  CHECK(in.number("a", {.at_least = 2}) == 2);
  CHECK(in.number("b", {.above = 0}) > 0);
  CHECK(in.numbers("c", 2, {.fallback = 1.5}) == std::vector{1.5, 1.5});
  CHECK(in.integer("d", {.at_least = 2, .at_most = 3}) == 2);
  CHECK(in.has("e"));
  CHECK(in.describing());
}

TEST_CASE("the schema and the table describe objects whose names the user chooses", "[unit]") {
  auto document = Input::Document::describe();
  document.root().named_objects("growth", "what grows", [](Input& one, const std::string&) {
    one.number("start", {.unit = "m", .doc = "start"});
  });
  const Json growth = document.schema()["properties"]["growth"];
  CHECK(growth["additionalProperties"]["required"] == Json({"start"}));
  CHECK(growth["additionalProperties"]["properties"]["start"]["type"] == "number");
  CHECK(document.schema()["required"].empty());
  CHECK_THAT(document.key_table(), Catch::Contains("| /growth/*/start | number [m] | required | start |"));
}
