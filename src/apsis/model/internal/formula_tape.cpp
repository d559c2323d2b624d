#include <apsis/model/internal/formula_tape.hpp>

#include <apsis/model/internal/formula_language.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include <muParser.h>

namespace apsis {
namespace {

using formula_rows::operand;
using formula_rows::operation;
using formula_rows::step;

/// Operators and functions for a parser that record their calls. They return a NaN whose bits encode the
/// number of the result. Variables have such values from the start. All other numbers are constants of
/// the formula.
class recorder {
 public:
  explicit recorder(std::size_t variables) : variables_(static_cast<int>(variables)) { current = this; }
  ~recorder() { current = nullptr; }
  recorder(const recorder&) = delete;
  recorder& operator=(const recorder&) = delete;

  /// Returns the value that encodes variable k.
  static double variable(std::size_t k) { return name_of(static_cast<int>(k)); }
  /// Returns the variable, step or constant that a value of the parser stands for.
  static operand meant_by(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    if (bits <= first_name || bits - first_name > last_name) return {-1, value};
    return {static_cast<int>(bits - first_name) - 1, 0.0};
  }
  const std::vector<step>& steps() const { return steps_; }

  template <operation what>
  static double take(double a, double b) {
    return current->add({what, meant_by(a), meant_by(b)}, [&] { return on_constants<what>(a, b); });
  }
  static double negate(double a) {
    return current->add({operation::negate, meant_by(a), {}}, [&] { return -a; });
  }
  static double keep(double a) { return a; }
  /// Records small integer powers as products.
  static double power(double a, double b) {
    const auto by_products = [&](operation what) {
      return current->add({what, meant_by(a), {}}, [&] { return std::pow(a, b); });
    };
    if (b == 2.0) return by_products(operation::square);
    if (b == 3.0) return by_products(operation::cube);
    if (b == 4.0) return by_products(operation::fourth_power);
    return compare<power_of>(a, b);
  }
  template <double (*function)(double, double)>
  static double compare(double a, double b) {
    return current->add({operation::call, meant_by(a), meant_by(b), 0, nullptr, function},
                        [&] { return function(a, b); });
  }
  static double call_of_one(void* of, double a) {
    const auto function = static_cast<const formula_language::function_of_one*>(of)->call;
    return current->add({operation::call, meant_by(a), {}, 0, function}, [&] { return function(a); });
  }
  static double call_of_two(void* of, double a, double b) {
    const auto function = static_cast<const formula_language::function_of_two*>(of)->call;
    return current->add({operation::call, meant_by(a), meant_by(b), 0, nullptr, function},
                        [&] { return function(a, b); });
  }
  static double table_of_one(void* of, double a) { return table_of_two(of, a, 0.0); }
  static double table_of_two(void* of, double a, double b) {
    const auto* const table = static_cast<const formula_table*>(of);
    return current->add({operation::call, meant_by(a), meant_by(b), 0, nullptr, nullptr, table},
                        [&] { return table->at(a, b); });
  }

  static double power_of(double a, double b) { return std::pow(a, b); }
  static double less(double a, double b) { return a < b ? 1.0 : 0.0; }
  static double greater(double a, double b) { return a > b ? 1.0 : 0.0; }
  static double at_most(double a, double b) { return a <= b ? 1.0 : 0.0; }
  static double at_least(double a, double b) { return a >= b ? 1.0 : 0.0; }
  static double equal(double a, double b) { return a == b ? 1.0 : 0.0; }
  static double different(double a, double b) { return a != b ? 1.0 : 0.0; }

 private:
  static constexpr std::uint64_t first_name = 0x7ff8000000000000, last_name = 1'000'000;
  static double name_of(int number) {
    return std::bit_cast<double>(first_name + static_cast<std::uint64_t>(number) + 1);
  }

  template <operation what>
  static double on_constants(double a, double b) {
    return what == operation::add        ? a + b
           : what == operation::subtract ? a - b
           : what == operation::multiply ? a * b
                                         : a / b;
  }

  /// Records a step and returns the value that encodes its result. With constant operands it returns
  /// value() instead.
  template <class Value>
  double add(step one, const Value& value) {
    if (one.first.column < 0 && one.second.column < 0) return value();
    one.result = variables_ + static_cast<int>(steps_.size());
    steps_.push_back(one);
    return name_of(one.result);
  }

