#include "tests/support/reading.hpp"

#include <catch2/catch.hpp>

using namespace minamo;
using namespace minamo::reading;

TEST_CASE("a number is read", "[unit]") {
  CHECK(value_of<double>(R"({"a": -9.81})", [](Input& in) { return in.number("a", {}); }) == -9.81);
}

TEST_CASE("an absent number is its fallback", "[unit]") {
  CHECK(value_of<double>("{}", [](Input& in) { return in.number("a", {.fallback = 2.5}); }) == 2.5);
}

TEST_CASE("an optional number may be absent", "[unit]") {
  using Value = std::optional<double>;
  CHECK(value_of<Value>("{}", [](Input& in) { return in.optional_number("a", {}); }) == std::nullopt);
}

TEST_CASE("a whole number may be written with a decimal point", "[unit]") {
  const std::string text = GENERATE("{\"a\": 2}", "{\"a\": 2.0}");
  CHECK(value_of<std::int64_t>(text, [](Input& in) { return in.integer("a", {}); }) == 2);
}

TEST_CASE("text, flag and choice are read", "[unit]") {
  const std::vector<std::string> names{"pic", "flip"};
  const Reading reading = read(R"({"t": "é", "f": true, "c": "flip"})", [&](Input& in) {
    CHECK(in.text("t", {}) == "é");
    CHECK(in.flag("f", "", {}));
    CHECK(in.choice("c", names, "") == "flip");
  });
  CHECK(reading.problems.empty());
}

TEST_CASE("lists of numbers are read", "[unit]") {
  using Value = std::vector<double>;
  CHECK(value_of<Value>("{\"a\": [1, 2.5]}", [](Input& in) { return in.numbers("a", 2, {}); }) == Value{1, 2.5});
}

TEST_CASE("the fallback of a list fills all places", "[unit]") {
  using Value = std::vector<std::int64_t>;
  CHECK(value_of<Value>("{}", [](Input& in) { return in.integers("a", 3, {.fallback = 4}); }) == Value{4, 4, 4});
}

TEST_CASE("a number and a text are expressions", "[unit]") {
  const std::string text = GENERATE("{\"a\": 0.584}", "{\"a\": \"2*H\"}", "{\"a\": \"x + y + 0.284\"}");
  const auto read_a = [](Input& in) { return in.expression("a", place_and_time, {}); };
  CHECK(value_of<Expression>(text, read_a)(std::vector{0.1, 0.2, 0.0}) == Approx(0.584).epsilon(1e-15));
}

TEST_CASE("once there are constants, a text in the place of a number is what it comes to", "[unit]") {
  const Reading reading =
      read(R"({"a": "2*H", "n": "N", "l": [1, "H/2"], "m": ["N*N", 3], "o": "pi", "e": "H*x"})", [](Input& in) {
        in.use_constants({{"H", 0.25}, {"N", 4}});
        CHECK(in.number("a", {}) == 0.5);
        CHECK(in.integer("n", {}) == 4);
        CHECK(in.numbers("l", 2, {}) == std::vector{1, 0.125});
        CHECK(in.integers("m", 2, {}) == std::vector<std::int64_t>{16, 3});
        CHECK(in.optional_number("o", {}) == Approx(3.14159265358979).epsilon(2e-15));
        in.raw("e", {{"type", "string"}}, Json());
      });
  CHECK(reading.problems.empty());
  CHECK(reading.echo.dump() == R"({"a":0.5,"n":4,"l":[1,0.125],"m":[16,3],"o":3.141592653589793,"e":"H*x"})");
}

TEST_CASE("a text in the place of a number is told from one that comes to a wrong number", "[error]") {
  const auto messages = [](const std::string& text) {
    const Reading reading = read(text, [](Input& in) {
      in.use_constants({{"H", 0.25}});
      in.number("a", {.unit = "m", .above = 0});
      in.integer("n", {.fallback = 1});
    });
    std::string all;
    for (const Problem& problem : reading.problems)
      all += problem.what + "; " + problem.expected + "; " + problem.closest;
    return all;
  };
  CHECK(messages(R"({"a": "2*h"})") == "not an expression: unknown name \"h\" at character 3; "
                                       "a number > 0 or an expression [m]; H");
  CHECK(messages(R"({"a": "-H"})") == "out of range; a number > 0 [m]; ");
  CHECK(messages(R"({"a": "1/0"})") == "out of range; a number > 0 [m]; ");
  CHECK(messages(R"({"a": 1, "n": "2*H"})") == "not a whole number; a whole number; ");
}

TEST_CASE("named numbers are read by name", "[unit]") {
  using Value = std::map<std::string, double>;
  CHECK(value_of<Value>(R"({"c": {"H": 1, "b": 2}})", [](Input& in) { return in.named_numbers("c", ""); }) ==
        Value{{"H", 1}, {"b", 2}});
}

TEST_CASE("a raw value is read as it stands", "[unit]") {
  const auto read_a = [](Input& in) { return in.raw("a", {{"type", "array"}}, Json()); };
  CHECK(value_of<Json>(R"({"a": ["slip", {"b": 1}]})", read_a).dump() == R"(["slip",{"b":1}])");
}

