/// \file
/// Files that are no scene, or one in an odd shape: refused at once with one message, or read.

#include "engine/input/input_text.hpp"
#include "support/program_output.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

#include <sys/stat.h>

using namespace minamo;

namespace {

namespace fs = std::filesystem;

const std::string small_scene = R"({"dimension": 2, "grid": {"low": [0, 0], "high": [1, 1], "cells": [8, 8]},
  "fluid": {"density": 1000, "viscosity": 0}, "particles": [{"shape": {"box": {"low": [0, 0], "high": [0.5, 0.5]}}}],
  "time": {"end": 0.02, "step": 0.01}})";

std::string with(std::string text, const std::string& part, const std::string& other) {
  return text.replace(text.find(part), part.size(), other);
}

std::string repeated(const std::string& part, std::size_t times) {
  std::string text;
  for (std::size_t k = 0; k < times; ++k) text += part;
  return text;
}

/// What `minamo check` makes of a file with this text.
ProgramOutput check_text(const std::string& text) {
  const Folder folder;
  std::ofstream(folder / "a.json", std::ios::binary) << text;
  return output_of_program(folder / "", {"check", "a.json"});
}

void check_refused(const ProgramOutput& check, const std::string& message) {
  CHECK(check.err == message);
  CHECK(check.code == 2);
  CHECK(check.out.empty());
}

/// For its lifetime the process has the rights of nobody, if it had those of root.
class AsNobody {
 public:
  AsNobody() : user_(geteuid()) {
    constexpr uid_t nobody = 65534;
    if (user_ == 0 && seteuid(nobody) != 0) throw std::runtime_error("cannot become nobody");
  }
  ~AsNobody() {
    if (seteuid(user_) != 0) std::abort();
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;

 private:
  uid_t user_;
};

}  // namespace

TEST_CASE("what is no file is refused without reading it", "[error]") {
  const Folder folder;
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  fs::create_directory(folder / "folder");
  fs::create_symlink("nothing", folder / "link");
  const auto [path, message] = GENERATE(table<std::string, std::string>({
      {"pipe", "pipe: is a pipe\n  expected  a JSON file\n"},
      {"folder", "folder: is a folder\n  expected  a JSON file\n"},
      {"/dev/zero", "/dev/zero: is a device\n  expected  a JSON file\n"},
      {"link", "link: no such file\n"},
      {"missing", "missing: no such file\n"},
  }));
  CAPTURE(path);
  check_refused(output_of_program(folder / "", {"check", path}), message);
}

TEST_CASE("a file that may not be read is refused with the reason", "[error]") {
  const Folder folder;
  const std::string path = folder / "closed.json";
  std::ofstream(path) << small_scene;
  fs::permissions(folder / "", fs::perms::all);
  fs::permissions(path, fs::perms::none);
  const AsNobody rights;
  CHECK_THROWS_WITH(read_json(path), path + ": cannot be read: Permission denied");
}

TEST_CASE("a file of a gigabyte is refused without reading it", "[error]") {
  const Folder folder;
  std::ofstream(folder / "a.json") << small_scene;
  fs::resize_file(folder / "a.json", 1'000'000'000);
  check_refused(output_of_program(folder / "", {"check", "a.json"}),
                "a.json: too large\n  expected  at most 16 MB\n  got       1000 MB\n");
}

TEST_CASE("a document that is too deep, too wide or too long is refused", "[error]") {
  const auto [text, message] = GENERATE_COPY(table<std::string, std::string>({
      {repeated("[", 100000), "a.json: nested too deeply\n  expected  at most 100 levels\n"},
      {repeated(R"({"a":)", 100000), "a.json: nested too deeply\n  expected  at most 100 levels\n"},
      {R"({"probes": [)" + repeated("0,", 100000) + "0]}",
       "a.json: /probes: too long\n  expected  a list of at most 10000\n"},
      {R"({"constants": {)" +
           [] {
             std::string keys;
             for (int k = 0; k < 2000; ++k) keys += "\"a" + std::to_string(k) + "\":0,";
             return keys;
           }() +
           R"("b":0}})",
       "a.json: /constants: too many keys\n  expected  at most 1000 of an object\n"},
  }));
  check_refused(check_text(text), message);
}

TEST_CASE("a number that no double holds is refused", "[error]") {
  const auto [number, message] = GENERATE_COPY(table<std::string, std::string>({
      {"1e400", "a.json: line 2, column 26: number too large\n"
                "  got       \"fluid\": {\"density\": 1e400}}\n"},
      {repeated("9", 400), "a.json: line 2, column 421: number too large\n"},
      {"1e-400", "a.json: /fluid/density: out of range\n  expected  a number > 0 [kg/m^3]\n  got       0.0 (number)\n"},
  }));
  const ProgramOutput check = check_text("{\"dimension\": 2,\n\"fluid\": {\"density\": " + number + "}}");
  CAPTURE(number);
  CHECK_THAT(check.err, Catch::Contains(message));
  CHECK(check.code == 2);
}

TEST_CASE("a text in the wrong encoding is refused, and shown as a terminal can show it", "[error]") {
  const std::string nul(1, '\0');
  const auto [text, message] = GENERATE_COPY(table<std::string, std::string>({
      {"{\"title\": \"\xff\"}", "a.json: line 1, column 12: invalid string: ill-formed UTF-8 byte\n"
                                "  expected  text in UTF-8: save it as such, or `iconv -f LATIN1 -t UTF-8 FILE`\n"},
      {"{\"dimension\": 2 \xff}", "a.json: line 1, column 17: invalid literal\n"
                                  "  expected  '}'\n"
                                  "  got       {\"dimension\": 2 \xef\xbf\xbd}\n"},
      {"{\"dimension\": 2" + nul + "}", "a.json: line 1, column 16: unexpected NUL byte\n"
                                        "  expected  '}'\n"
                                        "  got       {\"dimension\": 2\\u0000}\n"},
      {"\x1b[31m", "a.json: line 1, column 1: invalid literal\n"
                   "  got       \\u001b[31m\n"},
      {R"([{"\u001b[31m": 2}])", "a.json: wrong type\n"
                                 "  expected  an object\n"
                                 "  got       [{\"\\u001b[31m\":2}] (list)\n"},
      {R"({"\u001b": 1, "\u001b": 2})", "a.json: /\\u001b: key given twice\n"},
      {"\xef\xbb\xbf", "a.json: empty\n  expected  a JSON document\n"},
      {"", "a.json: empty\n  expected  a JSON document\n"},
      {"\r\n\r\n", "a.json: empty\n  expected  a JSON document\n"},
      {"{\r\n\"dimension\": 2,\r\n}",
       "a.json: line 3, column 1: a comma before '}'\n  expected  none after the last key, in line 2\n  got       }\n"},
  }));
  CAPTURE(text);
  const ProgramOutput check = check_text(text);
  CHECK_THAT(check.err, Catch::StartsWith(message));
  CHECK(check.code == 2);
}

TEST_CASE("a scene with a byte order mark or with line ends of Windows is read", "[error]") {
  const std::string text = GENERATE("\xef\xbb\xbf" + small_scene, with(small_scene, ",\n", ",\r\n"));
  const ProgramOutput check = check_text(text);
  CHECK(check.err.empty());
  CHECK_THAT(check.out, Catch::StartsWith("a.json: valid, 144 particles\n"));
  CHECK(check.code == 0);
}
