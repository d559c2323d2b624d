// u' = u − 3u with explicit growth and implicit decay, so u(1) = e⁻². A third-order method with 64 steps has
// an error below 1e-5. A wrong sign or a first-order fallback would have an error of 1e-3 or more.
#include <apsis/integrate/integrate.hpp>
#include <apsis/method/method.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <span>

struct growth_and_decay {
  using state = double;
  using real = double;
  void add_transport(real, const state& u, std::span<const apsis::target<state, real>> targets) {
    for (const auto& target : targets) *target.acc = target.combine(*target.acc, u, u);
  }
  void solve_collision(real, real a, real b, state& u) { u /= 1 + 3 * a - 9 * b; }
  real forward_euler_step(real, const state&) { return std::numeric_limits<real>::infinity(); }
};

int main() {
  growth_and_decay problem;
  apsis::stepper stepper(apsis::find_method("md-imex-6-3"), problem);
  double u = 1.0;
  apsis::integrate(stepper, u, 0.0, 1.0, apsis::step_rule<double>::fixed(1.0 / 64));
  std::printf("u(1) = %.17g, exact %.17g\n", u, std::exp(-2.0));
  return std::abs(u - std::exp(-2.0)) < 1e-5 ? 0 : 1;
}
