// The C interface gives the numbers of the C++ interface, bit for bit.
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/equal_steps.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <c/ode.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace c_same_bits_test {

namespace {

using namespace c_interface;
using state = std::vector<double>;
using rule = apsis::step_rule<double>;

state state_of(const integrator& s, std::size_t n = 2) {
  const double* u = apsis_state(s.get());
  return {u, u + n};
}

auto relaxation(double epsilon) {
  return apsis::relaxation_problem(
      [](double, const state& u, state& out) { out = {u[1], 0}; }, [](const state& u) { return u[0]; },
      [](double w, state& e) { e = {w, std::sin(w)}; }, [](double w) { return 1 + w * w; }, epsilon);
}

double weighted(const state& u, const state& v) {
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    largest = std::max(largest, std::abs(u[i] - v[i]) / (1e-9 + 1e-6 * std::abs(u[i])));
  return largest;
}

/// Q = (−u1 + u2², k (u1² − u2)), a collision without conserved moments, with derivatives written by hand.
struct general {
  double k;

  void value(std::span<const double> u, std::span<double> out) const {
    out[0] = -u[0] + u[1] * u[1];
    out[1] = k * (u[0] * u[0] - u[1]);
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) const {
    jx[0] = -x[0] + 2 * u[1] * x[1];
    jx[1] = k * (2 * u[0] * x[0] - x[1]);
  }
  void curvature(std::span<const double>, std::span<const double> p, std::span<const double> x,
                 std::span<double> hx) const {
    hx[0] = 2 * p[1] * x[1];
    hx[1] = k * 2 * p[0] * x[0];
  }
};

int value(size_t, size_t n, const double* u, double* q, void* data) {
  static_cast<const general*>(data)->value({u, n}, {q, n});
  return 0;
}
int product(size_t, size_t n, const double* u, const double* x, double* jx, void* data) {
  static_cast<const general*>(data)->jacobian_product({u, n}, {x, n}, {jx, n});
  return 0;
}
int curvature(size_t, size_t n, const double* u, const double* k, const double* x, double* hx, void* data) {
  static_cast<const general*>(data)->curvature({u, n}, {k, n}, {x, n}, {hx, n});
  return 0;
}

integrator of_general(const char* name, general& g) {
  auto s = make(name, 2);
  apsis_set_data(s.get(), &g);
  apsis_set_transport(s.get(), transport);
  apsis_set_rate(s.get(), value);
  apsis_set_product(s.get(), product);
  apsis_set_curvature(s.get(), curvature);
  const double u0[] = {1, 0.5};
  EXPECT_EQ(apsis_start(s.get(), 0, u0), APSIS_OK);
  return s;
}

const auto transport_of_general = [](double, const state& u, state& out) { out = {u[1], 0}; };

}  // namespace

TEST(c_same_bits, of_steps_of_every_kind) {
  for (const std::string name : {"md-imex-6-3", "ars-443", "dop853", "exponential-2", "imex-bdf-4",
                                 "imex-dimsim-2", "two-step-8-3-narrow"}) {
    ode data{name == "dop853" ? 0.3 : 0.01};  // explicit steps are stable for Δt C/ε < 5 or so
    auto problem = relaxation(data.epsilon);
    state expected{2, 0};
    apsis::with_stepper(apsis::find_integrator(name), problem, [&](auto march) {
      apsis::integrate(march, expected, 0.0, 1.0, rule::fixed(1.0 / 64));
    });
    const auto s = of_ode(name.c_str(), data);
    EXPECT_EQ(apsis_set_step(s.get(), 1.0 / 64), APSIS_OK);
    EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
    EXPECT_EQ(state_of(s), expected) << name;
    EXPECT_EQ(apsis_time(s.get()), 1.0);
    EXPECT_EQ(apsis_count(s.get(), APSIS_STEPS), 64);
  }
}

// The problem is the quick start of README.md.
TEST(c_same_bits, of_the_model_of_the_paper) {
  ode data{1e-8};
  auto problem = relaxation(data.epsilon);
  apsis::stepper march(apsis::find_method("md-imex-6-3"), problem);
  state expected{2, 0};
  apsis::integrate(march, expected, 0.0, 1.0, rule::fixed(1.0 / 64));
  const auto s = of_ode("md-imex-6-3", data);
  apsis_set_step(s.get(), 1.0 / 64);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(state_of(s), expected);
}

TEST(c_same_bits, of_graded_and_of_strong_stability_preserving_steps) {
  ode data{1e-3};
  const auto limit = [](double t, size_t, const double*, double* result, void*) {
    *result = 0.01 + 0.01 * t;
    return 0;
  };
  auto problem = relaxation(data.epsilon);
  problem.with_forward_euler_step([](double t, const state&) { return 0.01 + 0.01 * t; });
  apsis::stepper march(apsis::find_method("md-imex-3-2"), problem);
  state expected{2, 0};
  const auto done =
      apsis::integrate(march, expected, 0.0, 1.0, rule::ssp(0.8).with(apsis::startup::graded, 4));
  const auto s = of_ode("md-imex-3-2", data);
  apsis_set_relaxation_time(s.get(), relaxation_time);
  apsis_set_forward_euler_step(s.get(), limit);
  apsis_set_safety(s.get(), 0.8);
  apsis_set_graded_start(s.get(), 4);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(state_of(s), expected);
  EXPECT_EQ(apsis_count(s.get(), APSIS_STEPS), done.steps);
}

TEST(c_same_bits, of_steps_within_a_tolerance_by_every_law) {
  ode data{1e-3};
  for (const char* name : {"md-imex-6-3", "ssp2-222"})  // with an embedded solution, and by step doubling
    for (const auto& law : apsis::step_laws()) {
      auto problem = relaxation(data.epsilon);
      const auto& m = apsis::find_method(name);
      apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
      apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order, law);
      state expected{2, 0};
      const auto done =
          apsis::integrate_to_tolerance(march, expected, 0.0, 1.0, rule::unlimited(), control, weighted);
      const auto s = of_ode(name, data);
      apsis_set_relaxation_time(s.get(), relaxation_time);
      apsis_set_tolerance(s.get(), 1e-6, 1e-9);
      EXPECT_EQ(apsis_set_controller(s.get(), law.name.c_str()), APSIS_OK);
      EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
      EXPECT_EQ(state_of(s), expected) << name << ", " << law.name;
      EXPECT_EQ(apsis_count(s.get(), APSIS_STEPS), done.steps);
      EXPECT_EQ(apsis_count(s.get(), APSIS_REJECTED_STEPS), control.rejected());
    }
}

