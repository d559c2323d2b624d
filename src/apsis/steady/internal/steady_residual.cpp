#include <apsis/steady/internal/steady_residual.hpp>

#include <apsis/core/index.hpp>

#include <array>

namespace apsis {
steady_residual::steady_residual(const relaxation_model& equation, semidiscrete_problem& problem,
                                 const cell_links& links, const cell_measures& cells,
                                 const std::vector<double>& epsilon, const field& start)
    : r(start.cells(), start.components()),
      omega(at(start.cells() * equation.moment_count())),
      of_transport(omega.size()),
      rates(at(start.cells())),
      equation_(equation),
      problem_(problem),
      links_(links),
      cells_(cells),
      epsilon_(epsilon) {
  cells_.moments_of(start, omega);
  find_rates();
}

void steady_residual::compute(const field& f) {
  const std::array<target<field, double>, 1> fresh = {{{&r, 0.0, 1.0, true}}};
  problem_.add_transport(0.0, f, fresh);
  cells_.moments_of(f, omega);
  cells_.moments_of(r, of_transport);
  const std::array<target<field, double>, 1> added = {{{&r, 0.0, 1.0, false}}};
  problem_.add_collision(0.0, f, added);
  problem_.throw_late_errors();
  find_rates();
}

void steady_residual::find_rates() {
  const int count = equation_.moment_count();
  for (const int cell : links_.cells())
    rates[at(cell)] = equation_.rate(omega.data() + at(cell * count)) / epsilon_[at(cell)];
}

}  // namespace apsis
