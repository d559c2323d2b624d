#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/problem.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace apsis {

/// An array of numbers as a state: std::vector, std::array, an Eigen vector, or a class with size() and [].
template <class State>
concept array_state = std::copyable<State> && requires(State& u, const State& c) {
  { c.size() } -> std::integral;
  { u[c.size()] } -> std::convertible_to<long double>;
};

/// Number type of an array_state.
template <array_state State>
using state_real = std::remove_cvref_t<decltype(std::declval<State&>()[std::declval<const State&>().size()])>;

/// Placeholder for T = 0: u' = Q(u) is newton_problem{no_transport{}, G}.
struct no_transport {
  /// out ← 0.
  template <class Real, class State>
  void operator()(Real, const State&, State& out) const {
    using size_type = decltype(out.size());
    for (size_type i = 0; i < out.size(); ++i) out[i] = state_real<State>(0);
  }
};

/// For every target, sets acc ← (fresh ? 0 : acc) + α u + β f, where f = evaluate() is evaluated at most
/// once, and not at all if every β is 0. evaluate() returns a reference to a state of the size of u.
template <array_state State, class Evaluate>
void accumulate(std::span<const target<State, state_real<State>>> targets, const State& u,
                const Evaluate& evaluate) {
  using real = state_real<State>;
  using size_type = decltype(u.size());
  const State* f = nullptr;
  for (const auto& to : targets)
    if (f == nullptr && to.beta != real(0)) f = &evaluate();
  for (const auto& to : targets) {
    State& acc = *to.acc;
    // Branches outside the loops keep small states as fast as hand-written code.
    if (f == nullptr || to.beta == real(0)) {
      for (size_type i = 0; i < u.size(); ++i) acc[i] = to.combine(real(acc[i]), real(u[i]), real(0));
    } else if (to.fresh) {
      for (size_type i = 0; i < u.size(); ++i) acc[i] = to.alpha * u[i] + to.beta * (*f)[i];
    } else {
      for (size_type i = 0; i < u.size(); ++i) acc[i] += to.alpha * u[i] + to.beta * (*f)[i];
    }
  }
}

/// Whether every number is 0 (NaN counts as nonzero).
template <class Row>
bool is_zero(const Row& row) {
  using size_type = decltype(row.size());
  for (size_type i = 0; i < row.size(); ++i)
    if (!(row[i] == state_real<Row>(0))) return false;
  return true;
}

/// Throws the error of require_finite(). Out of line, so that the check itself takes a few instructions.
template <class Row>
[[noreturn, gnu::noinline, gnu::cold]] void throw_not_finite(const Row& row, const char* what) {
  using size_type = decltype(row.size());
  using std::isfinite;
  size_type i = 0;
  while (i + 1 < row.size() && isfinite(row[i])) ++i;
  throw numerical_error(std::string(what) + " is not finite (component " + std::to_string(i) +
                            "); reduce the time step, or check the functions of the problem",
                        {-1, std::nan(""), -1, static_cast<double>(row[i])});
}

/// Throws numerical_error with index and value of the first number that is not finite.
template <class Row>
inline void require_finite(const Row& row, const char* what) {
  using size_type = decltype(row.size());
  using real = state_real<Row>;
  // x − x is 0 or NaN: one branch for the whole row.
  real none(0);
  for (size_type i = 0; i < row.size(); ++i) none += row[i] - row[i];
  if (!(none == real(0))) throw_not_finite(row, what);
}

/// Throws the error of require_size(). Out of line like throw_not_finite().
[[noreturn, gnu::noinline, gnu::cold]] inline void throw_wrong_size(std::size_t found, std::size_t needed,
                                                                    const char* function) {
  throw input_error(std::string(function) + " gives " + std::to_string(found) + " numbers (the state has " +
                    std::to_string(needed) + "); set one number for each unknown");
}

/// Throws input_error unless a function of a problem has set as many numbers as the state has.
template <class Row, class State>
inline void require_size(const Row& row, const State& u, const char* function) {
  if (row.size() != u.size())
    throw_wrong_size(static_cast<std::size_t>(row.size()), static_cast<std::size_t>(u.size()), function);
}

}  // namespace apsis
