#include <apsis/steady/internal/equilibrium_changes.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/cell_links.hpp>

#include <cstddef>

namespace apsis {
namespace {

/// A smaller part of a correction is omitted.
constexpr double smallest_part = 1e-3;

}  // namespace

void add_equilibrium_changes(const relaxation_model& equation, const problem_builder& space,
                             const std::vector<int>& cells, const std::vector<double>& omega,
                             const std::vector<double>& changes, double share,
                             const std::vector<double>& rates, field& r) {
  const int count = equation.moment_count();
  parallel_blocks(static_cast<int>(cells.size()), cells_of_a_block, [&](int begin, int end) {
    aligned_vector<double> before(at(r.components())), after(at(r.components()));
    std::vector<double> moved(at(count));
    for (int n = begin; n < end; ++n) {
      const int cell = cells[at(n)];
      const double *here = omega.data() + at(cell * count), *change = changes.data() + at(cell * count);
      if (!equation.equilibrium(here, before.data()))
        throw numerical_error(equation.why_inadmissible(here),
                              {.cell = space.space().number_in_whole_mesh(cell), .value = here[0]});
      for (double part = share; part > smallest_part * share; part *= 0.5) {
        for (std::size_t i = 0; i < at(count); ++i) moved[i] = here[i] + part * change[i];
        if (!equation.equilibrium(moved.data(), after.data())) continue;
        for (std::size_t k = 0; k < after.size(); ++k)
          r.row(cell)[k] += rates[at(cell)] * (after[k] - before[k]);
        break;
      }
    }
  });
}

}  // namespace apsis
