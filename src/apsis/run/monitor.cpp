#include <apsis/run/monitor.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/row_check.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsis {

namespace {

/// Compensated summation (Neumaier 1974), accurate to one or two roundings for any number of cells.
class compensated_sum {
 public:
  void add(double x) {
    const double sum = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0.0, lost_ = 0.0;
};

}  // namespace

monitor::totals monitor::sum(const field& u) const {
  const std::size_t count = equation_.invariants().size();
  const auto cells = static_cast<std::size_t>(u.cells());
  std::vector<double> densities(cells * count), entropies(cells), lowest(cells), scales(count);
  std::vector<long> negative(cells);
  constexpr int block = 16;
  parallel_blocks(u.cells(), block, [&](int begin, int end) {
    const profile::section timed(kernel::monitor, static_cast<double>(end - begin) * u.stride(),
                                 {0.0, sizeof(double)});
    for (int cell = begin; cell < end; ++cell) {
      const auto c = static_cast<std::size_t>(cell);
      const double* row = u.row(cell);
      const auto [low, below] = find_extremes(row, u.components());
      lowest[c] = low;
      negative[c] = below;
      equation_.invariant_densities(row, densities.data() + c * count);
      if (equation_.has_entropy() && below == 0) entropies[c] = equation_.entropy(row);
    }
  });

  totals t{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0), 0.0,
           std::numeric_limits<double>::infinity(), 0};
  std::vector<compensated_sum> invariants(count), sizes(count);
  compensated_sum entropy;
  for (std::size_t c = 0; c < cells; ++c) {
    if (std::isnan(lowest[c]))
      throw numerical_error(
          "a value of the state is not finite (the step is unstable, or the data are); use a smaller step",
          {-1, std::numeric_limits<double>::quiet_NaN(), static_cast<long>(c), lowest[c]});
    t.lowest = std::min(t.lowest, lowest[c]);
    t.negative += negative[c];
    entropy.add(entropies[c]);
    equation_.invariant_scales(densities.data() + c * count, scales.data());
    for (std::size_t k = 0; k < count; ++k) {
      invariants[k].add(densities[c * count + k]);
      sizes[k].add(scales[k]);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    t.invariants[k] = volume_ * invariants[k].value();
    t.scales[k] = volume_ * sizes[k].value();
  }
  t.entropy = volume_ * entropy.value();
  if (!equation_.has_entropy() || t.negative > 0) t.entropy = std::numeric_limits<double>::quiet_NaN();
  return t;
}

step_record monitor::start(const field& u) {
  const totals t = sum(u);
  invariants_ = t.invariants;
  scales_ = t.scales;
  return check(u, std::numeric_limits<double>::quiet_NaN());
}

step_record monitor::check(const field& u, double previous_entropy) const {
  const totals t = sum(u);
  step_record record;
  record.min_value = t.lowest;
  record.negative_values = t.negative;
  record.entropy = t.entropy;
  record.entropy_change = t.entropy - previous_entropy;
  for (std::size_t k = 0; k < t.invariants.size(); ++k)
    record.conservation_defect.push_back(scales_[k] > 0.0
                                             ? std::abs(t.invariants[k] - invariants_[k]) / scales_[k]
                                             : std::abs(t.invariants[k]));
  return record;
}

}  // namespace apsis
