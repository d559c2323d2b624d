#include <apsis/model/expression.hpp>

#include <apsis/core/construction_count.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/formula_table.hpp>
#include <apsis/model/internal/formula_language.hpp>
#include <apsis/model/internal/formula_tape.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

namespace apsis {

namespace {

std::vector<std::string> known_names(const formula_kind& kind) {
  std::vector<std::string> names = kind.variables;
  for (const auto& [name, value] : kind.constants) names.push_back(name);
  names.insert(names.end(), formula_language::names().begin(), formula_language::names().end());
  return names;
}

void define_language(mu::Parser& parser) {
  parser.ClearFun();
  parser.ClearConst();
  parser.ClearInfixOprt();
  using unary = double (*)(double);
  const auto negate = [](double v) { return -v; };
  const auto keep = [](double v) { return v; };
  parser.DefineInfixOprt("-", unary(negate));
  parser.DefineInfixOprt("+", unary(keep));
  for (const auto& one : formula_language::functions_of_one) parser.DefineFun(one.name, one.call);
  for (const auto& one : formula_language::functions_of_two) parser.DefineFun(one.name, one.call);
  for (const auto& one : formula_language::constants) parser.DefineConst(one.name, one.value);
}

source_place shifted(source_place place, std::size_t by) {
  if (place.column > 0) place.column += static_cast<int>(by);
  return place;
}

// A single '=' would assign to a variable; comparisons have two characters.
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

/// Returns at most 60 characters around position `at`.
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

/// Throws input_error if the text is empty, too long, not plain ASCII, or has a string or an assignment.
/// `size` does not count the points of tables.
void check_characters(const std::string& text, const source_place& place, const formula_kind& kind,
                      std::size_t size) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    throw input_error(
        place,
        fmt::format("expression is empty (a number or a formula in {} is needed); write for example 1e-3",
                    fmt::join(kind.variables, ", ")));
  if (size > expression::longest)
    throw input_error(place, fmt::format("expression has {} characters (at most {} are read); shorten it",
                                         size, expression::longest));
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

/// A parser with storage for its variables. The parser stores their addresses and has scratch memory, so that
/// only one thread may use it at a time.
class variable_parser {
 public:
  /// `text` must outlive the object.
  variable_parser(const text_of_tables& text, const formula_kind& kind) : values_(kind.variables.size()) {
    define_language(parser_);
    for (std::size_t k = 0; k < values_.size(); ++k) parser_.DefineVar(kind.variables[k], &values_[k]);
    for (const auto& [name, value] : kind.constants) parser_.DefineConst(name, value);
    for (std::size_t k = 0; k < text.tables.size(); ++k)
      if (text.tables[k].arguments() == 2)
        parser_.DefineFunUserData(text.names[k], value_of_two, table_of(text, k));
      else
        parser_.DefineFunUserData(text.names[k], value_of_one, table_of(text, k));
    parser_.SetExpr(text.text);
  }

  double evaluate(const formula_points& at, std::size_t point) {
    for (std::size_t k = 0; k < values_.size(); ++k)
      values_[k] = at.variables[k * at.to_next_variable + point * at.to_next_point];
    return parser_.Eval();
  }
  const mu::Parser& parser() const { return parser_; }

 private:
  /// muParser passes pointers that are not const.
  static void* table_of(const text_of_tables& text, std::size_t k) {
    return const_cast<formula_table*>(&text.tables[k]);
  }
  static double value_of_one(void* table, double a) {
    return static_cast<const formula_table*>(table)->at(a);
  }
  static double value_of_two(void* table, double a, double b) {
    return static_cast<const formula_table*>(table)->at(a, b);
  }

  std::vector<double> values_;
  mu::Parser parser_;
};

/// Parsers of one formula, each used by one thread at a time. A thread returns to the same slot, so that
/// threads wait only if they outnumber the slots. A lock around a single parser makes two threads 6 times as
/// slow (bench/micro/expression.cpp).
class parser_pool {
 public:
  parser_pool(text_of_tables text, const formula_kind& kind) : text_(std::move(text)), kind_(kind) {
    slots_.front().parser = std::make_unique<variable_parser>(text_, kind);
  }

