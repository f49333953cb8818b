#pragma once
/// \file
/// An arithmetic expression in named variables, compiled once. muParser behind one class.

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace minamo {

/// What is wrong with an expression, and where.
class ExpressionError : public std::runtime_error {
 public:
  /// With the place of the fault, and the name that is not known.
  ExpressionError(const std::string& what, std::size_t at, std::string unknown)
      : std::runtime_error(what), position(at), token(std::move(unknown)) {}
  std::size_t position;  ///< of the first character at fault
  std::string token;     ///< the unknown name, or empty
};

/// Names an expression may use.
struct ExpressionScope {
  std::vector<std::string> variables;       ///< in the order of the values given to evaluate()
  std::map<std::string, double> constants;  ///< `pi` is always there; a constant may not be named as a variable
};

/// Every name an expression of this scope may use, functions included.
std::vector<std::string> known_names(const ExpressionScope& scope);

/// A number, or a formula in variables as scenes have them, like `0.1*sin(2*pi*t)`.
class Expression {
 public:
  /// A constant.
  explicit Expression(double value = 0);
  /// \throws ExpressionError if the text does not parse or names something outside the scope.
  Expression(const std::string& text, const ExpressionScope& scope);
  Expression(const Expression&);                 ///< a copy of its own
  Expression(Expression&&) noexcept;             ///< takes it over
  Expression& operator=(const Expression&);      ///< a copy of its own
  Expression& operator=(Expression&&) noexcept;  ///< takes it over
  ~Expression();

  /// The value at `values`, one per variable of the scope; a constant needs none. The result may be inf or NaN (1/0,
  /// sqrt(-1)). Not thread safe on one object; copies are independent.
  double operator()(std::span<const double> values) const;

  /// Whether the value is the same for all variables: a number, or a text that uses constants only.
  bool is_constant() const;
  /// Whether the text uses this variable.
  bool uses(std::string_view variable) const;
  /// As written; a constant in shortest round-trip form.
  const std::string& text() const;

 private:
  struct Impl;
  double number_ = 0;
  std::string text_;
  std::unique_ptr<Impl> impl_;  // none: the constant number_
};

}  // namespace minamo