TEST(c_same_bits, of_stages_by_newtons_method) {
  general g{1e4};
  for (const char* name : {"md-imex-6-3", "imdrk-3-3", "ars-443", "ssprk-3-3"}) {
    apsis::newton_problem<decltype(transport_of_general), general> problem(transport_of_general, g);
    const auto& m = apsis::find_method(name);
    if (m.kind == apsis::method_kind::implicit_only) continue;  // the model has transport
    const double dt = m.kind == apsis::method_kind::explicit_only ? 1e-5 : 1.0 / 64;
    apsis::stepper march(m, problem);
    state expected{1, 0.5};
    apsis::integrate(march, expected, 0.0, 0.25, rule::fixed(dt));
    const auto s = of_general(name, g);
    apsis_set_step(s.get(), dt);
    EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK) << apsis_error_message();
    EXPECT_EQ(state_of(s), expected) << name;
  }
}

TEST(c_same_bits, of_newtons_method_within_a_tolerance) {
  general g{1e4};
  for (const char* name : {"md-imex-6-3", "ark-437"}) {  // with second derivatives, and without
    apsis::newton_problem<decltype(transport_of_general), general> problem(transport_of_general, g);
    problem.with_tolerances({1e-6, 1e-9});
    const auto& m = apsis::find_method(name);
    apsis::stepper march(m, problem, apsis::solutions::result_and_embedded);
    apsis::step_controller<double> control(1.0, apsis::estimate_of(m).order);
    state expected{1, 0.5};
    const auto done =
        apsis::integrate_to_tolerance(march, expected, 0.0, 0.25, rule::unlimited(), control, weighted);
    const auto s = of_general(name, g);
    const double absolute[] = {1e-9, 1e-9};
    apsis_set_tolerances(s.get(), 1e-6, absolute);
    EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK) << apsis_error_message();
    EXPECT_EQ(state_of(s), expected) << name;
    EXPECT_EQ(apsis_count(s.get(), APSIS_STEPS), done.steps);
  }
}