  const text_of_tables& text() const { return text_; }
  /// Returns the first parser, for the constructor of an expression.
  variable_parser& first() { return *slots_.front().parser; }

  /// Evaluates the formula at results.size() points.
  void evaluate(const formula_points& at, std::span<double> results) {
    slot& mine = acquire();
    const release_at_exit release{mine};
    if (!mine.parser) mine.parser = std::make_unique<variable_parser>(text_, kind_);
    for (std::size_t p = 0; p < results.size(); ++p) results[p] = mine.parser->evaluate(at, p);
  }

 private:
  struct alignas(64) slot {  // slots do not share cache lines
    std::atomic_flag taken = ATOMIC_FLAG_INIT;
    std::unique_ptr<variable_parser> parser;
  };
  struct release_at_exit {
    slot& held;
    ~release_at_exit() { held.taken.clear(std::memory_order_release); }
  };

  slot& acquire() {
    static std::atomic<std::size_t> threads_seen{0};
    thread_local const std::size_t home = threads_seen++;
    for (std::size_t k = home;; ++k) {
      slot& candidate = slots_[k % slots_.size()];
      if (!candidate.taken.test_and_set(std::memory_order_acquire)) return candidate;
    }
  }

  text_of_tables text_;
  formula_kind kind_;
  std::array<slot, 64> slots_;
};

std::string values_text(const std::vector<std::string>& names, std::span<const double> values) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < names.size(); ++k)
    parts.push_back(fmt::format("{} = {:.10g}", names[k], values[k]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

formula_kind formula_of_position(int dimensions, bool nonnegative, const formula_constants& constants) {
  const std::vector<std::string> all = {"x", "y", "z"};
  return {{all.begin(), all.begin() + std::clamp(dimensions, 1, 3)}, nonnegative, constants};
}

namespace {

/// Returns why neither a variable nor a constant can have this name; "" if it can.
std::string why_not_a_name(const std::string& name) {
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0 ||
      !std::all_of(name.begin(), name.end(), in_name))
    return "a name is a letter followed by letters, digits and underscores";
  const auto& language = formula_language::names();
  if (std::find(language.begin(), language.end(), name) != language.end())
    return "formulas have a function or constant of this name";
  return "";
}

}  // namespace

std::string why_not_a_constant(const std::string& name) {
  if (std::string why = why_not_a_name(name); !why.empty()) return why;
  for (const char* variable : {"x", "y", "z", "t", "u", "v", "v_x", "v_y", "v_z"})
    if (name == variable) return "it is a variable of formulas";
  return "";
}

std::string why_not_variables(const std::vector<std::string>& names, const formula_constants& constants) {
  const auto why_not = [&](std::vector<std::string>::const_iterator name) -> std::string {
    if (std::string why = why_not_a_name(*name); !why.empty()) return why;
    for (const char* coordinate : {"x", "y", "z", "t"})
      if (*name == coordinate) return "it is a coordinate or time";
    if (constants.contains(*name)) return "a parameter of the case has this name";
    return std::find(names.begin(), name, *name) != name ? "it occurs twice" : "";
  };
  for (auto name = names.begin(); name != names.end(); ++name)
    if (const std::string why = why_not(name); !why.empty())
      return fmt::format("'{:.60}' cannot be the name of a variable: {}", *name, why);
  return "";
}

/// A compiled text, shared by all expressions of this text.
struct expression::compiled : construction_count<expression> {
  compiled(const std::string& words, const source_place& place, const formula_kind& kind)
      : text(words), parsers(without_points(words, place), kind) {
    try {
      parsers.first().evaluate({std::vector<double>(kind.variables.size()).data(), 1, 0}, 0);
    } catch (const mu::ParserError& e) {
      const bool unknown = e.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
      // muParser reports the end of some tokens and the start of others. The text is therefore searched for
      // an unknown name.
      std::size_t at = e.GetPos() >= 0 ? static_cast<std::size_t>(e.GetPos()) : 0;
      at = parsers.text().position_in_formula(at);
      if (unknown && text.rfind(e.GetToken(), at) != std::string::npos) at = text.rfind(e.GetToken(), at);
      at = std::min(at, text.size() - 1);
      fail(text, place, at, explain(e),
           unknown ? suggest(e.GetToken(), known_names(kind)) : "check the formula");
    }
    if (parsers.first().parser().GetNumResults() != 1)
      fail(text, place, text.find(','), "a comma outside a function", "write one formula");
    for (const auto& [name, address] : parsers.first().parser().GetUsedVar()) used.insert(name);
    tape = formula_tape::of(parsers.text(), kind);
  }

  /// Returns the compiled text for the variables and constants of a kind. A cache stores recent ones, because
  /// the parts of a program that read, check and run a case compile the same texts one after the other.
  static std::shared_ptr<const compiled> of(const std::string& text, const source_place& place,
                                            const formula_kind& kind) {
    using key = std::tuple<std::string, std::vector<std::string>, formula_constants>;
    constexpr std::size_t most_kept = 256;
    static std::mutex mutex;
    static std::map<key, std::shared_ptr<const compiled>> kept;
    const std::lock_guard lock(mutex);
    key wanted(text, kind.variables, kind.constants);
    if (const auto found = kept.find(wanted); found != kept.end()) return found->second;
    auto made = std::make_shared<const compiled>(text, place, kind);
    if (kept.size() >= most_kept) kept.clear();
    kept.emplace(std::move(wanted), made);
    return made;
  }

  /// Throws input_error where a table of the formula cannot be read.
  static text_of_tables without_points(const std::string& text, const source_place& place) {
    return take_tables(text, [&](std::size_t at, const std::string& why, const std::string& advice) {
      fail(text, place, at, why, advice);
    });
  }

  std::string text;
  std::set<std::string> used;        ///< names of its variables
  mutable parser_pool parsers;       ///< thread-safe
  std::optional<formula_tape> tape;  ///< replaces the parsers if it exists
};

expression::expression(const std::string& text, const source_place& place, const formula_kind& kind)
    : place_(place), variables_(kind.variables), nonnegative_(kind.nonnegative) {
  check_characters(text, place, kind, compiled::without_points(text, place).text.size());
  compiled_ = compiled::of(text, place, kind);
}

long expression::compiled_so_far() {
  return compiled::so_far();
}

double expression::value(std::span<const double> variables) const {
  double result = 0.0;
  values(variables, {&result, 1});
  return result;
}

void expression::values(std::span<const double> variables, std::span<double> results) const {
  evaluate_at({variables.data(), 1, variables_.size()}, results);
}

void expression::values_of_columns(std::span<const double> variables, std::span<double> results) const {
  evaluate_at({variables.data(), results.size(), 1}, results);
}

void expression::evaluate_at(const formula_points& at, std::span<double> results) const {
  try {
    if (compiled_->tape)
      compiled_->tape->evaluate(at, results);
    else
      compiled_->parsers.evaluate(at, results);
    if (conversion_ != value_conversion{})
      for (double& result : results) result = conversion_(result);
  } catch (const mu::ParserError& e) {
    fail(text(), place_, 0, e.GetMsg(), "check the formula");
  }
}

expression expression::converted(value_conversion by) const {
  expression result = *this;
  result.conversion_ = by;
  return result;
}

double expression::evaluate(std::span<const double> variables) const {
  const double result = value(variables);
  if (!std::isfinite(result) || (nonnegative_ && result < 0.0)) {
    const bool converts = conversion_ != value_conversion{};
    double own = converts ? expression(*this).converted({}).value(variables) : result;
    if (std::isnan(own)) own = std::abs(own);  // NaN is printed without a sign
    throw input_error(
        place_,
        fmt::format("expression '{}' is {} at {} ({} must be finite{}); change the formula or the domain",
                    excerpt(text(), 0), own, values_text(variables_, variables),
                    converts ? fmt::format("{}, to which it is converted,", result) : "it",
                    nonnegative_ ? " and not negative" : ""));
  }
  return result;
}

const std::string& expression::text() const {
  return compiled_->text;
}

bool expression::is_constant() const {
  return compiled_->used.empty();
}

bool expression::uses(const std::string& variable) const {
  return compiled_->used.contains(variable);
}

}  // namespace apsis
