#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace oregonator_problem {
namespace {

/// Belousov–Zhabotinskii reaction: a limit cycle with layers.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    f[0] = 77.27 * (y[1] + y[0] * (1.0 - 8.375e-6 * y[0] - y[1]));
    f[1] = (y[2] - (1.0 + y[0]) * y[1]) / 77.27;
    f[2] = 0.161 * (y[0] - y[2]);
  }
};

}  // namespace
}  // namespace oregonator_problem

extern const stiff_problem_entry stiff_problem_oregonator;
const stiff_problem_entry stiff_problem_oregonator = {
    .name = "oregonator",
    .description = "oscillating reaction of three species, over one period",
    .source = "Field & Noyes (1974)",
    .origin = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), OREGO",
    .times = {0, 360},
    .sizes = {1},
    .start = [] { return std::vector<double>{1, 2, 3}; },
    .rate = [](std::size_t) { return make_stiff_rate(oregonator_problem::formula{}); },
    .reference = {{0, 0.1000814870318523e1}, {1, 0.1228178521549917e4}, {2, 0.1320554942846706e3}}};

}  // namespace apsis
