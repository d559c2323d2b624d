#include <apsis/verify/stiff_problem.hpp>

#include <cmath>
#include <numbers>

namespace apsis {
namespace brusselator_problem {
namespace {

constexpr std::size_t points = 500;
constexpr double width = 1.0 / (points + 1);

/// u and v on a line, alternating: u' = 1 + u²v − 4u + u_xx/50, v' = 3u − u²v + v_xx/50, u = 1 and v = 3 at
/// both ends.
struct formula {
  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    constexpr double spread = 1.0 / 50.0 / (width * width);
    for (std::size_t j = 0; j < points; ++j) {
      const auto &u = y[2 * j], &v = y[2 * j + 1];
      const auto square = u * u * v;
      f[2 * j] = 1.0 + square - 4.0 * u - 2.0 * spread * u;
      f[2 * j + 1] = 3.0 * u - square - 2.0 * spread * v;
      for (std::size_t species = 0; species < 2; ++species) {
        const std::size_t k = 2 * j + species;
        const double at_end = species == 0 ? 1.0 : 3.0;
        f[k] += j > 0 ? spread * y[k - 2] : spread * at_end + 0.0 * y[k];
        f[k] += j + 1 < points ? spread * y[k + 2] : spread * at_end + 0.0 * y[k];
      }
    }
  }
};

std::vector<double> start() {
  std::vector<double> y(2 * points, 3.0);
  for (std::size_t j = 0; j < points; ++j)
    y[2 * j] = 1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * static_cast<double>(j + 1) * width);
  return y;
}

}  // namespace
}  // namespace brusselator_problem

extern const stiff_problem_entry stiff_problem_brusselator;
const stiff_problem_entry stiff_problem_brusselator = {
    .name = "brusselator",
    .description = "reaction and diffusion on a line, 1000 unknowns",
    .source = "Hairer & Wanner, Solving ODEs II, section IV.10, BRUSS",
    .origin = "Radau IIA of order 5 of SciPy 1.10 with rtol 1e-11, atol 1e-13",
    .times = {0, 10},
    .sizes = {1},
    .slow = true,
    .start = brusselator_problem::start,
    .rate = [](std::size_t) { return make_stiff_rate(brusselator_problem::formula{}); },
    .reference = {{0, 0.9949197002318},
                  {1, 3.005348906815},
                  {249, 3.458657216774},
                  {250, 0.5377285332021},
                  {251, 3.460164392405},
                  {499, 3.526669239590},
                  {500, 0.4426852512601},
                  {501, 3.526754714450},
                  {998, 0.9949443665673},
                  {999, 3.005497999748}},
    .pattern = [] { return sparsity_pattern::banded(2 * brusselator_problem::points, 2, 2); }};

}  // namespace apsis
