#pragma once

#include <apsis/integrate/integrate.hpp>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace apsis {

/// One integration with `steps` equal steps of length dt.
struct observed_order {
  long steps;    ///< number of steps
  double dt;     ///< length of a step
  double error;  ///< distance to the reference
  double order;  ///< log(error before/error)/log(dt before/dt); NaN in the first row
};

/// Returns the observed order of a method on any problem (also of a user's type, see integrate/problem.hpp).
/// Integrates u' = T + Q from `start` at t0 to t1 with each number of steps, coarse to fine, through the
/// stepper. Errors are distance(u(t1), reference), with a function of two states that returns a number. They
/// are dimensionless if the problem is. Throws the errors of integrate().
template <problem P, class Distance>
std::vector<observed_order> observed_orders(const method& m, P& p, const typename P::state& start,
                                            typename P::real t0, typename P::real t1,
                                            const std::vector<long>& steps,
                                            const typename P::state& reference, Distance&& distance) {
  using real = typename P::real;
  std::vector<observed_order> rows;
  for (const long n : steps) {
    stepper march(m, p);
    auto u = start;
    const real dt = (t1 - t0) / static_cast<real>(n);
    integrate(march, u, t0, t1, step_rule<real>::fixed(dt));
    observed_order row{n, static_cast<double>(dt), static_cast<double>(distance(u, reference)),
                       std::numeric_limits<double>::quiet_NaN()};
    if (!rows.empty())
      row.order = std::log(rows.back().error / row.error) / std::log(rows.back().dt / row.dt);
    rows.push_back(row);
  }
  return rows;
}

/// Returns the observed order without a reference. Compares each run with the next finer one; the finest run
/// has no row. Differences of consecutive runs show the order without the error of a reference.
template <problem P, class Distance>
std::vector<observed_order> observed_orders(const method& m, P& p, const typename P::state& start,
                                            typename P::real t0, typename P::real t1,
                                            const std::vector<long>& steps, Distance&& distance) {
  std::vector<typename P::state> ends;
  const auto keep = [&ends](const auto& u, const auto&) {
    ends.push_back(u);
    return 0.0;
  };
  auto rows = observed_orders(m, p, start, t0, t1, steps, start, keep);
  if (!rows.empty()) rows.pop_back();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k].error = static_cast<double>(distance(ends[k], ends[k + 1]));
    rows[k].order = k == 0
                        ? std::numeric_limits<double>::quiet_NaN()
                        : std::log(rows[k - 1].error / rows[k].error) / std::log(rows[k - 1].dt / rows[k].dt);
  }
  return rows;
}

}  // namespace apsis