TEST_CASE("a wrong value is reported with what its rule expects", "[error]") {
  using Case = std::tuple<std::string, std::string, std::string, std::string, Rules>;
  const auto [json, what, expected, got, rule] = GENERATE(values<Case>({
      {"\"1e3\"", "wrong type", "a number > 0 [kg/m^3]", "\"1e3\" (string)",
       [](Input& in) { in.number("a", {.unit = "kg/m^3", .above = 0}); }},
      {"null", "wrong type", "a number", "null", [](Input& in) { in.number("a", {}); }},
      {"0", "out of range", "a number > 0 [m]", "0 (number)",
       [](Input& in) { in.number("a", {.unit = "m", .above = 0}); }},
      {"1.5", "out of range", "a number in [0, 1]", "1.5 (number)",
       [](Input& in) { in.number("a", {.at_least = 0, .at_most = 1}); }},
      {"1", "out of range", "a number in [0, 1)", "1 (number)",
       [](Input& in) { in.optional_number("a", {.at_least = 0, .below = 1}); }},
      {"2.5", "not a whole number", "a whole number >= 1", "2.5 (number)",
       [](Input& in) { in.integer("a", {.at_least = 1}); }},
      {"0", "out of range", "a whole number in [2, 3]", "0 (number)",
       [](Input& in) { in.integer("a", {.at_least = 2, .at_most = 3}); }},
      {"18446744073709551615", "out of range", "a whole number", "18446744073709551615 (number)",
       [](Input& in) { in.integer("a", {}); }},
      {"3", "wrong type", "a string", "3 (number)", [](Input& in) { in.text("a", {}); }},
      {"1", "wrong type", "true or false", "1 (number)", [](Input& in) { in.flag("a", "", true); }},
      {"[1]", "wrong length", "a list of 2 numbers [m]", "[1] (list)",
       [](Input& in) { in.numbers("a", 2, {.unit = "m"}); }},
      {"1", "wrong type", "a list of 2 whole numbers >= 1", "1 (number)",
       [](Input& in) { in.integers("a", 2, {.at_least = 1}); }},
      {"true", "wrong type", "a number or an expression in x, y, t [m/s]", "true (boolean)",
       [](Input& in) { in.expression("a", place_and_time, {.unit = "m/s"}); }},
      {"[1]", "wrong length", "a list of 2 numbers or expressions in x, y, t [m/s]", "[1] (list)",
       [](Input& in) { in.expressions("a", 2, place_and_time, {.unit = "m/s"}); }},
      {"\"-H\"", "out of range", "a number > 0 or an expression in x, y, t [m]", "\"-H\" (string)",
       [](Input& in) { in.expression("a", place_and_time, {.unit = "m", .above = 0}); }},
      {"\"1/0\"", "not finite", "a number or an expression in x, y, t", "\"1/0\" (string)",
       [](Input& in) { in.expression("a", place_and_time, {}); }},
      {"3", "wrong type", "an object of numbers", "3 (number)", [](Input& in) { in.named_numbers("a", ""); }},
      {"3", "wrong type", "an object", "3 (number)",
       [](Input& in) { in.object("a", "", Input::Presence::optional, [](Input& o) { o.number("b", {}); }); }},
      {"{}", "wrong type", "a list of objects", "{} (object)",
       [](Input& in) { in.list("a", "", 0, [](Input&, std::size_t) {}); }},
      {"[]", "too short", "a list of at least 1 object", "[] (list)",
       [](Input& in) { in.list("a", "", 1, [](Input&, std::size_t) {}); }},
  }));
  CHECK(messages("{\"a\": " + json + "}", rule) ==
        Messages{"a.json: /a: " + what + "\n  expected  " + expected + "\n  got       " + got});
}

TEST_CASE("a wrong element is reported with its place", "[error]") {
  CHECK(messages(R"({"a/b": [1, "2"]})", [](Input& in) { in.numbers("a/b", 2, {.unit = "m"}); }) ==
        Messages{"a.json: /a~1b/1: wrong type\n  expected  a number [m]\n  got       \"2\" (string)"});
}

TEST_CASE("an unknown name is reported with the closest", "[error]") {
  CHECK(messages(with("/transfer={\"scheme\": \"flop\"}"), read_liquid) ==
        Messages{"a.json: /transfer/scheme: unknown name\n"
                 "  expected  one of [\"flip\", \"tpic\", \"xpic\"]\n"
                 "  got       \"flop\" (string)\n"
                 "  closest   \"flip\""});
}

TEST_CASE("an unknown name in an expression is reported with the closest", "[error]") {
  const auto rule = [](Input& in) { in.expression("a", {{"x", "time"}, {}}, {.unit = "m/s"}); };
  CHECK(messages(R"({"a": "x*tmie"})", rule) ==
        Messages{"a.json: /a: not an expression: unknown name \"tmie\" at character 3\n"
                 "  expected  a number or an expression in x, time [m/s]\n"
                 "  got       \"x*tmie\" (string)\n"
                 "  closest   \"time\""});
}

TEST_CASE("a missing key is reported with what is expected", "[error]") {
  CHECK(messages("{}", [](Input& in) { in.number("density", {.unit = "kg/m^3", .above = 0}); }) ==
        Messages{"a.json: /density: missing key\n  expected  a number > 0 [kg/m^3]"});
}

TEST_CASE("a missing required object is one problem", "[error]") {
  const auto rule = [](Input& in) {
    in.object("a", "", Input::Presence::required, [](Input& a) { a.number("b", {}); });
  };
  CHECK(messages("{}", rule) == Messages{"a.json: /a: missing key\n  expected  an object"});
}

TEST_CASE("a document that is not an object is one problem", "[error]") {
  CHECK(messages("[1]", read_liquid) == Messages{"a.json: wrong type\n  expected  an object\n  got       [1] (list)"});
}

TEST_CASE("a wrong value reads as one that fits", "[unit]") {
  read(R"({"a": "x", "b": 9, "c": 0})", [](Input& in) {
    CHECK(in.number("a", {.above = 2, .below = 4}) == 3);
    CHECK(in.integer("b", {.at_least = 2, .at_most = 3}) == 2);
    CHECK(in.numbers("c", 2, {.fallback = 7.0}) == std::vector{7.0, 7.0});
  });
}
