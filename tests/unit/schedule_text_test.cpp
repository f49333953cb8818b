#include "engine/schedule/schedule.hpp"

#include "support/rows.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace minamo;
using namespace minamo::rows;

namespace {

struct Scale {
  double value = 1;
  static constexpr ComponentInfo info{"scale", "k", "m", Lifetime::constant};
};

struct Lengthen {
  void operator()(Resize<Rows>) const {}
};
struct Differentiate {
  void operator()(Read<Height>, Read<Scale>, Write<Slope>) const {}
};
struct Smooth {
  void operator()(Read<Slope>, Update<Height>) const {}
};

std::vector<System> three_systems() {
  return {make_system<Lengthen>("grow"), make_system<Differentiate>("differentiate"), make_system<Smooth>("smooth")};
}

nlohmann::json three_systems_as_json() { return nlohmann::json::parse(to_json(three_systems(), "three")); }

}  // namespace

TEST_CASE("the dot text has a box per system and an edge per dependence", "[unit]") {
  const std::string dot = to_dot(three_systems(), "three");
  CHECK_THAT(dot, Catch::StartsWith("digraph \"three\" {") && Catch::EndsWith("}\n"));
  CHECK_THAT(dot, Catch::Contains("<b>grow</b>") && Catch::Contains("<b>differentiate</b>") &&
                      Catch::Contains("<b>smooth</b>"));
  CHECK_THAT(dot, Catch::Contains("s0 -> s1 [label=\"row\"];"));
  CHECK_THAT(dot, Catch::Contains("s1 -> s2 [label=\"row.height\nrow.slope\"];"));
  CHECK_THAT(dot, !Catch::Contains("s0 -> s2"));
}

TEST_CASE("the dot text tells the lifetimes apart by colour", "[unit]") {
  const std::string dot = to_dot(three_systems(), "three");
  CHECK_THAT(dot, Catch::Contains("read <font color=\"#2166ac\">row.height</font>"));
  CHECK_THAT(dot, Catch::Contains("read <font color=\"#1b7837\">scale</font>"));
  CHECK_THAT(dot, Catch::Contains("write <font color=\"#666666\">row.slope</font>"));
}

TEST_CASE("names with characters of the dot language are escaped", "[unit]") {
  const std::string dot = to_dot(std::vector{make_system<Lengthen>("a<b>&\"c\"")}, "say \"three\"");
  CHECK_THAT(dot, Catch::Contains("<b>a&lt;b&gt;&amp;&quot;c&quot;</b>"));
  CHECK_THAT(dot, Catch::StartsWith("digraph \"say \\\"three\\\"\" {"));
}

TEST_CASE("the JSON text states every access of a system", "[unit]") {
  const nlohmann::json expected = {
      {{"mode", "read"}, {"component", "row.height"}, {"table", "row"}, {"unit", "m"}, {"lifetime", "state"}},
      {{"mode", "read"}, {"component", "scale"}, {"table", nullptr}, {"unit", "m"}, {"lifetime", "constant"}},
      {{"mode", "write"}, {"component", "row.slope"}, {"table", "row"}, {"unit", "1"}, {"lifetime", "scratch"}}};
  CHECK(three_systems_as_json().at("systems").at(1).at("access") == expected);
}

TEST_CASE("the JSON text states a resize as a table without component", "[unit]") {
  const nlohmann::json expected = {
      {{"mode", "resize"}, {"component", nullptr}, {"table", "row"}, {"unit", nullptr}, {"lifetime", nullptr}}};
  CHECK(three_systems_as_json().at("systems").at(0).at("access") == expected);
}

TEST_CASE("the JSON text has the edges with the components that cause them", "[unit]") {
  const nlohmann::json expected = {{{"from", 0}, {"to", 1}, {"components", {"row"}}},
                                   {{"from", 1}, {"to", 2}, {"components", {"row.height", "row.slope"}}}};
  CHECK(three_systems_as_json().at("edges") == expected);
}

TEST_CASE("the JSON text of an empty list has empty arrays", "[unit]") {
  const auto json = nlohmann::json::parse(to_json({}, "none"));
  CHECK(json.at("title") == "none");
  CHECK(json.at("systems") == nlohmann::json::array());
  CHECK(json.at("edges") == nlohmann::json::array());
}
