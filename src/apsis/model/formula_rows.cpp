#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/formula_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/formula_rows.hpp>

#include <apsis/model/formulas/arithmetic.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(wide()));

/// The numbers of an operand from point k on.
struct column {
  const double* from;
  N operator()(int k) const { return N::load(from + k); }
};
struct constant {
  N value;
  N operator()(int) const { return value; }
};

template <class A, class B, class Apply>
HWY_INLINE void combine(const A& a, const B& b, int points, double* to, const Apply& apply) {
  for (int k = 0; k < points; k += lanes) apply(a(k), b(k)).store(to + k);
}

/// to ← apply(a, b). At most one operand is a constant.
template <class Apply>
HWY_INLINE void for_operands(const formula_rows::step& at, int points, double* columns, const Apply& apply) {
  const auto of = [&](int number) { return columns + number * formula_rows::most_points; };
  double* to = of(at.result);
  if (at.first.column < 0)
    return combine(constant{N(at.first.constant)}, column{of(at.second.column)}, points, to, apply);
  if (at.second.column < 0)
    return combine(column{of(at.first.column)}, constant{N(at.second.constant)}, points, to, apply);
  combine(column{of(at.first.column)}, column{of(at.second.column)}, points, to, apply);
}

template <class Apply>
HWY_INLINE void for_operand(const formula_rows::step& at, int points, double* columns, const Apply& apply) {
  const double* from = columns + at.first.column * formula_rows::most_points;
  double* to = columns + at.result * formula_rows::most_points;
  for (int k = 0; k < points; k += lanes) apply(N::load(from + k)).store(to + k);
}

HWY_NOINLINE void call(const formula_rows::step& at, int points, double* columns) {
  double* to = columns + at.result * formula_rows::most_points;
  const auto value = [&](const formula_rows::operand& of, int k) {
    return of.column < 0 ? of.constant : columns[of.column * formula_rows::most_points + k];
  };
  for (int k = 0; k < points; ++k) {
    const double a = value(at.first, k);
    to[k] = at.of_one != nullptr   ? at.of_one(a)
            : at.of_two != nullptr ? at.of_two(a, value(at.second, k))
                                   : at.table->at(a, value(at.second, k));
  }
}

void evaluate(std::span<const formula_rows::step> steps, int points, double* columns) {
  using formula_rows::operation;
  for (const formula_rows::step& at : steps) switch (at.what) {
      case operation::add:
        for_operands(at, points, columns, [](N a, N b) APSIS_PACKED { return a + b; });
        break;
      case operation::subtract:
        for_operands(at, points, columns, [](N a, N b) APSIS_PACKED { return a - b; });
        break;
      case operation::multiply:
        for_operands(at, points, columns, [](N a, N b) APSIS_PACKED { return a * b; });
        break;
      case operation::divide:
        for_operands(at, points, columns, [](N a, N b) APSIS_PACKED { return a / b; });
        break;
      case operation::negate:
        for_operand(at, points, columns, [](N a) APSIS_PACKED { return -a; });
        break;
      case operation::square:
        for_operand(at, points, columns, [](N a) APSIS_PACKED { return square_of(a); });
        break;
      case operation::cube:
        for_operand(at, points, columns, [](N a) APSIS_PACKED { return cube_of(a); });
        break;
      case operation::fourth_power:
        for_operand(at, points, columns, [](N a) APSIS_PACKED { return fourth_power_of(a); });
        break;
      case operation::call:
        call(at, points, columns);
        break;
    }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(evaluate);
}  // namespace

void formula_rows::evaluate(std::span<const step> steps, int points, double* columns) {
  HWY_DYNAMIC_DISPATCH(evaluate)(steps, points, columns);
}

}  // namespace apsis
#endif
