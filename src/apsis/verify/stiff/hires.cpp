#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace hires_problem {
namespace {

/// Eight species of the response of plants to light.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    const auto bind = 280.0 * y[5] * y[7];
    f[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
    f[1] = 1.71 * y[0] - 8.75 * y[1];
    f[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
    f[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
    f[4] = -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6];
    f[5] = -1.0 * bind + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
    f[6] = bind - 1.81 * y[6];
    f[7] = -1.0 * bind + 1.81 * y[6];
  }
};

}  // namespace
}  // namespace hires_problem

extern const stiff_problem_entry stiff_problem_hires;
const stiff_problem_entry stiff_problem_hires = {
    .name = "hires",
    .description = "high irradiance response of a plant, eight species",
    .source = "Schaefer (1975)",
    .origin = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), HIRES",
    .times = {0, 321.8122},
    .sizes = {1e-4},
    .start = [] { return std::vector<double>{1, 0, 0, 0, 0, 0, 0, 0.0057}; },
    .rate = [](std::size_t) { return make_stiff_rate(hires_problem::formula{}); },
    .reference = {{0, 0.7371312573325668e-3},
                  {1, 0.1442485726316185e-3},
                  {2, 0.5888729740967575e-4},
                  {3, 0.1175651343283149e-2},
                  {4, 0.2386356198831331e-2},
                  {5, 0.6238968252742796e-2},
                  {6, 0.2849998395185769e-2},
                  {7, 0.2850001604814231e-2}}};

}  // namespace apsis
