#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace van_der_pol_problem {
namespace {

/// y' = z, z' = ((1 − y²) z − y)/ε with ε = 1e-6.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    f[0] = y[1];
    f[1] = ((1.0 - y[0] * y[0]) * y[1] - y[0]) * 1e6;
  }
};

}  // namespace
}  // namespace van_der_pol_problem

extern const stiff_problem_entry stiff_problem_van_der_pol;
const stiff_problem_entry stiff_problem_van_der_pol = {
    .name = "van-der-pol",
    .description = "relaxation oscillator z' = ((1 - y^2) z - y)/1e-6",
    .source = "van der Pol (1926)",
    .origin = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), VDPOL",
    .times = {0, 2},
    .sizes = {1},
    .start = [] { return std::vector<double>{2, 0}; },
    .rate = [](std::size_t) { return make_stiff_rate(van_der_pol_problem::formula{}); },
    .reference = {{0, 0.1706167732170483e1}, {1, -0.8928097010247975}}};

}  // namespace apsis
