#include "engine/input/expression.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <memory>
#include <numbers>

using namespace minamo;
using Catch::Matchers::Contains;
using Catch::Matchers::Message;

namespace {

const ExpressionScope scope{{"x", "y", "t"}, {{"H", 0.292}}};

double value_at(const std::string& text, std::vector<double> values) { return Expression(text, scope)(values); }

ExpressionError error_of(const std::string& text) {
  try {
    Expression expression(text, scope);
  } catch (const ExpressionError& error) {
    return error;
  }
  return {"no error", 0, ""};
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

}  // namespace

TEST_CASE("an expression takes its variables in the order of the scope", "[unit]") {
  CHECK(value_at("x + 10*y + 100*t", {1, 2, 3}) == 321);
}

TEST_CASE("an expression knows the constants of its scope", "[unit]") { CHECK(value_at("H*x", {2, 0, 0}) == 0.584); }

TEST_CASE("an expression knows pi", "[unit]") { CHECK(value_at("pi", {0, 0, 0}) == std::numbers::pi); }

TEST_CASE("an expression has functions, comparisons and choices", "[unit]") {
  CHECK(value_at("x >= 1 && y != 3 ? min(x, y) : sqrt(t)", {1, 2, 9}) == 1);
}

TEST_CASE("minus binds weaker than the power", "[unit]") { CHECK(value_at("-x^2", {3, 0, 0}) == -9); }

TEST_CASE("an expression without variables is constant", "[unit]") {
  const Expression two_pi("2*pi", scope);
  CHECK(two_pi.is_constant());
  CHECK(two_pi({}) == 2 * std::numbers::pi);
}

TEST_CASE("an expression with a variable is not constant", "[unit]") {
  CHECK_FALSE(Expression("0*x", scope).is_constant());
}

TEST_CASE("an expression tells which variables it uses", "[unit]") {
  const Expression expression("x*sin(t)", scope);
  CHECK(expression.uses("x"));
  CHECK(expression.uses("t"));
  CHECK_FALSE(expression.uses("y"));
  CHECK_FALSE(expression.uses("pi"));
}

TEST_CASE("a text stays as written", "[unit]") { CHECK(Expression(" 2 * x", scope).text() == " 2 * x"); }

TEST_CASE("the text of a number is the shortest that reads back to it", "[unit]") {
  const double number = GENERATE(0.0, 0.1, -9.81, 1e-300, 1.0 / 3, 5e-324, std::numeric_limits<double>::max());
  CAPTURE(number);
  const Expression expression(number);
  CHECK(std::strtod(expression.text().c_str(), nullptr) == number);
  CHECK(expression({}) == number);
}

TEST_CASE("the shortest text of 0.1 is 0.1", "[unit]") { CHECK(Expression(0.1).text() == "0.1"); }

TEST_CASE("a copy of an expression outlives the original", "[unit]") {
  auto original = std::make_unique<Expression>("x + y", scope);
  const Expression copy = *original;
  original.reset();
  CHECK(copy(std::vector<double>{1, 2, 0}) == 3);
}

TEST_CASE("an assigned expression is independent of its source", "[unit]") {
  Expression source("x", scope), target("y", scope);
  target = source;
  source = Expression("t", scope);
  CHECK(target(std::vector<double>{1, 2, 3}) == 1);
}

TEST_CASE("a moved expression keeps its value", "[unit]") {
  Expression source("x*t", scope);
  const Expression target = std::move(source);
  CHECK(target(std::vector<double>{2, 0, 3}) == 6);
}

TEST_CASE("dividing by zero gives infinity, not an error", "[unit]") { CHECK(std::isinf(value_at("1/x", {0, 0, 0}))); }

TEST_CASE("a number in an expression does not depend on the locale", "[unit]") {
  const std::locale before = std::locale::global(std::locale(std::locale(), new DecimalComma));
  const double value = value_at("1.5*x", {2, 0, 0});
  std::locale::global(before);
  CHECK(value == 3);
}

TEST_CASE("an unknown name is reported with its place", "[error]") {
  const ExpressionError error = error_of("x + foo*2");
  CHECK(error.position == 4);
  CHECK(error.token == "foo");
  CHECK(std::string(error.what()) == "unknown name \"foo\" at character 5");
}

TEST_CASE("muParser's own constants are unknown names", "[error]") {
  const std::string name = GENERATE("_pi", "_e");
  CHECK(error_of(name).token == name);
}

TEST_CASE("a text that is not an expression is refused", "[error]") {
  const std::string text = GENERATE("", " ", "x+", "(x", "x)", "2x", "x y", "sin()", "sin(x, y)", "\"x\"", "x ? 1",
                                    "1e999", "1.5.2", "x+$", "é", "max", "foo(x)");
  CAPTURE(text);
  CHECK_THROWS_AS(Expression(text, scope), ExpressionError);
}

TEST_CASE("a refused text is reported with its place within the text", "[error]") {
  const std::string text = GENERATE("", "x+", "(x", "x)", "2x", "x ? 1");
  CAPTURE(text);
  CHECK(error_of(text).position <= text.size());
}

TEST_CASE("an assignment is refused", "[error]") {
  const std::string text = GENERATE("x = 3", "x=y", "(t = 1) + t", "x += 1");
  CAPTURE(text);
  CHECK_THROWS_WITH(Expression(text, scope), Contains("assignment"));
}

TEST_CASE("a comparison is not an assignment", "[unit]") {
  const std::string text = GENERATE("x == 1", "x <= 1", "x >= 1", "x != 2");
  CAPTURE(text);
  CHECK(value_at(text, {1, 0, 0}) == 1);
}

TEST_CASE("a decimal comma is refused", "[error]") {
  CHECK_THROWS_MATCHES(Expression("1,5*x", scope), ExpressionError, Message("unexpected \",\" at character 2"));
}

TEST_CASE("a function without parenthesis is named", "[error]") {
  CHECK_THROWS_MATCHES(Expression("sin x", scope), ExpressionError,
                       Message("no parenthesis after \"sin\" at character 1"));
}

TEST_CASE("a constant that no expression can name is refused", "[error]") {
  const std::string name = GENERATE("a b", "", "2a");
  CHECK_THROWS_MATCHES(Expression("x", ExpressionScope{{"x"}, {{name, 1.0}}}), ExpressionError,
                       Message("\"" + name + "\" cannot be a name"));
}

TEST_CASE("a constant named as a variable is refused", "[error]") {
  CHECK_THROWS_MATCHES(Expression("x", ExpressionScope{{"x"}, {{"x", 1.0}}}), ExpressionError,
                       Message("\"x\" is a constant and a variable"));
}

TEST_CASE("known names are those of the scope, pi and the functions", "[unit]") {
  CHECK_THAT(known_names(scope), Catch::VectorContains(std::string("t")) && Catch::VectorContains(std::string("H")) &&
                                     Catch::VectorContains(std::string("pi")) &&
                                     Catch::VectorContains(std::string("sqrt")));
}
