#include <apsis/verify/stiff_problem.hpp>

#include <cmath>
#include <numbers>

namespace apsis {
namespace ring_modulator_problem {
namespace {

/// Voltages (0 to 6) and currents (7 to 14) of a ring modulator with diodes and capacitances of 2 pF.
struct formula {
  template <class T, class U, class V>
  void operator()(const T& t, const U& y, V& f) const {
    using std::exp, std::sin;
    constexpr double pi = std::numbers::pi;
    const auto low = 0.5 * sin(2e3 * pi * t), high = 2.0 * sin(2e4 * pi * t);
    const auto diode = [](const auto& u) { return 40.67286402e-9 * (exp(17.7493332 * u) - 1.0); };
    const auto q1 = diode(y[2] - y[4] - y[6] - high), q2 = diode(y[5] - y[3] - y[6] - high),
               q3 = diode(y[3] + y[4] + y[6] + high), q4 = diode(y[6] - y[2] - y[5] + high);
    f[0] = (y[7] - 0.5 * y[9] + 0.5 * y[10] + y[13] - y[0] / 25e3) / 1.6e-8;
    f[1] = (y[8] - 0.5 * y[11] + 0.5 * y[12] + y[14] - y[1] / 25e3) / 1.6e-8;
    f[2] = (y[9] - q1 + q4) / 2e-12;
    f[3] = (q2 - q3 - y[10]) / 2e-12;
    f[4] = (y[11] + q1 - q3) / 2e-12;
    f[5] = (q4 - q2 - y[12]) / 2e-12;
    f[6] = (q1 + q2 - q3 - q4 - y[6] / 50.0) / 1e-8;
    f[7] = -1.0 * y[0] / 4.45;
    f[8] = -1.0 * y[1] / 4.45;
    f[9] = (0.5 * y[0] - y[2] - 17.3 * y[9]) / 5e-4;
    f[10] = (y[3] - 0.5 * y[0] - 17.3 * y[10]) / 5e-4;
    f[11] = (0.5 * y[1] - y[4] - 17.3 * y[11]) / 5e-4;
    f[12] = (y[5] - 0.5 * y[1] - 17.3 * y[12]) / 5e-4;
    f[13] = (low - y[0] - 86.3 * y[13]) / 2e-3;
    f[14] = (-1.0 * y[1] - 636.3 * y[14]) / 2e-3;
  }
};

}  // namespace
}  // namespace ring_modulator_problem

extern const stiff_problem_entry stiff_problem_ring_modulator;
const stiff_problem_entry stiff_problem_ring_modulator = {
    .name = "ring-modulator",
    .description = "electric circuit whose fast oscillations last, voltages of a given time",
    .source = "Horneber (1976)",
    .origin = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), RINGMOD; confirmed here to 9 digits",
    .times = {0, 1e-3},
    .sizes = {1, 1, 1, 1, 1, 1, 1, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3},
    .slow = true,
    .start = [] { return std::vector<double>(15, 0.0); },
    .rate = [](std::size_t) { return make_stiff_rate(ring_modulator_problem::formula{}); },
    .reference = {{0, -0.2339057358486745e-1},
                  {1, -0.7367485485540825e-2},
                  {2, 0.2582956709291169},
                  {3, -0.4064465721283450},
                  {4, -0.4039455665149794},
                  {5, 0.2607966765422943},
                  {6, 0.1106761861269975},
                  {7, 0.2939904342435596e-6},
                  {8, -0.2840029933642329e-7},
                  {9, 0.7267198267264553e-3},
                  {10, 0.7929487196960840e-3},
                  {11, -0.7255283495698965e-3},
                  {12, -0.7941401968526521e-3},
                  {13, 0.7088495416976114e-4},
                  {14, 0.2390059075236570e-4}}};

}  // namespace apsis
