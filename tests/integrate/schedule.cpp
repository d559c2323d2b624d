#include <apsis/integrate/schedule.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/certificate.hpp>

#include <cmath>

#include <integrate/random_form.hpp>
#include <support/property.hpp>

namespace schedule_test {

namespace {

using apsis::schedule;
using apsis::shu_osher_form;

/// u' = λ_T u + λ_Q u. The problem counts all calls and fails on demand.
class counted {
 public:
  using state = std::vector<double>;
  using real = double;

  double transport = 0.0, collision = 0.0;
  int transports = 0, collisions = 0, solves = 0;
  int fail_at_solve = -1;

  void add_transport(double, const state& u, std::span<const apsis::target<state, double>> targets) {
    bool moves = false;
    for (const auto& to : targets) moves = moves || to.beta != 0.0;
    transports += moves ? 1 : 0;
    for (const auto& to : targets)
      (*to.acc)[0] = to.combine((*to.acc)[0], u[0], moves ? transport * u[0] : 0.0);
  }
  void solve_collision(double, double a, double b, state& u) {
    if (solves++ == fail_at_solve) throw apsis::numerical_error("on demand");
    u[0] /= 1.0 - a * collision - b * collision * collision;
  }
  void add_collision(double, const state& u, std::span<const apsis::target<state, double>> targets) {
    ++collisions;
    for (const auto& to : targets) (*to.acc)[0] = to.combine((*to.acc)[0], u[0], collision * u[0]);
  }
  double forward_euler_step(double, const state&) const { return 1.0; }
};

/// Takes the same step in Butcher form without a schedule. It solves (I − z_T Â − z_Q A − z_Q² Ȧ) U = e by
/// forward substitution.
double direct(const shu_osher_form<double>& m, double zt, double zq) {
  const auto b = apsis::to_butcher(m);
  std::vector<double> u(m.stages());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto coefficient = [&](std::size_t j) {
      return zt * b.A_hat(i, j) + zq * b.A(i, j) + zq * zq * b.A_dot(i, j);
    };
    double sum = 1.0;
    for (std::size_t j = 0; j < i; ++j) sum += coefficient(j) * u[j];
    u[i] = sum / (1.0 - coefficient(i));
  }
  return u.back();
}

double stepped(const shu_osher_form<double>& m, counted& p) {
  apsis::stepper<counted> s(m, apsis::method_kind::imex, p);
  std::vector<double> u = {1.0};
  s.step(0.0, 1.0, u);
  return u[0];
}

}  // namespace

TEST(schedule, of_the_papers_methods_needs_three_and_six_buffers) {
  EXPECT_EQ(schedule(apsis::find_method("md-imex-3-2").coefficients<double>()).buffers(), 3);
  EXPECT_EQ(schedule(apsis::find_method("md-imex-6-3").coefficients<double>()).buffers(), 6);
}

TEST(schedule, of_explicit_methods_needs_the_known_registers_plus_one_or_two) {
  // Two registers suffice if T(u) is added to u in place (Ketcheson, 2008). add_transport writes elsewhere
  // while it reads u, so it needs one more. A failed step must leave u^n. Only (10,4) would overwrite u^n, so
  // it needs another one.
  struct counted_in_place {
    const char* name;
    int registers;
    bool keeps_u_n;
  };
  for (const auto& m : {counted_in_place{"ssprk-2-2", 2, true}, counted_in_place{"ssprk-3-3", 2, true},
                        counted_in_place{"ssprk-4-3", 2, true}, counted_in_place{"ssprk-10-4", 2, false}}) {
    const schedule plan(apsis::find_method(m.name).coefficients<double>());
    EXPECT_EQ(plan.buffers(), m.registers + 1 + (m.keeps_u_n ? 0 : 1)) << m.name;
    // Buffer 0 stores u^n, so a step must not write it.
    for (const auto& instruction : plan.instructions())
      for (const auto& to : instruction.to) EXPECT_NE(to.buffer, 0) << m.name << " writes stage " << to.stage;
  }
}

TEST(schedule, counts_agree_with_the_certificate_and_with_a_step) {
  for (const auto& name : apsis::method_names()) {
    const auto form = apsis::find_method(name).coefficients<double>();
    const schedule plan(form);
    const auto& certificate = apsis::find_certificate(name);
    counted p;
    stepped(form, p);
    EXPECT_EQ(plan.transport_evaluations(), certificate.explicit_evaluations) << name;
    EXPECT_EQ(plan.implicit_solves(), certificate.implicit_solves) << name;
    EXPECT_EQ(p.transports, plan.transport_evaluations()) << name;
    EXPECT_EQ(p.solves, plan.implicit_solves()) << name;
    EXPECT_EQ(p.collisions, plan.collision_evaluations()) << name;
  }
}

