#include <apsis/config/expression.hpp>
#include <apsis/core/suggest.hpp>

#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <muParser.h>

namespace apsis {

struct expression::impl {
  std::string text;
  source_place place;
  // The parser keeps the address of x, so both live at one address for the life of the expression.
  double x = 0.0;
  mu::Parser parser;
};

namespace {

const std::vector<std::string>& known_names() {
  static const std::vector<std::string> names = {"x",     "pi",   "e",    "sin",  "cos",  "tan", "asin",
                                                 "acos",  "atan", "sinh", "cosh", "tanh", "exp", "log",
                                                 "log10", "sqrt", "abs",  "min",  "max"};
  return names;
}

// muParser ships its own list of functions, some of which changed meaning between versions (log); this one is
// ours.
void define_language(mu::Parser& parser, double* x) {
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  using unary = double (*)(double);
  using binary = double (*)(double, double);
  const auto negate = [](double v) { return -v; };
  const auto keep = [](double v) { return v; };
  parser.DefineInfixOprt("-", unary(negate));
  parser.DefineInfixOprt("+", unary(keep));
  parser.DefineFun("sin", unary(std::sin));
  parser.DefineFun("cos", unary(std::cos));
  parser.DefineFun("tan", unary(std::tan));
  parser.DefineFun("asin", unary(std::asin));
  parser.DefineFun("acos", unary(std::acos));
  parser.DefineFun("atan", unary(std::atan));
  parser.DefineFun("sinh", unary(std::sinh));
  parser.DefineFun("cosh", unary(std::cosh));
  parser.DefineFun("tanh", unary(std::tanh));
  parser.DefineFun("exp", unary(std::exp));
  parser.DefineFun("log", unary(std::log));
  parser.DefineFun("log10", unary(std::log10));
  parser.DefineFun("sqrt", unary(std::sqrt));
  parser.DefineFun("abs", unary(std::fabs));
  parser.DefineFun("min", binary(std::fmin));
  parser.DefineFun("max", binary(std::fmax));
  parser.DefineConst("pi", std::numbers::pi);
  parser.DefineConst("e", std::numbers::e);
  parser.DefineVar("x", x);
}

source_place shifted(source_place place, std::size_t by) {
  if (place.column > 0) place.column += static_cast<int>(by);
  return place;
}

// '=' alone would assign to x; a comparison is written with two characters.
std::size_t find_assignment(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') {
      ++i;
      continue;
    }
    if (i > 0 && (text[i - 1] == '<' || text[i - 1] == '>' || text[i - 1] == '!')) continue;
    return i;
  }
  return std::string::npos;
}

[[noreturn]] void fail(const std::string& text, const source_place& place, std::size_t at,
                       const std::string& why, const std::string& advice) {
  throw input_error(shifted(place, at), fmt::format("expression '{}' cannot be used ({} at character {}) {}",
                                                    text, why, at + 1, advice));
}

void check_characters(const std::string& text, const source_place& place) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    throw input_error(place,
                      "expression is empty (a number or a formula in x is needed) write for example 1e-3");
  if (text.size() > expression::longest)
    throw input_error(place, fmt::format("expression has {} characters (at most {} are read) shorten it",
                                         text.size(), expression::longest));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 32 && c != '\t') || c > 126)
      throw input_error(shifted(place, i),
                        fmt::format("expression has the byte 0x{:02x} at character {} (formulas are "
                                    "plain ASCII) remove it",
                                    c, i + 1));
    if (c == '"') fail(text, place, i, "a quotation mark", "formulas have no strings");
  }
  const std::size_t assignment = find_assignment(text);
  if (assignment != std::string::npos) fail(text, place, assignment, "an assignment", "use == to compare");
}

std::string explain(const mu::ParserError& e) {
  switch (e.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      return fmt::format("unknown name '{}'", e.GetToken());
    case mu::ecUNEXPECTED_EOF:
      return "it ends too early";
    case mu::ecMISSING_PARENS:
      return "missing parenthesis";
    case mu::ecUNEXPECTED_PARENS:
      return "unexpected parenthesis";
    case mu::ecUNEXPECTED_OPERATOR:
      return fmt::format("unexpected operator '{}'", e.GetToken());
    case mu::ecUNEXPECTED_VAL:
      return fmt::format("unexpected number '{}'", e.GetToken());
    case mu::ecUNEXPECTED_VAR:
      return fmt::format("unexpected variable '{}'", e.GetToken());
    case mu::ecUNEXPECTED_FUN:
      return fmt::format("unexpected function '{}'", e.GetToken());
    case mu::ecUNEXPECTED_ARG_SEP:
      return "unexpected comma";
    case mu::ecTOO_MANY_PARAMS:
      return fmt::format("too many arguments of '{}'", e.GetToken());
    case mu::ecTOO_FEW_PARAMS:
      return fmt::format("too few arguments of '{}'", e.GetToken());
    default:
      return e.GetMsg();
  }
}

}  // namespace

expression::expression(std::string text, source_place place) : impl_(std::make_unique<impl>()) {
  check_characters(text, place);
  impl_->text = std::move(text);
  impl_->place = std::move(place);
  try {
    define_language(impl_->parser, &impl_->x);
    impl_->parser.SetExpr(impl_->text);
    impl_->parser.Eval();
  } catch (const mu::ParserError& e) {
    const bool unknown = e.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
    // muParser reports the end of some tokens and the start of others; an unknown name is found again in the
    // text.
    std::size_t at = e.GetPos() >= 0 ? static_cast<std::size_t>(e.GetPos()) : 0;
    if (unknown && impl_->text.rfind(e.GetToken(), at) != std::string::npos)
      at = impl_->text.rfind(e.GetToken(), at);
    at = std::min(at, impl_->text.size() - 1);
    fail(impl_->text, impl_->place, at, explain(e),
         unknown ? suggest(e.GetToken(), known_names()) : "check the formula");
  }
  if (impl_->parser.GetNumResults() != 1)
    fail(impl_->text, impl_->place, impl_->text.find(','), "a comma outside a function", "write one formula");
}

expression::~expression() = default;
expression::expression(expression&&) noexcept = default;
expression& expression::operator=(expression&&) noexcept = default;

double expression::evaluate(double x) const {
  impl_->x = x;
  double value = 0.0;
  try {
    value = impl_->parser.Eval();
  } catch (const mu::ParserError& e) {
    fail(impl_->text, impl_->place, 0, e.GetMsg(), "check the formula");
  }
  if (!std::isfinite(value) || value < 0.0)
    throw input_error(
        impl_->place,
        fmt::format("expression '{}' is {} at x = {:.10g} (it must be finite and not negative) change the "
                    "formula or the domain",
                    impl_->text, value, x));
  return value;
}

const std::string& expression::text() const {
  return impl_->text;
}

bool expression::depends_on_x() const {
  return !impl_->parser.GetUsedVar().empty();
}

}  // namespace apsis
