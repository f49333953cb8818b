#include "tests/support/folder.hpp"
#include "tests/support/reading.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using namespace minamo;
using namespace minamo::reading;

namespace {

std::string parse_message(const std::string& text) {
  try {
    parse_json(text, "a.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string set_message(Json document, const std::string& assignment) {
  try {
    set_value(document, assignment);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string read_message(const std::filesystem::path& path) {
  try {
    read_json(path.string());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a text that does not parse is reported with line and column", "[error]") {
  CHECK(parse_message("{\n  \"a\": 1\n  \"b\": 2}") ==
        "a.json: line 3, column 5: unexpected string literal\n  expected  '}'\n  got       \"b\": 2}");
}

TEST_CASE("a text that ends early is reported at its end", "[error]") {
  CHECK(parse_message("{\"a\": [1,\n") == "a.json: line 2, column 1: unexpected end of input\n"
                                          "  expected  '[', '{', or a literal");
}

TEST_CASE("what JSON does not know is reported with its place", "[error]") {
  const auto [text, place] = GENERATE(table<std::string, std::string>({{"{\"a\": NaN}", "line 1, column 7"},
                                                                       {"{} // comment", "line 1, column 4"},
                                                                       {"/* comment */ {}", "line 1, column 1"},
                                                                       {"{\"a\": 1,}", "line 1, column 9"},
                                                                       {"{\"a\": 1e999}", "line 1, column 11"},
                                                                       {"{\"a\": 'b'}", "line 1, column 7"},
                                                                       {"\"\xff\"", "line 1, column 2"}}));
  CAPTURE(text);
  CHECK_THAT(parse_message(text), Catch::StartsWith("a.json: " + place + ": "));
}

TEST_CASE("the usual slips of a hand are called by their name, with what to write", "[error]") {
  using Case = std::tuple<std::string, std::string, std::string>;
  const auto [text, what, expected] = GENERATE(values<Case>({
      {R"({"a": 1 // one})", "a comment, which JSON does not have", "the text without it"},
      {R"(/* a */ {"a": 1})", "a comment, which JSON does not have", "the text without it"},
      {"# a\n{}", "a comment, which JSON does not have", "the text without it"},
      {"{\"a\": 1,\n}", "a comma before '}'", "none after the last key, in line 1"},
      {"{\"a\": [1,\n 2,\n ]}", "a comma before ']'", "none after the last element, in line 2"},
      {R"({"a": NaN})", "NaN, which is no number of JSON", "a finite number"},
      {R"({"a": nan})", "NaN, which is no number of JSON", "a finite number"},
      {R"({"a": -Infinity})", "Infinity, which is no number of JSON", "a finite number"},
      {R"({"a": inf})", "inf, which is no number of JSON", "a finite number"},
      {R"({"a": True})", "True in another spelling", "true"},
      {R"({"a": None})", "None", "no key at all, or \"none\" in quotes"},
      {R"({'a': 1})", "a single quote", "double quotes around keys and texts"},
      {R"({a: 1})", "a key without quotes", "\"a\""},
      {R"({"a": slip})", "a word without quotes", "\"slip\""},
      {R"({"a": .5})", "a number that begins with its point", "a digit before it: 0.5"},
      {R"({"a": +5})", "a number with a plus sign", "none: 0.5"},
      {R"({"a": 2*pi})", "an expression without quotes", "one in quotes, like \"2*pi/3\""},
      {R"({"a": 1/3})", "an expression without quotes", "one in quotes, like \"2*pi/3\""},
      {R"({"a": 5 mm})", "letters after a number", "the number alone, or an expression in quotes"},
      {R"({"a": 5mm})", "letters after a number", "the number alone, or an expression in quotes"},
  }));
  CAPTURE(text);
  CHECK_THAT(parse_message(text), Catch::Contains(": " + what + "\n  expected  " + expected));
}

TEST_CASE("a text that is not in UTF-8 is refused with what to do", "[error]") {
  using namespace std::string_literals;
  const auto [text, encoding] = GENERATE(table<std::string, std::string>({{"\xff\xfe{\0}\0"s, "UTF-16"},
                                                                          {"\xfe\xff\0{\0}"s, "UTF-16"},
                                                                          {"{\0}\0"s, "UTF-16"},
                                                                          {"\0{\0}"s, "UTF-16"},
                                                                          {"\xff\xfe\0\0{\0\0\0"s, "UTF-32"},
                                                                          {"\0\0\xfe\xff\0\0\0{"s, "UTF-32"}}));
  CHECK(parse_message(text) == "a.json: is a text in " + encoding +
                                   "\n  expected  one in UTF-8: save it as such, or `iconv -f " + encoding +
                                   " -t UTF-8 FILE`");
}

TEST_CASE("the mark that editors put before UTF-8 is passed over", "[unit]") {
  CHECK(parse_json("\xef\xbb\xbf{\"a\": 1}", "a.json") == Json{{"a", 1}});
}

TEST_CASE("an empty text is reported as such", "[error]") {
  const std::string text = GENERATE("", " \n");
  CHECK(parse_message(text) == "a.json: empty\n  expected  a JSON document");
}

TEST_CASE("every key given twice is reported with its place", "[error]") {
  CHECK(parse_message(R"({"a": [{"b": 1}, {"b": 1, "c/d": 2, "c/d": 3}], "e": {"a": 1}, "a": 2})") ==
        "a.json: /a/1/c~1d: key given twice\na.json: /a: key given twice");
}

TEST_CASE("a text nested too deeply is refused", "[error]") {
  CHECK_THAT(parse_message(std::string(100000, '[')), Catch::Contains(": nested too deeply"));
}

TEST_CASE("keys keep the order of the text", "[unit]") {
  CHECK(parse_json(R"({"b":1,"a":2})", "a.json").dump() == R"({"b":1,"a":2})");
}

TEST_CASE("a file is read as JSON", "[unit]") {
  const Folder folder;
  std::ofstream(folder / "a.json") << R"({"a": 1})";
  CHECK(read_json(folder / "a.json") == Json{{"a", 1}});
}

TEST_CASE("a missing file is reported with its closest neighbour", "[error]") {
  const Folder folder;
  std::ofstream(folder / "dam_break.json") << "{}";
  CHECK(read_message(folder / "dam_braek.json") ==
        (folder / "dam_braek.json") + ": no such file\n  closest   \"" + (folder / "dam_break.json") + "\"");
}

TEST_CASE("a folder is not a file", "[error]") {
  const Folder folder;
  CHECK(read_message(folder / "") == folder / "" + ": is a folder\n  expected  a JSON file");
}

TEST_CASE("a file is named in its problems", "[error]") {
  const Folder folder;
  std::ofstream(folder / "a.json") << "{";
  CHECK_THAT(read_message(folder / "a.json"),
             Catch::StartsWith((folder / "a.json") + ": line 1, column 2: unexpected end of input"));
}

TEST_CASE("an assignment sets a value of any type", "[unit]") {
  const auto [assignment, result] = GENERATE(table<std::string, std::string>(
      {{R"(/a/scheme="flip")", R"({"a":{"scheme":"flip"},"l":[{"n":1}]})"},
       {"/l/0/n=3", R"({"a":{"scheme":"pic"},"l":[{"n":3}]})"},
       {"/new/deep=[1,2]", R"({"a":{"scheme":"pic"},"l":[{"n":1}],"new":{"deep":[1,2]}})"},
       {"/x~1y={\"b\": 1}", R"({"a":{"scheme":"pic"},"l":[{"n":1}],"x/y":{"b":1}})"},
       {"/a=\"p=q\"", R"({"a":"p=q","l":[{"n":1}]})"}}));
  CHECK(after_set(Json::parse(R"({"a": {"scheme": "pic"}, "l": [{"n": 1}]})"), assignment).dump() == result);
}

TEST_CASE("an assigned text without quotes is reported with the quotes it needs", "[error]") {
  CHECK(set_message(Json::object(), "/transfer/scheme=flip") ==
        "--set /transfer/scheme=flip: /transfer/scheme: not JSON\n"
        "  expected  a JSON value, text in quotes: '\"flip\"'\n"
        "  got       flip");
}

TEST_CASE("an assignment without a value is refused", "[error]") {
  CHECK(set_message(Json::object(), "/a") == "--set /a: no value\n  expected  /pointer=JSON, like /time/end=2");
}

TEST_CASE("an assignment to what is not a pointer is refused", "[error]") {
  const std::string pointer = GENERATE("", "a", "a/b", "/a~2");
  CHECK(set_message(Json::object(), pointer + "=1") == "--set " + pointer +
                                                           "=1: not a JSON pointer\n"
                                                           "  expected  /key=value, like /time/end=2\n"
                                                           "  got       \"" +
                                                           pointer + "\" (string)");
}

TEST_CASE("an assignment beyond a list is refused", "[error]") {
  const std::string index = GENERATE("2", "-", "-1", "x", "99999999999999999999");
  CHECK(set_message(Json::parse(R"({"l": [1, 2]})"), "/l/" + index + "=1") ==
        "--set /l/" + index + "=1: /l/" + index + ": no such element\n  expected  an index in [0, 1]\n  got       \"" +
            index + "\" (string)");
}

TEST_CASE("an assignment below a number is refused", "[error]") {
  CHECK(set_message(Json::parse(R"({"a": 1})"), "/a/b=2") ==
        "--set /a/b=2: /a: has no keys\n  expected  an object or a list\n  got       1 (number)");
}

TEST_CASE("a refused assignment leaves the document as it was", "[unit]") {
  Json document = Json::parse(R"({"l": []})");
  CHECK_THROWS_AS(set_value(document, "/a/b=x"), InputError);
  CHECK(document.dump() == R"({"l":[]})");
}

TEST_CASE("an unknown key that was assigned is found when the document is read", "[error]") {
  CHECK(messages(with("/fluid/viscosty=1"), read_liquid) ==
        Messages{"a.json: /fluid/viscosty: unknown key\n  got       1 (number)\n  closest   \"viscosity\""});
}