TEST(schedule, of_every_method_reproduces_its_stability_function) {
  for (const auto& name : apsis::method_names()) {
    const apsis::method& m = apsis::find_method(name);
    const auto form = m.coefficients<double>();
    check_property(name, [&] {
      counted p;
      p.transport = *rc::gen::inRange(-2000, 2000) * 1e-3;
      p.collision = -std::pow(10.0, *rc::gen::inRange(-3, 5));
      const double expected = direct(form, p.transport, p.collision);
      // There are a dozen products. In DIRK methods partial sums are up to 10³ times the result. Where an
      // IMEX method evaluates Q they have size z.
      const bool evaluates = m.kind == apsis::method_kind::imex && schedule(form).collision_evaluations() > 0;
      const double rounding = 1e-12 + (evaluates ? 2e-15 * std::abs(p.collision) : 0.0);
      RC_ASSERT(std::abs(stepped(form, p) - expected) <= rounding * (1.0 + std::abs(expected)));
    });
  }
}

TEST(schedule, of_any_zero_pattern_reproduces_its_stability_function) {
  check_property("random forms", [] {
    const auto form = random_input::form(1);
    counted p;
    p.transport = *rc::gen::inRange(-1000, 1000) * 1e-3;
    p.collision = -*rc::gen::inRange(1, 1000) * 1e-3;
    // Stages with ḋ evaluate an off-diagonal Q. Other stages recover it from their solution.
    const double expected = direct(form, p.transport, p.collision);
    RC_ASSERT(std::abs(stepped(form, p) - expected) <= 1e-11 * (1.0 + std::abs(expected)));
    RC_ASSERT(schedule(form).buffers() <= static_cast<int>(form.stages()) + 1);
  });
}

namespace {

/// A problem that evaluates T and Q in one call.
class joint : public counted {
 public:
  int joints = 0;

  void add_transport_and_collision(double, const state& u,
                                   std::span<const apsis::target<state, double>> targets) {
    ++joints;
    for (const auto& to : targets)
      (*to.acc)[0] = to.combine((*to.acc)[0], u[0], (transport + collision) * u[0]);
  }
};

}  // namespace

TEST(stepper, evaluates_transport_and_collision_of_explicit_methods_together) {
  for (const auto& name : apsis::method_names()) {
    const apsis::method& m = apsis::find_method(name);
    if (m.kind == apsis::method_kind::exact_collision) continue;
    const auto form = m.coefficients<double>();
    joint p;
    p.transport = -0.3;
    p.collision = -0.4;
    apsis::stepper<joint> s(form, m.kind, p);
    for (const double dt : {0.5, 0.25}) {  // coefficients are prepared once for each dt
      p.transports = p.collisions = p.joints = 0;
      std::vector<double> u = {1.0};
      s.step(0.0, dt, u);
      EXPECT_NEAR(u[0], direct(form, dt * p.transport, dt * p.collision), 1e-14) << name;
      const schedule& plan = s.plan();
      if (m.kind == apsis::method_kind::explicit_only) {
        EXPECT_EQ(p.joints, plan.transport_evaluations()) << name;
        EXPECT_EQ(p.transports + p.collisions, 0) << name;
      } else {
        EXPECT_EQ(p.transports + p.joints, plan.transport_evaluations()) << name;
        EXPECT_EQ(p.collisions + p.joints, plan.collision_evaluations()) << name;
      }
    }
  }
}

TEST(stepper, keeps_the_state_if_a_stage_fails) {
  for (const auto& name : apsis::method_names()) {
    const auto form = apsis::find_method(name).coefficients<double>();
    const int solves = schedule(form).implicit_solves();
    for (int k = 0; k < solves; ++k) {
      counted p;
      p.transport = -0.3;
      p.collision = -2.0;
      p.fail_at_solve = k;
      apsis::stepper<counted> s(form, apsis::method_kind::imex, p);
      std::vector<double> u = {1.25};
      try {
        s.step(0.0, 0.1, u);
        ADD_FAILURE() << name << " stage " << k << ": the failure was lost";
      } catch (const apsis::numerical_error& failure) {
        EXPECT_EQ(failure.problem(), "on demand") << name;
      }
      EXPECT_EQ(u[0], 1.25) << name << " stage " << k;
    }
  }
}

namespace {

/// A problem without add_collision.
class minimal_problem {
 public:
  using state = double;
  using real = double;
  void add_transport(double, const double& u, std::span<const apsis::target<double, double>> targets) {
    for (const auto& to : targets) *to.acc = to.combine(*to.acc, u, 0.0);
  }
  void solve_collision(double, double, double, double&) {}
  double forward_euler_step(double, double) const { return 1.0; }
};

}  // namespace

TEST(stepper, rejects_a_method_that_needs_add_collision_if_the_problem_lacks_it) {
  minimal_problem p;
  EXPECT_NO_THROW(apsis::stepper<minimal_problem>(apsis::find_method("md-imex-6-3"), p));
  for (const std::string name : {"ssprk-3-3", "dirk-2-2"}) {
    try {
      apsis::stepper<minimal_problem>(apsis::find_method(name), p);
      ADD_FAILURE() << name << " accepted";
    } catch (const apsis::input_error& refused) {
      EXPECT_NE(std::string(refused.what()).find("method '" + name + "' evaluates Q explicitly"),
                std::string::npos)
          << refused.what();
    }
  }
}

}  // namespace schedule_test
