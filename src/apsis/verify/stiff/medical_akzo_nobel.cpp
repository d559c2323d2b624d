#include <apsis/verify/stiff_problem.hpp>

namespace apsis {
namespace medical_akzo_nobel_problem {
namespace {

constexpr std::size_t cells = 200;

/// An antibody diffuses from the left into a tissue of immobile receptors. Each cell has a pair of unknowns.
struct formula {
  double left;  ///< concentration at the left end, which jumps

  template <class T, class U, class V>
  void operator()(const T&, const U& y, V& f) const {
    constexpr double width = 1.0 / cells;
    for (std::size_t j = 0; j < cells; ++j) {
      const double off = static_cast<double>(j + 1) * width - 1.0;
      const double drift = off * off * off / 8.0 / (2.0 * width),
                   spread = off * off * off * off / 16.0 / (width * width);
      const auto bound = 100.0 * y[2 * j] * y[2 * j + 1];
      f[2 * j + 1] = -1.0 * bound;
      if (j == 0)
        f[0] = drift * (y[2] - left) + spread * (left - 2.0 * y[0] + y[2]) - bound;
      else if (j + 1 < cells)
        f[2 * j] = drift * (y[2 * j + 2] - y[2 * j - 2]) +
                   spread * (y[2 * j - 2] - 2.0 * y[2 * j] + y[2 * j + 2]) - bound;
      else
        f[2 * j] = drift * (y[2 * j] - y[2 * j - 2]) + spread * (y[2 * j - 2] - y[2 * j]) - bound;
    }
  }
};

std::vector<double> start() {
  std::vector<double> y(2 * cells, 0.0);
  for (std::size_t j = 0; j < cells; ++j) y[2 * j + 1] = 1.0;
  return y;
}

}  // namespace
}  // namespace medical_akzo_nobel_problem

extern const stiff_problem_entry stiff_problem_medical_akzo_nobel;
const stiff_problem_entry stiff_problem_medical_akzo_nobel = {
    .name = "medical-akzo-nobel",
    .description = "diffusion and reaction of 400 unknowns, a boundary value that jumps",
    .source = "Mazzia & Magherini, Test Set for IVP Solvers 2.4 (2008), MEDAKZO",
    .origin =
        "Radau IIA of order 5 of SciPy 1.10 with rtol 1e-10, atol 1e-14, for the unknowns that the test set "
        "prints",
    .times = {0, 5, 20},
    .sizes = {1e-4},
    .slow = true,
    .start = medical_akzo_nobel_problem::start,
    .rate =
        [](std::size_t piece) {
          return make_stiff_rate(medical_akzo_nobel_problem::formula{piece == 0 ? 2.0 : 0.0});
        },
    .reference = {{78, 0.233994222296e-3},
                  {79, 0},
                  {148, 0.359561602578e-3},
                  {149, 0},
                  {198, 0.117374129616e-3},
                  {199, 0.619082202429e-5},
                  {238, 0.686009484592e-11},
                  {239, 0.9999997325855}},
    .pattern = [] { return sparsity_pattern::banded(2 * medical_akzo_nobel_problem::cells, 2, 2); }};

}  // namespace apsis
