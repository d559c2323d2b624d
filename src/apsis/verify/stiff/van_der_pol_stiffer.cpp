#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace van_der_pol_stiffer_problem {
namespace {

/// y' = z, z' = ((1 − y²) z − y)/ε with ε = 1e-12.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    f[0] = y[1];
    f[1] = ((1.0 - y[0] * y[0]) * y[1] - y[0]) * 1e12;
  }
};

}  // namespace
}  // namespace van_der_pol_stiffer_problem

extern const stiff_problem_entry stiff_problem_van_der_pol_stiffer;
const stiff_problem_entry stiff_problem_van_der_pol_stiffer = {
    .name = "van-der-pol-stiffer",
    .description = "relaxation oscillator y'' = mu (1 - y^2) y' - y, mu = 1e6, time in units of mu",
    .source = "van der Pol (1926)",
    .origin = "Radau IIA of order 5 with doubled steps in 40 digits, local errors below 1e-15",
    .times = {0, 2},
    .sizes = {1},
    .start = [] { return std::vector<double>{2, 0}; },
    .rate = [](std::size_t) { return make_stiff_rate(van_der_pol_stiffer_problem::formula{}); },
    .reference = {{0, 1.705546217535275}, {1, -0.8934763625466390}}};

}  // namespace apsis
