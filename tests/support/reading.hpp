#pragma once
/// \file
/// Reads JSON texts with reading code of a test, and one document with a little of everything.

#include "engine/input/input.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <string>
#include <vector>

namespace minamo::reading {

using Rules = std::function<void(Input&)>;

inline const ExpressionScope place_and_time{{"x", "y", "t"}, {{"H", 0.292}}};

/// What came of a reading.
struct Reading {
  std::vector<Problem> problems;
  Json echo;
};

inline Reading read(const std::string& text, const Rules& rules) {
  const Json json = Json::parse(text);
  Input::Document document(json, "a.json");
  rules(document.root());
  document.finish();
  return {document.problems(), document.echo()};
}

inline std::vector<std::string> messages(const std::string& text, const Rules& rules) {
  std::vector<std::string> all;
  for (const Problem& problem : read(text, rules).problems) all.push_back(problem.text());
  return all;
}

using Messages = std::vector<std::string>;

/// What a reading returns; the document must be without problems.
template <class Value>
Value value_of(const std::string& text, const std::function<Value(Input&)>& rule) {
  Value value{};
  const Reading reading = read(text, [&](Input& input) { value = rule(input); });
  CHECK(reading.problems.empty());
  return value;
}

inline Json after_set(Json document, const std::string& assignment) {
  set_value(document, assignment);
  return document;
}

/// A document with a little of everything.
inline void read_liquid(Input& input) {
  input.text("title", {.doc = "title", .fallback = ""});
  input.integer("dimension", {.doc = "dimension of space", .at_least = 2, .at_most = 3});
  input.object("fluid", "the liquid", Input::Presence::optional, [](Input& fluid) {
    fluid.number("density", {.unit = "kg/m^3", .doc = "density", .above = 0});
    fluid.number("viscosity", {.unit = "Pa s", .doc = "dynamic viscosity", .fallback = 0.0, .at_least = 0});
  });
  input.list("bodies", "bodies of liquid", 1, [](Input& body, std::size_t) {
    body.one_of("its shape",
                {{"ball", [](Input& in) { in.numbers("ball", 3, {.unit = "m", .doc = "centre, radius"}); }},
                 {"where", [](Input& in) { in.text("where", {.doc = "condition"}); }}});
    body.expressions("velocity", 2, place_and_time, {.unit = "m/s", .doc = "velocity", .fallback = 0.0});
  });
  input.object("transfer", "the transfer", Input::Presence::optional, [](Input& transfer) {
    transfer.variant(
        "scheme", "name", "tpic",
        {{"flip",
          [](Input& in) { in.number("blend", {.doc = "share", .fallback = 1.0, .at_least = 0, .at_most = 1}); }},
         {"tpic", [](Input&) {}},
         {"xpic", [](Input& in) { in.integer("order", {.doc = "order", .at_least = 1}); }}});
  });
}

inline const std::string liquid = R"({"dimension": 2, "fluid": {"density": 1000},
  "bodies": [{"ball": [0, 0, 1], "velocity": ["y*t", 1.5]}, {"where": "y < 0.5"}]})";

inline std::string with(const std::string& assignment) { return after_set(Json::parse(liquid), assignment).dump(); }

}  // namespace minamo::reading
