#include <apsis/model/expression.hpp>

#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <muParser.h>

namespace apsis {

namespace {

std::vector<std::string> known_names(const std::string& variable) {
  return {variable, "pi",   "e",   "sin", "cos",   "tan",  "asin", "acos", "atan", "sinh",
          "cosh",   "tanh", "exp", "log", "log10", "sqrt", "abs",  "min",  "max"};
}

// muParser ships its own list of functions, some of which changed meaning between versions (log); this one is
// ours.
void define_language(mu::Parser& parser, const std::string& variable, double* x) {
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
  parser.DefineVar(variable, x);
}

source_place shifted(source_place place, std::size_t by) {
  if (place.column > 0) place.column += static_cast<int>(by);
  return place;
}

// '=' alone would assign to the variable; a comparison is written with two characters.
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

/// At most 60 characters, from around the one that matters.
std::string excerpt(const std::string& text, std::size_t at) {
  constexpr std::size_t longest = 60;
  if (text.size() <= longest) return text;
  const std::size_t begin = at < longest / 2 ? 0 : std::min(at - longest / 2, text.size() - longest);
  return (begin > 0 ? "..." : "") + text.substr(begin, longest) +
         (begin + longest < text.size() ? "..." : "");
}

[[noreturn]] void fail(const std::string& text, const source_place& place, std::size_t at,
                       const std::string& why, const std::string& advice) {
  throw input_error(shifted(place, at), fmt::format("expression '{}' cannot be used ({} at character {}); {}",
                                                    excerpt(text, at), why, at + 1, advice));
}

void check_characters(const std::string& text, const source_place& place, const std::string& variable) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    throw input_error(
        place,
        fmt::format("expression is empty (a number or a formula in {} is needed); write for example 1e-3",
                    variable));
  if (text.size() > expression::longest)
    throw input_error(place, fmt::format("expression has {} characters (at most {} are read); shorten it",
                                         text.size(), expression::longest));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 32 && c != '\t') || c > 126)
      throw input_error(
          shifted(place, i),
          fmt::format(
              "expression has the byte 0x{:02x} at character {} (formulas are plain ASCII); remove it", c,
              i + 1));
    if (c == '"') fail(text, place, i, "a quotation mark", "formulas have no strings");
  }
  const std::size_t assignment = find_assignment(text);
  if (assignment != std::string::npos) fail(text, place, assignment, "an assignment", "use == to compare");
}

std::string explain(const mu::ParserError& e) {
  switch (e.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      return fmt::format("unknown name '{:.60}'", e.GetToken());
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

/// A parser and its variable. The parser keeps the address of x and scratch space, so one thread at a time.
struct machine {
  double x = 0.0;
  mu::Parser parser;

  machine(const std::string& text, const std::string& variable) {
    define_language(parser, variable, &x);
    parser.SetExpr(text);
  }
  double run(double at) {
    x = at;
    return parser.Eval();
  }
};

/// Machines for one formula, each in the hands of one thread at a time. A thread comes back to the same slot,
/// so nobody waits unless there are more threads than slots.
class parser_pool {
 public:
  parser_pool(const std::string& text, const std::string& variable) : text_(text), variable_(variable) {
    slots_.front().own = std::make_unique<machine>(text, variable);
  }

  /// For the constructor of an expression, which is alone.
  mu::Parser& first() { return slots_.front().own->parser; }

  double run(double x) {
    slot& mine = take();
    const release_at_exit release{mine};
    if (!mine.own) mine.own = std::make_unique<machine>(text_, variable_);
    return mine.own->run(x);
  }

 private:
  struct alignas(64) slot {  // threads side by side do not share a cache line
    std::atomic_flag taken = ATOMIC_FLAG_INIT;
    std::unique_ptr<machine> own;
  };
  struct release_at_exit {
    slot& held;
    ~release_at_exit() { held.taken.clear(std::memory_order_release); }
  };

  slot& take() {
    static std::atomic<std::size_t> threads_seen{0};
    thread_local const std::size_t home = threads_seen++;
    for (std::size_t k = home;; ++k) {
      slot& candidate = slots_[k % slots_.size()];
      if (!candidate.taken.test_and_set(std::memory_order_acquire)) return candidate;
    }
  }

  std::string text_, variable_;
  std::array<slot, 64> slots_;
};

}  // namespace

struct expression::impl {
  impl(const std::string& words, source_place where, formula_kind what)
      : text(words), place(std::move(where)), kind(std::move(what)), machines(text, kind.variable) {}

  std::string text;
  source_place place;
  formula_kind kind;
  parser_pool machines;
};

expression::expression(const std::string& text, const source_place& place, const formula_kind& kind) {
  check_characters(text, place, kind.variable);
  try {
    impl_ = std::make_unique<impl>(text, place, kind);
    impl_->machines.first().Eval();
  } catch (const mu::ParserError& e) {
    const bool unknown = e.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
    // muParser reports the end of some tokens and the start of others; an unknown name is found again in the
    // text.
    std::size_t at = e.GetPos() >= 0 ? static_cast<std::size_t>(e.GetPos()) : 0;
    if (unknown && text.rfind(e.GetToken(), at) != std::string::npos) at = text.rfind(e.GetToken(), at);
    at = std::min(at, text.size() - 1);
    fail(text, place, at, explain(e),
         unknown ? suggest(e.GetToken(), known_names(kind.variable)) : "check the formula");
  }
  if (impl_->machines.first().GetNumResults() != 1)
    fail(text, place, text.find(','), "a comma outside a function", "write one formula");
}

expression::~expression() = default;
expression::expression(expression&&) noexcept = default;
expression& expression::operator=(expression&&) noexcept = default;

double expression::value(double x) const {
  try {
    return impl_->machines.run(x);
  } catch (const mu::ParserError& e) {
    fail(impl_->text, impl_->place, 0, e.GetMsg(), "check the formula");
  }
}

double expression::evaluate(double x) const {
  const double result = value(x);
  if (!std::isfinite(result) || (impl_->kind.nonnegative && result < 0.0))
    throw input_error(
        impl_->place,
        fmt::format(
            "expression '{}' is {} at {} = {:.10g} (it must be finite{}); change the formula or the domain",
            excerpt(impl_->text, 0), result, impl_->kind.variable, x,
            impl_->kind.nonnegative ? " and not negative" : ""));
  return result;
}

const std::string& expression::text() const {
  return impl_->text;
}

bool expression::is_constant() const {
  return impl_->machines.first().GetUsedVar().empty();
}

}  // namespace apsis
