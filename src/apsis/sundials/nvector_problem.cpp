#include "internal/nvector_problem.hpp"

#include <apsis/c/internal/guarded.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis::sundials {

nvector_problem::nvector_problem(functions& of, const stage_accuracy& accuracy, const nvector& like)
    : of_(of), accuracy_(accuracy), rate_(like.another()), other_(like.another()), work_(like.another()) {
  if (of.collision != nullptr && of.stage == nullptr) newton_.emplace(of, accuracy, like);
}

/// For each target: acc ← (fresh ? 0 : acc) + (α u + β rate); `evaluate` sets rate_, if some β needs it.
template <class Evaluate>
void nvector_problem::accumulate(const state& u, targets to, const Evaluate& evaluate) {
  if (std::any_of(to.begin(), to.end(), [](const auto& one) { return one.beta != 0.0; })) evaluate();
  for (const auto& [acc, alpha, beta, fresh] : to) {
    N_Vector sum = fresh ? acc->get() : work_.get();
    if (beta != 0.0)
      N_VLinearSum(alpha, u.get(), beta, rate_.get(), sum);
    else
      N_VScale(alpha, u.get(), sum);
    if (!fresh) N_VLinearSum(1.0, acc->get(), 1.0, sum, acc->get());
  }
}

void nvector_problem::add_transport(double t, const state& u, targets to) {
  accumulate(u, to, [&] { of_.evaluate_transport(t, u.get(), rate_.get()); });
}

void nvector_problem::add_collision(double t, const state& u, targets to) {
  accumulate(u, to, [&] { of_.evaluate_collision(t, u.get(), rate_.get()); });
}

void nvector_problem::add_transport_and_collision(double t, const state& u, targets to) {
  accumulate(u, to, [&] {
    of_.evaluate_transport(t, u.get(), rate_.get());
    of_.evaluate_collision(t, u.get(), other_.get());
    N_VLinearSum(1.0, rate_.get(), 1.0, other_.get(), rate_.get());
  });
}

void nvector_problem::combine(std::span<const linear_term<state, double>> terms, state& sum) {
  N_VScale(terms[0].alpha, terms[0].u->get(), sum.get());
  for (const auto& [alpha, u] : terms.subspan(1)) N_VLinearSum(1.0, sum.get(), alpha, u->get(), sum.get());
}

bool nvector_problem::has_transport(double t, const state& u) {
  if (of_.transport == nullptr) return false;
  of_.evaluate_transport(t, u.get(), rate_.get());
  return N_VMaxNorm(rate_.get()) != 0.0;
}

bool nvector_problem::is_admissible(const state& u) {
  return satisfies(accuracy_.constraints, u.get(), work_.get());
}

void nvector_problem::solve(double t, bool timed, double a, double b, state& u) {
  if (of_.stage != nullptr && (a != 0.0 || b != 0.0)) {
    of_.count(APSIS_SUNDIALS_STAGE_SOLVES);
    // A stage that fails leaves u unchanged.
    other_ = u;
    c::require_success("stage", of_.stage(t, a, b, other_.get(), of_.data));
    u.swap(other_);
  } else if (newton_ && (a != 0.0 || b != 0.0)) {
    newton_->solve(t, timed, a, b, u);
  }
  if (!is_finite(u.get()))
    throw numerical_error(
        fmt::format("a stage at t = {:.10g} is not finite (NaN or infinity); reduce the time step, or check "
                    "the callbacks",
                    t));
  if (!is_admissible(u))
    throw numerical_error(
        fmt::format("a stage at t = {:.10g} does not satisfy the constraints; reduce the time step, or use "
                    "an unconditionally "
                    "SSP method",
                    t));
}

}  // namespace apsis::sundials
