// Integrators of every kind behind one interface: the numbers of integrate(), restarts, and requirements.
#include <apsis/integrate/any_stepper.hpp>

#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/integrate/schedule.hpp>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <support/bad_input.hpp>

namespace any_stepper_test {

namespace {

using real = long double;
using state = std::vector<real>;

constexpr long steps = 24;
constexpr real dt = real(1) / steps;

/// One name for each kind, and for each equation of one-step methods.
const std::vector<std::string> of_each_kind = {
    "md-imex-8-3-mixed", "ark-436",    "dop853",     "exponential-2",
    "imex-bdf-1",        "imex-bdf-4", "imex-bdf-5", "two-step-8-3-narrow",
    "imex-dimsim-3"};

apsis::time_marcher<real> times() {
  return {real(0), real(1), dt};
}

template <class Stepper>
void advance(Stepper& march, apsis::time_marcher<real>& now, state& u, long count) {
  for (long n = 0; n < count; ++n) {
    const real length = now.next(dt);
    march.step(now, length, u);
    now.advance(length);
  }
}

}  // namespace

TEST(any_stepper, has_the_bits_of_integrate) {
  for (const auto& name : of_each_kind) {
    auto problem = ode_model::as_relaxation<state>(0.3L);
    const auto& m = apsis::find_integrator(name);
    state expected{2, 0}, u{2, 0};
    apsis::with_stepper(m, problem, [&](auto march) {
      apsis::integrate(march, expected, real(0), real(1), apsis::step_rule<real>::fixed(dt));
    });
    const auto march = apsis::make_stepper(m, problem);
    auto now = times();
    advance(*march, now, u, steps);
    EXPECT_TRUE(now.done());
    EXPECT_EQ(u, expected) << name;
  }
}

TEST(any_stepper, continues_bit_for_bit_from_every_step) {
  for (const auto& name : of_each_kind) {
    auto problem = ode_model::as_relaxation<state>(0.3L);
    const auto& m = apsis::find_integrator(name);
    state whole{2, 0};
    auto end = times();
    advance(*apsis::make_stepper(m, problem), end, whole, steps);
    for (long at = 1; at < steps; ++at) {
      state u{2, 0};
      auto now = times();
      const auto first = apsis::make_stepper(m, problem);
      advance(*first, now, u, at);
      const auto saved = first->save();
      EXPECT_EQ(saved.has_value(), m.needs.equal_steps) << name;
      std::vector<state> kept;
      first->visit_kept([&kept](const state& v, real) { kept.push_back(v); });
      const auto second = apsis::make_stepper(m, problem);
      if (saved) second->restore(*saved, u);
      std::size_t k = 0;
      second->visit_kept([&](state& v, real) { v = kept.at(k++); });
      EXPECT_EQ(k, kept.size());
      advance(*second, now, u, steps - at);
      EXPECT_EQ(u, whole) << name << " from step " << at;
    }
  }
}

TEST(any_stepper, offers_steps_by_tolerance_where_steps_are_independent) {
  auto problem = ode_model::as_relaxation<state>(0.3L);
  for (const auto& name : of_each_kind) {
    const auto& m = apsis::find_integrator(name);
    // The stepper of exact collisions belongs to a wrapped problem.
    const bool same_problem = m.one_step() != nullptr && !m.needs.exact_collision;
    EXPECT_EQ(apsis::make_stepper(m, problem)->one_step() != nullptr, same_problem) << name;
  }
}

TEST(any_stepper, needs_explicit_collisions_where_the_schedule_evaluates_them) {
  bool any = false;
  for (const auto& name : apsis::integrator_names()) {
    const auto& m = apsis::find_integrator(name);
    const apsis::schedule of_starter(m.starter().coefficients<double>());
    EXPECT_EQ(m.needs.explicit_collision, of_starter.collision_evaluations() > 0) << name;
    EXPECT_EQ(apsis::buffers_of(m), of_starter.buffers() + m.kept_states) << name;
    EXPECT_EQ(m.kept_states > 0, m.one_step() == nullptr) << name;
    any = any || m.needs.explicit_collision;
  }
  EXPECT_TRUE(any);
}

TEST(any_stepper, refuses_kinds_without_steps) {
  class planned final : public apsis::time_integrator {
   public:
    planned() {
      name = "planned";
      kind = "not-there";
    }
    const apsis::method& starter() const override { return apsis::find_method("md-imex-3-2"); }
    apsis::amplification growth() const override { return apsis::amplification(starter()); }
    apsis::rate_errors errors_at(double) const override { return {}; }
    apsis::integrator_certificate certify() const override { return {}; }
  };
  auto problem = ode_model::as_relaxation<state>(0.3L);
  bad_input::expect_refused({
      {[&] { static_cast<void>(apsis::make_stepper(planned(), problem)); },
       {"integrator 'planned' takes no steps (kind 'not-there' is not among"}},
  });
}

}  // namespace any_stepper_test
