#include "subdomain_solver/make/expression.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <muParser.h>

#include "base/error.hpp"

namespace abut {

namespace {

/// The parser with the variables that it refers to.
struct Formula {
  explicit Formula(const std::string& text) {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    parser.DefineVar("t", &t);
    parser.DefineConst("pi", std::numbers::pi);
    parser.SetExpr(text);
    parser.Eval();  // reads it
  }
  Formula(const Formula&) = delete;
  Formula& operator=(const Formula&) = delete;

  mu::Parser parser;
  double x = 0.0, y = 0.0, z = 0.0, t = 0.0;
};

/// Whether a formula sets a variable: the parser's '=', where people mean '=='.
bool assigns(const std::string& text) {
  for (std::size_t i = text.find('='); i != std::string::npos; i = text.find('=', i)) {
    const std::size_t end = std::min(text.find_first_not_of('=', i), text.size());
    const bool alone = end == i + 1;
    if (alone && (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos)) return true;
    i = end;
  }
  return false;
}

/// Whether a comma stands outside of a function's arguments, where the parser takes what follows it
/// for the formula's value.
bool has_loose_comma(const std::string& text) {
  std::vector<bool> is_call;
  char before = ' ';
  for (const char letter : text) {
    if (letter == '(') is_call.push_back(std::isalnum(static_cast<unsigned char>(before)) != 0);
    if (letter == ')' && !is_call.empty()) is_call.pop_back();
    if (letter == ',' && (is_call.empty() || !is_call.back())) return true;
    if (letter != ' ') before = letter;
  }
  return false;
}

/// A formula without places, worked out once at every time.
std::function<double(const std::array<double, 3>&, double)> uniform(
    std::shared_ptr<Formula> formula) {
  formula->x = formula->y = formula->z = 0.0;
  return [formula = std::move(formula), known = false, of = 0.0, value = 0.0](
             const std::array<double, 3>&, double time) mutable {
    if (known && time == of) return value;
    known = true;
    of = formula->t = time;
    return value = formula->parser.Eval();
  };
}

}  // namespace

std::function<double(const std::array<double, 3>&, double)> expression(const std::string& text,
                                                                       const std::string& where) {
  if (assigns(text)) {
    throw InputError(fmt::format("'{}' sets a variable", text), where,
                     "Compare with ==, or leave the = out.");
  }
  if (has_loose_comma(text)) {
    throw InputError(fmt::format("'{}' has a comma that separates no arguments", text), where,
                     "Write decimals with a point: 0.5, not 0,5.");
  }
  try {
    std::shared_ptr<Formula> formula = std::make_shared<Formula>(text);  // std::function copies
    const auto& used = formula->parser.GetUsedVar();
    // What is the same everywhere is asked for at every node of every step.
    if (!used.contains("x") && !used.contains("y") && !used.contains("z")) return uniform(formula);
    return [formula](const std::array<double, 3>& at, double time) {
      formula->x = at[0];
      formula->y = at[1];
      formula->z = at[2];
      formula->t = time;
      return formula->parser.Eval();
    };
  } catch (const mu::Parser::exception_type& error) {
    std::string why = error.GetMsg();
    while (why.ends_with('.')) why.pop_back();
    throw InputError(fmt::format("'{}' cannot be read as an expression: {}", text, why), where,
                     "Write it with numbers, without units, in those of the scene, with x, y, z, "
                     "t, pi, + - * / ^ and functions such as sin.");
  }
}

}  // namespace abut
