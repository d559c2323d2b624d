#include <apsis/run/monitor.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/row_check.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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
  std::vector<double> densities(cells * count), entropies(cells), scales(cells * count),
      lowest(cells, std::numeric_limits<double>::infinity());  // of solid cells
  std::vector<long> negative(cells);
  const bool conditional = !equation_.condition().empty();
  std::vector<char> violates(conditional ? cells : 0);
  constexpr int block = 16;
  const std::vector<cell_range> all = {{0, u.cells()}};
  const auto check = [&](int begin, int end) {
    const profile::section timed(kernel::monitor, static_cast<double>(end - begin) * u.stride(),
                                 {0.0, sizeof(double)});
    for (int cell = begin; cell < end; ++cell) {
      const auto c = static_cast<std::size_t>(cell);
      const double* row = u.row(cell);
      const auto [low, below] = find_extremes(row, u.components());
      lowest[c] = low;
      negative[c] = below;
      equation_.invariant_densities(row, densities.data() + c * count);
      equation_.invariant_scales(densities.data() + c * count, scales.data() + c * count);
      if (conditional) violates[c] = equation_.check_supported(row).problem.empty() ? 0 : 1;
      if (equation_.has_entropy() && below == 0) entropies[c] = equation_.entropy(row);
    }
  };
  parallel_blocks(u.cells(), block, [&](int begin, int end) {
    for_cells_in(cells_.empty() ? all : cells_, begin, end, check);
  });

  totals t{std::vector<double>(count, 0.0),
           std::vector<double>(count, 0.0),
           0.0,
           std::numeric_limits<double>::infinity(),
           0,
           -1};
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
    for (std::size_t k = 0; k < count; ++k) {
      invariants[k].add(densities[c * count + k]);
      sizes[k].add(scales[c * count + k]);
    }
    if (conditional && t.violating < 0 && violates[c] != 0) t.violating = static_cast<long>(c);
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
  step_record record;
  record.received.assign(ends_.size() * invariants_.size(), 0.0);
  record.flux = record.received;
  record.min_value = t.lowest;
  record.negative_values = t.negative;
  record.entropy = t.entropy;
  record.entropy_change = std::numeric_limits<double>::quiet_NaN();
  compare(t, invariants_, record.flux, record);
  return record;
}

std::size_t monitor::size_of_gains() const {
  return invariants_.size() * std::accumulate(ends_.begin(), ends_.end(), std::size_t{0});
}

step_record monitor::check(const field& u, double dt, const step_record& previous) const {
  const totals t = sum(u);
  step_record record;
  record.min_value = t.lowest;
  record.negative_values = t.negative;
  record.entropy = t.entropy;
  record.entropy_change = t.entropy - previous.entropy;
  record.violation = violation_in(u, t);
  const std::vector<double> gained = gained_through_faces(u.gains());
  for (std::size_t k = 0; k < entropy_bounds_.size(); ++k)
    record.entropy_change -= entropy_bounds_[k] * gained[k];
  record.received = previous.received;
  for (std::size_t k = 0; k < gained.size(); ++k) {
    record.received[k] += gained[k];
    record.flux.push_back(gained[k] / dt);
  }
  compare(t, previous.total, gained, record);
  return record;
}

/// The sums of the gains of all ends at each face, [face][invariant].
std::vector<double> monitor::gained_through_faces(const std::vector<double>& gains) const {
  const std::size_t count = invariants_.size();
  std::vector<double> sums;
  std::size_t first = 0;
  for (const std::size_t ends : ends_) {
    std::vector<compensated_sum> sum(count);
    for (std::size_t k = first; k < std::min(first + ends * count, gains.size()); ++k)
      sum[(k - first) % count].add(gains[k]);
    first += ends * count;
    for (const auto& one : sum) sums.push_back(one.value());
  }
  return sums;
}

std::optional<condition_violation> monitor::violation_in(const field& u, const totals& t) const {
  if (t.violating < 0) return std::nullopt;
  const double* row = u.row(static_cast<int>(t.violating));
  return condition_violation{t.violating, row[0], equation_.check_supported(row).problem};
}

void monitor::compare(const totals& t, const std::vector<double>& before, const std::vector<double>& gained,
                      step_record& record) const {
  record.total = t.invariants;
  const std::size_t count = invariants_.size();
  for (std::size_t k = 0; k < count; ++k) {
    double received = 0.0, passed = 0.0, in_step = 0.0;
    for (std::size_t f = 0; f < ends_.size(); ++f) {
      received += record.received[f * count + k];
      passed += std::abs(record.received[f * count + k]);
      in_step += gained[f * count + k];
    }
    const double content = std::max(scales_[k], t.scales[k]), all = std::max(content, passed);
    const double defect = std::abs(t.invariants[k] - invariants_[k] - received),
                 of_step = std::abs(t.invariants[k] - before[k] - in_step);
    record.conservation_defect.push_back(all > 0.0 ? defect / all : defect);
    record.defect_of_step.push_back(content > 0.0 ? of_step / content : of_step);
  }
}

}  // namespace apsis
