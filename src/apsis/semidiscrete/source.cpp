#include <apsis/semidiscrete/source.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/first_error.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/global_integrals.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {

source::source(const model& equation, std::shared_ptr<domain> space, source_rate rate,
               const cell_unknown& unknown)
    : equation_(equation),
      space_(std::move(space)),
      rate_(std::move(rate)),
      points_(unknown.points()),
      values_(space_->mesh().size(), equation.components()) {}

void source::compute_cell(double t, int cell, const field& u, std::vector<double>& row) {
  const grid& mesh = space_->mesh();
  double* sum = values_.row(cell);
  std::fill_n(sum, values_.components(), 0.0);
  for (const auto& [offset, weight] : points_) {
    position x = mesh.centre(cell);
    x[0] += offset * mesh.spacing(0);
    rate_.value(t, x, {u.row(cell), row.size()}, row);
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (!std::isfinite(row[k]) || (row[k] < 0.0 && equation_.positive()))
        throw numerical_error(
            fmt::format("the source is {:g} at x = {:.6g} (it must be finite{}); change its formulas", row[k],
                        x[0], equation_.positive() ? " and not negative" : ""),
            {-1, t, cell, row[k]});
      sum[k] += weight * row[k];
    }
  }
}

void source::compute(double t, const field& u) {
  constexpr int block = 8;
  const std::size_t invariants = equation_.invariants().size();
  std::vector<double> densities(static_cast<std::size_t>(values_.cells()) * invariants);
  first_error failure;
  failure.run([&] {
    parallel_blocks(values_.cells(), block, [&](int begin, int end) {
      const profile::section timed(kernel::forces, static_cast<double>(end - begin) * u.stride(), {});
      std::vector<double> row(static_cast<std::size_t>(values_.components()));
      for (int cell = begin; cell < end; ++cell) {
        if (space_->mesh().solid(cell) < 0) compute_cell(t, cell, u, row);
        equation_.invariant_densities(values_.row(cell),
                                      densities.data() + static_cast<std::size_t>(cell) * invariants);
      }
    });
  });
  given_ = global_integrals(*space_, densities, invariants);
  failure.rethrow();
  known_ = rate_.steady;
}

double source::growth(double t, const field& u) const {
  const auto components = static_cast<std::size_t>(u.components());
  double largest = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    if (space_->mesh().solid(cell) < 0)
      largest = std::max(largest, rate_.growth(t, space_->mesh().centre(cell), {u.row(cell), components}));
  return largest;
}

bool source::update(double t, const field& u) {
  if (known_) return false;
  compute(t, u);
  return true;
}

void source::add(std::span<const target<field, double>> targets, int begin, int end) const {
  const profile::section timed(kernel::forces, static_cast<double>(end - begin) * values_.stride(),
                               traffic(targets));
  for (const auto& to : targets)
    for (int cell = begin; cell < end; ++cell) {
      const double* s = values_.row(cell);
      double* acc = to.acc->row(cell);
      for (int k = 0; k < values_.components(); ++k) acc[k] += to.beta * s[k];
    }
}

}  // namespace apsis
