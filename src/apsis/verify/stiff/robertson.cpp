#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace robertson_problem {
namespace {

/// Three species, rate constants from 0.04 to 3e7.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    const auto first = -0.04 * y[0] + 1e4 * y[1] * y[2], third = 3e7 * y[1] * y[1];
    f[0] = first;
    f[1] = -1.0 * first - third;
    f[2] = third;
  }
};

}  // namespace
}  // namespace robertson_problem

extern const stiff_problem_entry stiff_problem_robertson;
const stiff_problem_entry stiff_problem_robertson = {
    .name = "robertson",
    .description = "three reactions whose slowest product takes 1e11 units of time",
    .source = "Robertson (1966)",
    .origin = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), ROBER",
    .times = {0, 1e11},
    .sizes = {1e-8, 1e-14, 1e-8},
    .start = [] { return std::vector<double>{1, 0, 0}; },
    .rate = [](std::size_t) { return make_stiff_rate(robertson_problem::formula{}); },
    .reference = {{0, 0.2083340149701255e-7}, {1, 0.8333360770334713e-13}, {2, 0.9999999791665050}}};

}  // namespace apsis
