#include "engine/input/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <charconv>
#include <numbers>
#include <optional>
#include <set>

namespace minamo {

namespace {

std::string shortest(double value) {
  std::array<char, 32> digits{};  // the longest shortest form, "-2.2250738585072014e-308", has 24
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

[[noreturn]] void fail(const std::string& reason, std::size_t position, const std::string& unknown = {}) {
  throw ExpressionError(reason + " at character " + std::to_string(position + 1), position, unknown);
}

bool is_name(const std::string& token) {
  return !token.empty() && (std::isalpha(static_cast<unsigned char>(token.front())) != 0 || token.front() == '_');
}

/// muParser's reason, in lower case and without its count of characters, which starts at 0.
std::string reason_of(const mu::ParserError& error) {
  std::string reason = error.GetMsg();
  for (const char* place : {" found at position", " at position", " at expression position"})
    if (const auto at = reason.find(place); at != std::string::npos) reason.erase(at);
  while (!reason.empty() && (reason.back() == '.' || reason.back() == '!')) reason.pop_back();
  if (!reason.empty()) reason.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(reason.front())));
  return reason;
}

[[noreturn]] void fail(const mu::ParserError& error, const std::string& text) {
  const int at = error.GetPos();
  const std::size_t position = at < 0 ? text.size() : std::min(static_cast<std::size_t>(at), text.size());
  std::string token = error.GetToken();
  token.erase(token.find_last_not_of(' ') + 1);
  if (error.GetCode() != mu::ecUNASSIGNABLE_TOKEN) fail(reason_of(error), position);
  if (!is_name(token)) fail("unexpected \"" + token + "\"", position);
  if (mu::Parser().GetFunDef().contains(token)) fail("no parenthesis after \"" + token + "\"", position);
  fail("unknown name \"" + token + "\"", position, token);
}

/// Gives a parser the names of a scope and pi; it reads the variables from `values`.
void define(mu::Parser& parser, const ExpressionScope& scope, std::vector<double>& values) {
  std::string name = "pi";
  try {
    parser.ClearConst();  // muParser's own are _pi and _e
    parser.DefineConst(name, std::numbers::pi);
    for (const auto& constant : scope.constants) parser.DefineConst(name = constant.first, constant.second);
    for (std::size_t i = 0; i < values.size(); ++i) parser.DefineVar(name = scope.variables[i], &values[i]);
  } catch (const mu::ParserError&) {
    const bool taken = scope.constants.contains(name) && std::ranges::count(scope.variables, name) > 0;
    throw ExpressionError("\"" + name + (taken ? "\" is a constant and a variable" : "\" cannot be a name"), 0, {});
  }
}

/// An expression is a value: muParser's `x = 3` would change the variable for the next call.
void refuse_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool ends_comparison = i > 0 && std::string_view("<>!=").find(text[i - 1]) != std::string_view::npos;
    const bool begins_comparison = i + 1 < text.size() && text[i + 1] == '=';
    if (!ends_comparison && !begins_comparison) fail("assignment", i);
  }
}

/// muParser takes `1, 2` for two values and returns the last; so a decimal comma would be lost silently.
void refuse_list(const std::string& text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')') --depth;
    if (text[i] == ',' && depth == 0) fail("unexpected \",\"", i);
  }
}

}  // namespace

struct Expression::Impl {
  ExpressionScope scope;
  std::set<std::string, std::less<>> used;
  std::optional<double> constant;
  std::vector<double> values;  // muParser keeps pointers to these
  mu::Parser parser;

  Impl(const std::string& text, ExpressionScope names);
};

Expression::Impl::Impl(const std::string& text, ExpressionScope names)
    : scope(std::move(names)), values(scope.variables.size()) {
  try {
    define(parser, scope, values);
    refuse_assignment(text);
    parser.SetExpr(text);
    const double value = parser.Eval();
    if (parser.GetNumResults() > 1) refuse_list(text);
    for (const auto& [name, address] : parser.GetUsedVar()) used.insert(name);
    if (used.empty()) constant = value;
  } catch (const mu::ParserError& error) {
    fail(error, text);
  }
}

std::vector<std::string> known_names(const ExpressionScope& scope) {
  std::vector<std::string> names = scope.variables;
  for (const auto& [name, value] : scope.constants) names.push_back(name);
  names.emplace_back("pi");
  const mu::Parser parser;
  for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
  return names;
}

Expression::Expression(double value) : number_(value), text_(shortest(value)) {}

Expression::Expression(const std::string& text, const ExpressionScope& scope)
    : text_(text), impl_(std::make_unique<Impl>(text, scope)) {
  if (impl_->constant) {
    number_ = *impl_->constant;
    impl_.reset();
  }
}

Expression::Expression(const Expression& other)
    : number_(other.number_),
      text_(other.text_),
      impl_(other.impl_ ? std::make_unique<Impl>(other.text_, other.impl_->scope) : nullptr) {}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

Expression& Expression::operator=(const Expression& other) { return *this = Expression(other); }

double Expression::operator()(std::span<const double> values) const {
  if (!impl_) return number_;
  assert(values.size() == impl_->values.size());
  std::copy(values.begin(), values.end(), impl_->values.begin());
  return impl_->parser.Eval();
}

bool Expression::is_constant() const { return !impl_; }

bool Expression::uses(std::string_view variable) const { return impl_ && impl_->used.contains(variable); }

const std::string& Expression::text() const { return text_; }

}  // namespace minamo
