#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/integrate/equal_steps.hpp>
#include <apsis/integrate/kinds/exponential.hpp>
#include <apsis/integrate/kinds/imex_bdf.hpp>
#include <apsis/integrate/kinds/imex_dimsim.hpp>
#include <apsis/integrate/kinds/runge_kutta.hpp>
#include <apsis/integrate/kinds/two_step.hpp>
#include <apsis/method/time_integrator.hpp>

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace apsis {

/// The kinds of integrators that take steps: one entry for each file of integrate/kinds/. An entry has the
/// name of its kind and a function with(m, p, which, use). The function returns use(march), where `march` is
/// a stepper or an equal_step_formula.
using stepper_kinds =
    std::tuple<runge_kutta_steps, exponential_steps, two_step_steps, imex_bdf_steps, imex_dimsim_steps>;

/// @cond
namespace any_stepper_parts {

template <class Kind, class... Others, problem P, class Use>
auto with_one_of(std::tuple<Kind, Others...>*, const time_integrator& m, P& p, solutions which,
                 const Use& use) {
  if (m.kind == Kind::kind) return Kind::with(m, p, which, use);
  if constexpr (sizeof...(Others) > 0)
    return with_one_of(static_cast<std::tuple<Others...>*>(nullptr), m, p, which, use);
  else
    throw input_error("integrator '" + m.name + "' takes no steps (kind '" + m.kind +
                      "' is not among the stepper_kinds); add it there");
}

}  // namespace any_stepper_parts
/// @endcond

/// Returns use(march), where `march` is the stepper or the equal_step_formula of an integrator for a problem.
/// `use` may move it. `march` stores a reference to the problem, which must outlive it. Throws input_error if
/// the problem lacks a function that the integrator needs.
template <problem P, class Use>
auto with_stepper(const time_integrator& m, P& p, const Use& use, solutions which = solutions::result) {
  return any_stepper_parts::with_one_of(static_cast<stepper_kinds*>(nullptr), m, p, which, use);
}

/// Takes the steps of an integrator of any kind, with one virtual call for each step. The steps are those of
/// integrate(), except where their length changes: there an integrator with equal steps begins again with its
/// starter.
template <problem P>
class any_stepper {
 public:
  using state = typename P::state;  ///< type of u
  using real = typename P::real;    ///< type of time and coefficients

  virtual ~any_stepper() = default;

  /// Advances u by the step dt that `march` gave. If a stage throws, u is the old value, and the next steps
  /// are those of the starter.
  virtual void step(const time_marcher<real>& march, real dt, state& u) = 0;

  /// Calls visit(v, w) for every state v that later steps need in addition to u. v is a sum of earlier u,
  /// with weights that add up to w, and of their transport.
  virtual void visit_kept(const std::function<void(state&, real)>& visit) = 0;

  /// Returns the state for a checkpoint; nothing if later steps need u alone.
  virtual std::optional<history_position<real>> save() const = 0;
  /// Continues from `saved`. visit_kept() then gives the places of the kept values, which are states like
  /// `like`.
  virtual void restore(const history_position<real>& saved, const state& like) = 0;

  /// Returns the stepper of a method of one step, for steps by tolerance; otherwise nullptr.
  virtual stepper<P>* one_step() = 0;
};

/// @cond
namespace any_stepper_parts {

/// Steps of a method of one step.
template <problem P, class March>
class independent_steps final : public any_stepper<P> {
 public:
  using state = typename P::state;
  using real = typename P::real;
  explicit independent_steps(March march) : march_(std::move(march)) {}

  void step(const time_marcher<real>& march, real dt, state& u) override { march_.step(march.t(), dt, u); }
  void visit_kept(const std::function<void(state&, real)>&) override {}
  std::optional<history_position<real>> save() const override { return std::nullopt; }
  void restore(const history_position<real>&, const state&) override {}
  stepper<P>* one_step() override {
    if constexpr (std::derived_from<March, stepper<P>>)
      return &march_;
    else
      return nullptr;
  }

 private:
  March march_;
};

/// Steps of a formula of several equal steps.
template <problem P, equal_step_formula Formula>
class dependent_steps final : public any_stepper<P> {
 public:
  using state = typename P::state;
  using real = typename P::real;
  dependent_steps(const time_integrator& m, Formula formula)
      : name_(m.name), starter_(m.starter().name), formula_(std::move(formula)) {}

  void step(const time_marcher<real>& march, real dt, state& u) override {
    warn_of_change();
    if (dt != dt_) {
      if (formula_.known() > 0 && !march.starting()) changed_at_ = march.t();
      formula_.restart();
      dt_ = dt;
    }
    try {
      take(march, dt, u);
    } catch (...) {
      formula_.restart();
      throw;
    }
  }

  void visit_kept(const std::function<void(state&, real)>& visit) override { formula_.visit_kept(visit); }
  std::optional<history_position<real>> save() const override {
    return history_position<real>{dt_, formula_.known()};
  }
  void restore(const history_position<real>& saved, const state& like) override {
    dt_ = saved.dt;
    formula_.resume(saved.known, like);
  }
  stepper<P>* one_step() override { return nullptr; }

 private:
  void take(const time_marcher<real>& march, real dt, state& u) {
    // The history omits the initial data, because they may be far from equilibrium.
    const bool first = march.starting() || march.step() == 0;
    if (!first && formula_.known() + 1 >= formula_.first_steps()) return formula_.step(march.t(), dt, u);
    if (!first) formula_.add(march.t(), dt, u);
    formula_.starter().step(march.t(), dt, u);
  }

  /// Warns of a change of length in the next step, so that a shorter last step causes no warning.
  void warn_of_change() {
    const int steps = formula_.first_steps() - 1;  // u itself is in the history
    if (changed_at_ < real(0) || warned_ || steps == 0) return;
    log::warning(fmt::format(
        "steps change their length at t = {:g}: '{}' begins again there with {} step{} of '{}', and at every "
        "later change; for equal steps give a time.dt that divides output.every",
        static_cast<double>(changed_at_), name_, steps, steps == 1 ? "" : "s", starter_));
    warned_ = true;
  }

  std::string name_, starter_;
  Formula formula_;
  real dt_ = real(0), changed_at_ = real(-1);
  bool warned_ = false;
};

}  // namespace any_stepper_parts
/// @endcond

/// Returns the stepper of an integrator. `p` must outlive it. If `which` is result_and_embedded, a method of
/// one step can estimate the errors of its steps. Throws like with_stepper().
template <problem P>
std::unique_ptr<any_stepper<P>> make_stepper(const time_integrator& m, P& p,
                                             solutions which = solutions::result) {
  return with_stepper(
      m, p,
      [&m](auto march) -> std::unique_ptr<any_stepper<P>> {
        using March = decltype(march);
        if constexpr (equal_step_formula<March>)
          return std::make_unique<any_stepper_parts::dependent_steps<P, March>>(m, std::move(march));
        else
          return std::make_unique<any_stepper_parts::independent_steps<P, March>>(std::move(march));
      },
      which);
}

}  // namespace apsis
