// u1' = u2,  u2' = (1 + u1²)(sin u1 − u2)/ε with ε = 1e-8, in steps of 1/64.
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  using state = std::vector<double>;
  apsis::relaxation_problem problem([](double, const state& u, state& T) { T = {u[1], 0}; },  // transport
                                    [](const state& u) { return u[0]; },                      // conserved
                                    [](double w, state& E) { E = {w, std::sin(w)}; },         // equilibrium
                                    [](double w) { return 1 + w * w; },                       // rate
                                    1e-8);                                                    // ε
  apsis::stepper stepper(apsis::find_method("md-imex-6-3"), problem);
  state u{2, 0};
  apsis::integrate(stepper, u, 0.0, 1.0, apsis::step_rule<double>::fixed(1.0 / 64));
  std::printf("u(1) = (%.6f, %.6f)\n", u[0], u[1]);
}
