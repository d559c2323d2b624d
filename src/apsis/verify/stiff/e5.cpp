#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace e5_problem {
namespace {

/// Four species. The rate of the third is the difference of two others, so that y₂ − y₃ − y₄ = 0 is
/// conserved up to rounding. Rounding errors of the largest values, 1e-10, add up to 1e-25. Digits below
/// this do not count (`sizes`).
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    const auto a = 7.89e-10 * y[0], b = 1.1e7 * y[0] * y[2], c = 1.13e9 * y[1] * y[2], d = 1.13e3 * y[3];
    f[0] = -1.0 * a - b;
    f[1] = a - c;
    f[3] = b - d;
    f[2] = f[1] - f[3];
  }
};

}  // namespace
}  // namespace e5_problem

extern const stiff_problem_entry stiff_problem_e5;
const stiff_problem_entry stiff_problem_e5 = {
    .name = "e5",
    .description = "pyrolysis of four species of sizes 1e-3 to 1e-20",
    .source = "Enright, Hull & Lindberg (1975), problem E5; Hairer & Wanner, Solving ODEs II",
    .origin = "Radau IIA of order 5 with doubled steps in 40 digits, local errors below 1e-15",
    .times = {0, 1e11},
    .sizes = {1e-17},
    .start = [] { return std::vector<double>{1.76e-3, 0, 0, 0}; },
    .rate = [](std::size_t) { return make_stiff_rate(e5_problem::formula{}); },
    .reference = {{0, 0}, {1, 1.019258256814271e-20}, {2, 1.019258256814271e-20}, {3, 0}}};

}  // namespace apsis