/// Returns an integrator of several systems of two unknowns with the same start.
integrator of_blocks(general& g, std::size_t blocks, const std::vector<double>& absolute) {
  const auto of_all = [](double t, size_t n, const double* u, double* out, void* data) {
    for (size_t i = 0; i < n; i += 2) transport(t, 2, u + i, out + i, data);
    return 0;
  };
  auto s = make("ark-437", 2 * blocks);
  apsis_set_data(s.get(), &g);
  apsis_set_transport(s.get(), of_all);
  apsis_set_rate(s.get(), value);
  apsis_set_product(s.get(), product);
  EXPECT_EQ(apsis_set_block_size(s.get(), 2), APSIS_OK);
  apsis_set_tolerances(s.get(), 1e-6, absolute.data());
  state u0;
  for (std::size_t k = 0; k < blocks; ++k) u0.insert(u0.end(), {1, 0.5});
  EXPECT_EQ(apsis_start(s.get(), 0, u0.data()), APSIS_OK);
  EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK) << apsis_error_message();
  return s;
}

// Equal blocks have equal errors, so that their steps are those of one block.
TEST(c_same_bits, of_blocks_within_a_tolerance) {
  general g{1e4};
  const auto one = of_blocks(g, 1, {1e-9, 1e-9}), three = of_blocks(g, 3, state(6, 1e-9));
  const state expected = state_of(one), found = state_of(three, 6);
  EXPECT_EQ(apsis_count(three.get(), APSIS_STEPS), apsis_count(one.get(), APSIS_STEPS));
  // Each block shares a derivative of its own in every step.
  EXPECT_EQ(apsis_count(three.get(), APSIS_PRODUCT_EVALUATIONS),
            3 * apsis_count(one.get(), APSIS_PRODUCT_EVALUATIONS));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(found[i], expected[i % 2]) << i;
}

TEST(c_same_bits, of_blocks_with_other_tolerances_do_not_depend_on_their_order) {
  general g{1e4};
  const state u = state_of(of_blocks(g, 2, {1e-9, 1e-9, 1e-3, 1e-3}), 4),
              v = state_of(of_blocks(g, 2, {1e-3, 1e-3, 1e-9, 1e-9}), 4);
  EXPECT_EQ((state{v[2], v[3], v[0], v[1]}), u);
  EXPECT_NE(u[0], u[2]);  // the second block solves its stages less accurately
}

TEST(c_same_bits, stages_of_a_step_share_a_derivative) {
  general g{1e4};
  const auto derivatives_of = [&g](double relative) {
    const auto s = of_general("ark-437", g);
    if (relative > 0.0)
      apsis_set_tolerance(s.get(), relative, 1e-9);
    else
      apsis_set_step(s.get(), 1.0 / 256);
    EXPECT_EQ(apsis_integrate(s.get(), 0.25), APSIS_OK) << apsis_error_message();
    return static_cast<double>(apsis_count(s.get(), APSIS_PRODUCT_EVALUATIONS)) /
           static_cast<double>(apsis_count(s.get(), APSIS_STEPS));
  };
  // A step with a tolerance mostly computes the two columns of the derivative once. A step without a
  // tolerance computes them in each of its six implicit stages.
  EXPECT_LE(derivatives_of(1e-6), 4.0);
  EXPECT_GE(derivatives_of(0.0), 12.0);
}

}  // namespace c_same_bits_test
