#include <apsis/run/multistep_stepper.hpp>

#include <apsis/core/log.hpp>
#include <apsis/integrate/multistep_formula.hpp>
#include <apsis/integrate/schedule.hpp>

#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

template <equal_step_formula Formula>
class steps_of final : public multistep_stepper {
 public:
  steps_of(multistep_method m, Formula formula) : method_(std::move(m)), formula_(std::move(formula)) {}

  void step(const time_marcher<double>& march, double dt, budgeted_state& u) override {
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

  void visit_kept(const std::function<void(budgeted_state&, double)>& visit) override {
    formula_.visit_kept(visit);
  }
  multistep_progress save() const override { return {dt_, formula_.known()}; }
  void resume(const multistep_progress& saved, const budgeted_state& like) override {
    dt_ = saved.dt;
    formula_.resume(saved.known, like);
  }

 private:
  void take(const time_marcher<double>& march, double dt, budgeted_state& u) {
    // The initial data, which may be far from equilibrium, are not in the history.
    const bool first = march.starting() || march.step() == 0;
    if (!first && formula_.known() + 1 >= formula_.first_steps()) return formula_.step(march.t(), dt, u);
    if (!first) formula_.add(march.t(), dt, u);
    formula_.starter().step(march.t(), dt, u);
  }

  /// Not for the last step to time.end, which has no successor.
  void warn_of_change() {
    const int steps = formula_.first_steps() - 1;  // u itself is in the history
    if (changed_at_ < 0.0 || warned_ || steps == 0) return;
    log::warning(fmt::format(
        "steps change their length at t = {:g}: '{}' begins again there with {} step{} of '{}', and at every "
        "later change; for equal steps give a time.dt that divides output.every",
        changed_at_, method_.name, steps, steps == 1 ? "" : "s", method_.starter));
    warned_ = true;
  }

  multistep_method method_;
  Formula formula_;
  double dt_ = 0.0, changed_at_ = -1.0;
  bool warned_ = false;
};

}  // namespace

std::unique_ptr<multistep_stepper> make_multistep_stepper(const multistep_method& m,
                                                          budgeted_problem& problem) {
  return with_multistep_formula(m, problem, [&m](auto formula) -> std::unique_ptr<multistep_stepper> {
    return std::make_unique<steps_of<decltype(formula)>>(m, std::move(formula));
  });
}

int buffers_of(const multistep_method& m) {
  const int of_starter = schedule(find_method(m.starter).coefficients<double>()).buffers();
  return of_starter + (m.rows ? static_cast<int>(m.rows->stages()) : m.steps);
}

}  // namespace apsis
