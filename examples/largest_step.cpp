// Finds the largest steps that preserve a property, for a problem of your own. Particles of speed ±1 on a
// ring of length 1 turn round at rate 1/(2ε):  f±_t ± f±_x = (ρ/2 − f±)/ε,  ρ = f₊ + f₋,  by first-order
// upwind differences. The state contains f₊ of all cells, then f₋.
#include <apsis/integrate/relaxation_problem.hpp>
#include <apsis/verify/strong_stability.hpp>

#include <algorithm>
#include <cstdio>
#include <span>
#include <vector>

int main() {
  using state = std::vector<double>;
  constexpr std::size_t n = 20;
  constexpr double dx = 1.0 / n;
  apsis::relaxation_problem problem(
      [](double, const state& f, state& T) {
        for (std::size_t i = 0; i < n; ++i) {
          T[i] = (f[(i + n - 1) % n] - f[i]) / dx;
          T[n + i] = (f[n + (i + 1) % n] - f[n + i]) / dx;
        }
      },
      [](const state& f) {
        state rho(n);
        for (std::size_t i = 0; i < n; ++i) rho[i] = f[i] + f[n + i];
        return rho;
      },
      [](const state& rho, state& E) {
        for (std::size_t i = 0; i < n; ++i) E[i] = E[n + i] = rho[i] / 2;
      },
      [](const state&) { return 1.0; }, 1e-3);
  problem.with_forward_euler_step([](double, const state&) { return dx; });

  // Rough data give sharp limits: a spike, and a step.
  std::vector<state> data(2, state(2 * n, 0.0));
  data[0][3] = 1;
  std::fill_n(data[1].begin(), n / 2, 1.0);
  const auto positive = apsis::stays_inside<state>(
      "positivity", [](const state& f) { return -*std::min_element(f.begin(), f.end()); }, 1e-14);
  const auto bounded = apsis::does_not_grow<state>(
      "maximum", [](const state& f) { return *std::max_element(f.begin(), f.end()); });

  for (const char* name : {"md-imex-3-2", "md-imex-6-3", "ars-222"}) {
    const auto& method = apsis::find_method(name);
    const apsis::step_search how{.steps = 3, .stages = true};
    const auto one = apsis::largest_step(method, problem, std::span<const state>(data), positive, how);
    const auto two = apsis::largest_step(method, problem, std::span<const state>(data), bounded, how);
    std::printf("%-12s r = %.4f: positive up to %.3f, bounded up to %.3f dt_FE\n", name,
                apsis::promised_coefficient(apsis::find_certificate(name)), one.kept, two.kept);
  }
}
