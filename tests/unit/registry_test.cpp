#include "support/scene_run.hpp"

#include "engine/schedule/registry.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace minamo;

namespace {

struct Count {
  int dimension = 0;
  int option = 0;
  static constexpr ComponentInfo info{"count", "n", "1", Lifetime::state};
};

template <int Dim>
struct NoteDimension {
  static constexpr std::string_view doc = "(E0)  n = Dim.";
  void operator()(Write<Count> n) const { n->dimension = Dim; }
};

template <int Dim>
struct WithOptions {
  int option = 1;
  WithOptions() = default;
  explicit WithOptions(Input&) : option(2) {}
  void operator()(Write<Count> n) const { n->option = option; }
};

SystemRegistry two_systems() {
  SystemRegistry registry;
  registry.add<WithOptions>("with_options");
  registry.add<NoteDimension>("note_dimension");
  return registry;
}

}  // namespace

TEST_CASE("a registered system is made for the dimension asked for", "[unit]") {
  const int dimension = GENERATE(2, 3);
  CAPTURE(dimension);
  World world;
  two_systems().make("note_dimension", dimension).run(world);
  CHECK(world.resource<Count>().dimension == dimension);
}

TEST_CASE("a made system has the name it was registered under", "[unit]") {
  CHECK(two_systems().make("note_dimension", 2).name == "note_dimension");
}

TEST_CASE("a system made without options has its defaults", "[unit]") {
  World world;
  two_systems().make("with_options", 2).run(world);
  CHECK(world.resource<Count>().option == 1);
}

TEST_CASE("a doc knows the file that it stands in", "[unit]") {
  constexpr Doc doc = "(E0)  n = Dim.";
  CHECK(doc.text == "(E0)  n = Dim.");
  CHECK(doc.file.ends_with("tests/unit/registry_test.cpp"));
}

TEST_CASE("systems that are built in tell the file that declares them", "[unit]") {
  for (const auto& [name, entry] : scene_run::registry().entries()) {
    CAPTURE(name, entry.file);
    CHECK(std::filesystem::exists(std::filesystem::path(MINAMO_SOURCE_DIR) / entry.file));
    CHECK(entry.file.starts_with("systems/"));
  }
  CHECK(two_systems().entries().at("note_dimension").file.empty());
}

TEST_CASE("the doc line of a kernel is kept", "[unit]") {
  CHECK(two_systems().entries().at("note_dimension").doc == "(E0)  n = Dim.");
  CHECK(two_systems().entries().at("with_options").doc.empty());
}

TEST_CASE("registered names are listed in alphabetical order", "[unit]") {
  CHECK(two_systems().names() == std::vector<std::string>{"note_dimension", "with_options"});
}

TEST_CASE("a registry contains what was added and nothing else", "[unit]") {
  CHECK(two_systems().contains("with_options"));
  CHECK_FALSE(two_systems().contains("with_option"));
}

namespace {

struct Drink {
  std::string name;
  int spoons = 0;
};
struct Tool {
  std::string name;
};

}  // namespace

TEST_CASE("what is chosen by name is kept by its type, in alphabetical order", "[unit]") {
  SystemRegistry registry = two_systems();
  registry.add(Drink{"tea", 2});
  registry.add(Drink{"coffee", 3});
  registry.add(Tool{"tea"});
  const auto& recipes = registry.choices<Drink>();
  CHECK(recipes.size() == 2);
  CHECK(recipes.begin()->first == "coffee");
  CHECK(recipes.at("tea").spoons == 2);
  CHECK(registry.choices<Tool>().size() == 1);
  CHECK(registry.names().size() == 2);
}

TEST_CASE("there are no choices of a type of which none was added", "[unit]") {
  CHECK(two_systems().choices<Drink>().empty());
}

TEST_CASE("a choice cannot be added twice, and the first one stays", "[unit][error]") {
  SystemRegistry registry;
  registry.add(Drink{"tea", 2});
  CHECK_THROWS_WITH(registry.add(Drink{"tea", 3}), "\"tea\" is registered twice");
  CHECK(registry.choices<Drink>().at("tea").spoons == 2);
}

TEST_CASE("an unknown name is answered with the known ones and the closest", "[unit][error]") {
  CHECK_THROWS_AS(two_systems().make("with_option", 2), std::out_of_range);
  CHECK_THROWS_WITH(two_systems().make("with_option", 2),
                    Catch::StartsWith("unknown system\n  expected  one of [\"note_dimension\",") &&
                        Catch::Contains("got       \"with_option\"") && Catch::EndsWith("closest   \"with_options\""));
}

TEST_CASE("a name cannot be registered twice", "[unit][error]") {
  SystemRegistry registry = two_systems();
  CHECK_THROWS_AS(registry.add<NoteDimension>("with_options"), std::logic_error);
  CHECK_THROWS_WITH(registry.add<NoteDimension>("with_options"), "system \"with_options\" is registered twice");
}
