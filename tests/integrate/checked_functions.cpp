// Functions of a problem that set another number of unknowns, or numbers that are not finite.
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <vector>

#include <gtest/gtest.h>
#include <integrate/ode_model.hpp>
#include <support/bad_input.hpp>

namespace checked_functions_test {

namespace {

using apsis::no_transport;
using row = std::vector<double>;

}  // namespace

TEST(relaxation_problem, refuses_functions_that_change_the_number_of_unknowns) {
  const auto right = [](double, const row& u, row& out) { out = {u[1], 0}; };
  const auto w = [](const row& u) { return u[0]; };
  const auto E = [](double omega, row& out) { out = {omega, 0}; };
  const auto C = [](double) { return 1.0; };
  const auto step = [](auto problem) {
    row u{2, 0};
    apsis::stepper<decltype(problem)>(apsis::find_method("md-imex-6-3"), problem).step(0.0, 0.01, u);
  };
  bad_input::expect_refused({
      {[&] {
         step(apsis::relaxation_problem([](double, const row& u, row& out) { out = {u[1]}; }, w, E, C, 1.0));
       },
       {"the transport gives 1 numbers (the state has 2)"}},
      {[&] {
         step(apsis::relaxation_problem([](double, const row& u, row& out) { out = {u[1], 0, 0}; }, w, E, C,
                                        1.0));
       },
       {"the transport gives 3 numbers (the state has 2)"}},
      {[&] {
         step(apsis::relaxation_problem(right, w, [](double omega, row& out) { out = {omega}; }, C, 1.0));
       },
       {"the equilibrium gives 1 numbers (the state has 2)"}},
      {[&] {
         step(apsis::relaxation_problem(right, w, E, [](double, row& rates) { rates = {1, 1, 1}; }, 1.0));
       },
       {"the rate gives 3 numbers (the state has 2)"}},
  });
}

TEST(relaxation_problem, explicit_methods_end_where_the_solution_overflows) {
  // The fastest mode grows by (0.01/1e-6)³ in a step, and exceeds all numbers within 30 steps.
  auto problem = ode_model::as_relaxation(1e-6);
  for (const char* name : {"ssprk-3-3", "kutta-4"}) {
    apsis::stepper stepper(apsis::find_method(name), problem);
    row u{2, 0};
    bad_input::expect_refused(
        {{[&] { apsis::integrate(stepper, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.01)); },
          {"is not finite", "[step "},
          3}});
  }
}

TEST(newton_problem, explicit_methods_end_where_the_solution_overflows) {
  const auto stiff = [](const auto& u, auto& out) { out[0] = -1e8 * (u[0] - 1.0); };
  const auto explicit_part = [](double, const row& u, row& out) { out[0] = -1e8 * (u[0] - 1.0); };
  apsis::newton_problem as_collision{no_transport{}, stiff};
  apsis::newton_problem as_transport{explicit_part, [](const auto&, auto& out) { out[0] = 0.0; }};
  const auto run = [](auto& problem) {
    apsis::stepper stepper(apsis::find_method("kutta-4"), problem);
    row u{0};
    apsis::integrate(stepper, u, 0.0, 10.0, apsis::step_rule<double>::fixed(0.1));
  };
  bad_input::expect_refused({{[&] { run(as_collision); }, {"is not finite", "[step "}, 3},
                             {[&] { run(as_transport); }, {"is not finite", "[step "}, 3}});
}

TEST(newton_problem, refuses_a_transport_that_changes_the_number_of_unknowns) {
  apsis::newton_problem problem{[](double, const row&, row& out) { out = {0}; },
                                [](const auto& u, auto& out) {
                                  out[0] = -u[0];
                                  out[1] = -u[1];
                                }};
  row u{1, 1};
  bad_input::expect_refused(
      {{[&] { apsis::stepper(apsis::find_method("md-imex-6-3"), problem).step(0.0, 0.1, u); },
        {"the transport gives 1 numbers (the state has 2)"}}});
}

}  // namespace checked_functions_test
