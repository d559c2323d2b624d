// Uses the integrator with a state type of your own. The problem is the relaxation system
//   u_t + v_x = 0,   v_t + u_x = (u²/2 − v)/ε
// on a periodic interval of length 1. Differences are upwind in its characteristic variables u ± v. Its limit
// for ε → 0 is Burgers' equation. The state need only be copyable; the problem implements three functions of
// problem.hpp.
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/integrate/integrate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>
#include <vector>

struct field {
  std::vector<double> u, v;
};

class relaxation_system {
 public:
  using state = field;
  using real = double;

  relaxation_system(std::size_t cells, double epsilon)
      : dx_(1.0 / static_cast<double>(cells)), epsilon_(epsilon) {}

  field initial() const {
    field f;
    for (double x = dx_ / 2; x < 1; x += dx_) {
      f.u.push_back(0.5 + 0.3 * std::sin(2 * std::numbers::pi * x));
      f.v.push_back(0);
    }
    return f;
  }

  void add_transport(double, const field& f, std::span<const apsis::target<field, double>> targets) const {
    const std::size_t n = f.u.size();
    for (const auto& to : targets) {
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t left = (i + n - 1) % n, right = (i + 1) % n;
        const double rightward = -((f.u[i] + f.v[i]) - (f.u[left] + f.v[left])) / dx_;  // T(u + v)
        const double leftward = ((f.u[right] - f.v[right]) - (f.u[i] - f.v[i])) / dx_;  // T(u − v)
        // Only a target with β = 0 may be f itself: then the neighbours read above do not matter.
        to.acc->u[i] = to.combine(to.acc->u[i], f.u[i], to.beta == 0 ? 0 : (rightward + leftward) / 2);
        to.acc->v[i] = to.combine(to.acc->v[i], f.v[i], to.beta == 0 ? 0 : (rightward - leftward) / 2);
      }
    }
  }

  void solve_collision(double, double a, double b, field& f) const {
    const auto weights = apsis::relax_weights(a, b, 1.0, epsilon_);
    for (std::size_t i = 0; i < f.u.size(); ++i)
      f.v[i] = weights.of_u * f.v[i] + weights.of_e * (f.u[i] * f.u[i] / 2);
  }

  double forward_euler_step(double, const field&) const { return dx_; }

 private:
  double dx_, epsilon_;
};

int main() {
  relaxation_system problem(200, 1e-6);
  apsis::stepper stepper(apsis::find_method("md-imex-6-3"), problem);
  field f = problem.initial();
  const auto done = apsis::integrate(stepper, f, 0.0, 0.5, apsis::step_rule<double>::ssp());
  double mass = 0;
  for (const double u : f.u) mass += u / static_cast<double>(f.u.size());
  const auto [low, high] = std::minmax_element(f.u.begin(), f.u.end());
  std::printf("%ld steps, mass %.12f, %.4f <= u <= %.4f\n", done.steps, mass, *low, *high);
}