  // Operators of muParser are functions without user data, so that the recorder must be global.
  static thread_local recorder* current;
  int variables_;
  std::vector<step> steps_;
};

thread_local recorder* recorder::current = nullptr;

void define_operators(mu::Parser& parser) {
  parser.EnableOptimizer(false);
  parser.EnableBuiltInOprt(false);
  const auto define = [&](const char* name, double (*take)(double, double), int precedence) {
    parser.DefineOprt(name, take, static_cast<unsigned>(precedence),
                      precedence == mu::prPOW ? mu::oaRIGHT : mu::oaLEFT, false);
  };
  define("+", recorder::take<operation::add>, mu::prADD_SUB);
  define("-", recorder::take<operation::subtract>, mu::prADD_SUB);
  define("*", recorder::take<operation::multiply>, mu::prMUL_DIV);
  define("/", recorder::take<operation::divide>, mu::prMUL_DIV);
  define("^", recorder::power, mu::prPOW);
  define("<", recorder::compare<recorder::less>, mu::prCMP);
  define(">", recorder::compare<recorder::greater>, mu::prCMP);
  define("<=", recorder::compare<recorder::at_most>, mu::prCMP);
  define(">=", recorder::compare<recorder::at_least>, mu::prCMP);
  define("==", recorder::compare<recorder::equal>, mu::prCMP);
  define("!=", recorder::compare<recorder::different>, mu::prCMP);
  parser.ClearInfixOprt();
  parser.DefineInfixOprt("-", recorder::negate, mu::prINFIX, false);
  parser.DefineInfixOprt("+", recorder::keep, mu::prINFIX, false);
}

/// muParser passes pointers that are not const.
template <class T>
void* without_const(const T& of) {
  return const_cast<T*>(&of);
}

void define_functions(mu::Parser& parser, const text_of_tables& text) {
  parser.ClearFun();
  for (const auto& one : formula_language::functions_of_one)
    parser.DefineFunUserData(one.name, recorder::call_of_one, without_const(one), false);
  for (const auto& one : formula_language::functions_of_two)
    parser.DefineFunUserData(one.name, recorder::call_of_two, without_const(one), false);
  for (std::size_t k = 0; k < text.tables.size(); ++k)
    if (text.tables[k].arguments() == 2)
      parser.DefineFunUserData(text.names[k], recorder::table_of_two, without_const(text.tables[k]), false);
    else
      parser.DefineFunUserData(text.names[k], recorder::table_of_one, without_const(text.tables[k]), false);
}

/// Columns that intermediate results share. Each result is an operand of exactly one step, which releases
/// its column.
class shared_columns {
 public:
  explicit shared_columns(int first) : next_(first) {}

  void release(int column) { free_.push_back(column); }
  int take() {
    if (free_.empty()) return next_++;
    const int column = free_.back();
    free_.pop_back();
    return column;
  }
  int count() const { return next_; }

 private:
  int next_;
  std::vector<int> free_;
};

/// Assigns results of steps to columns behind those of the variables. Returns the number of columns.
int assign_columns(const std::vector<int>& used, int variables, std::vector<step>& steps, operand& result) {
  const int first = static_cast<int>(used.size());
  shared_columns left(first);
  std::vector<int> of_steps(steps.size());
  const auto place = [&](operand& of) {
    if (of.column < 0) return;
    if (of.column < variables)
      of.column = static_cast<int>(std::find(used.begin(), used.end(), of.column) - used.begin());
    else
      of.column = of_steps[static_cast<std::size_t>(of.column - variables)];
  };
  for (std::size_t k = 0; k < steps.size(); ++k) {
    step& one = steps[k];
    for (operand* of : {&one.first, &one.second}) {
      place(*of);
      if (of->column >= first) left.release(of->column);
    }
    one.result = of_steps[k] = left.take();
  }
  place(result);
  return left.count();
}

}  // namespace

std::optional<formula_tape> formula_tape::of(const text_of_tables& text, const formula_kind& kind) {
  // A condition evaluates only one of its formulas, which a tape cannot express.
  if (text.text.find_first_of("?&|") != std::string::npos) return std::nullopt;
  const std::size_t count = kind.variables.size();
  recorder recorded(count);  // NOLINT(misc-const-correctness): the parser calls it by a pointer
  mu::Parser parser;
  define_operators(parser);
  define_functions(parser, text);
  parser.ClearConst();
  for (const auto& one : formula_language::constants) parser.DefineConst(one.name, one.value);
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    values[k] = recorder::variable(k);
    parser.DefineVar(kind.variables[k], &values[k]);
  }
  for (const auto& [name, value] : kind.constants) parser.DefineConst(name, value);
  parser.SetExpr(text.text);
  formula_tape tape;
  tape.result_ = recorder::meant_by(parser.Eval());
  tape.steps_ = recorded.steps();
  const int variables = static_cast<int>(count);
  const auto use = [&](const operand& of) {
    if (of.column >= 0 && of.column < variables &&
        std::find(tape.used_.begin(), tape.used_.end(), of.column) == tape.used_.end())
      tape.used_.push_back(of.column);
  };
  for (const step& one : tape.steps_) {
    use(one.first);
    use(one.second);
  }
  use(tape.result_);
  if (assign_columns(tape.used_, variables, tape.steps_, tape.result_) > formula_rows::most_columns)
    return std::nullopt;
  return tape;
}

void formula_tape::evaluate(const formula_points& at, std::span<double> results) const {
  constexpr std::size_t most = formula_rows::most_points, whole = 8;
  if (result_.column < 0) return std::fill(results.begin(), results.end(), result_.constant);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): the columns of the formula are set
  alignas(64) std::array<double, most * formula_rows::most_columns> columns;
  for (std::size_t done = 0; done < results.size(); done += most) {
    const std::size_t points = std::min(most, results.size() - done),
                      padded = (points + whole - 1) / whole * whole;
    for (std::size_t k = 0; k < used_.size(); ++k) {
      const double* from =
          at.variables + static_cast<std::size_t>(used_[k]) * at.to_next_variable + done * at.to_next_point;
      double* column = columns.data() + k * most;
      if (at.to_next_point == 1)
        std::copy_n(from, points, column);
      else
        for (std::size_t p = 0; p < points; ++p) column[p] = from[p * at.to_next_point];
      std::fill(column + points, column + padded, column[points - 1]);
    }
    formula_rows::evaluate(steps_, static_cast<int>(points), columns.data());
    std::copy_n(columns.data() + static_cast<std::size_t>(result_.column) * most, points,
                results.data() + done);
  }
}

}  // namespace apsis
