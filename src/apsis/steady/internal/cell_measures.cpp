#include <apsis/steady/internal/cell_measures.hpp>

#include <apsis/core/exact_sum.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/model/gas_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace apsis {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double tiny = std::numeric_limits<double>::min();

/// Returns Σ x², as eight partial sums that vector instructions add in parallel.
double sum_of_squares(const double* x, int n) {
  constexpr int chains = 8;
  std::array<double, chains> sums{};
  int k = 0;
  for (; k + chains <= n; k += chains)
    for (int j = 0; j < chains; ++j) sums[at(j)] += x[k + j] * x[k + j];
  for (int j = 0; k + j < n; ++j) sums[at(j)] += x[k + j] * x[k + j];
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double global_highest(communicator& processes, double mine) {
  return -global_lowest(processes, -mine);
}

}  // namespace

cell_measures::cell_measures(const relaxation_model& equation, const problem_builder& space,
                             const cell_links& links)
    : equation_(equation),
      space_(space),
      links_(links),
      processes_(space.processes()),
      count_(at(equation.moment_count())),
      cells_(global_count(processes_, static_cast<std::int64_t>(links.cells().size()))) {}

void cell_measures::moments_of(const field& u, std::vector<double>& to) const {
  parallel_blocks(u.cells(), cells_of_a_block, [&](int begin, int end) {
    equation_.moments_of_rows(u.row(begin), u.stride(), end - begin, to.data() + at(begin) * count_);
  });
}

std::vector<double> cell_measures::scales_of(const double* moments) const {
  std::vector<double> found(moments, moments + count_);
  if (equation_.invariants().size() == count_) {
    equation_.invariant_scales({moments, count_}, found.data());
  } else {
    for (double& x : found) x = std::abs(x);
  }
  return found;
}

std::vector<double> cell_measures::sums(const std::vector<double>& omega) const {
  std::vector<exact_sum> all(count_);
  for (const int cell : links_.cells())
    for (std::size_t i = 0; i < count_; ++i) all[i].add(links_.volume(cell) * omega[at(cell) * count_ + i]);
  return global_values(processes_, all);
}

std::vector<double> cell_measures::largest_scales(const std::vector<double>& omega) const {
  std::vector<double> largest(count_, tiny);
  for (const int cell : links_.cells()) {
    const auto here = scales_of(omega.data() + at(cell) * count_);
    for (std::size_t i = 0; i < count_; ++i) largest[i] = std::max(largest[i], here[i]);
  }
  for (double& scale : largest) scale = global_highest(processes_, scale);
  return largest;
}

/// Returns the square root of the sum of square_of_cell(cell).
template <class Square>
double cell_measures::root_of_sum(const Square& square_of_cell) const {
  std::vector<double> squares(links_.cells().size());
  parallel_blocks(static_cast<int>(squares.size()), cells_of_a_block, [&](int begin, int end) {
    for (int n = begin; n < end; ++n) squares[at(n)] = square_of_cell(links_.cells()[at(n)]);
  });
  std::array<exact_sum, 1> all;
  for (const double square : squares) all[0].add(square);
  return std::sqrt(global_values(processes_, all)[0]);
}

double cell_measures::norm(const field& r) const {
  return root_of_sum([&](int cell) { return sum_of_squares(r.row(cell), r.components()); });
}

double cell_measures::weighted_norm(const field& f, std::span<const double> rates) const {
  return root_of_sum([&](int cell) {
    return rates[at(cell)] * rates[at(cell)] * sum_of_squares(f.row(cell), f.components());
  });
}

double cell_measures::largest_relative_change(const std::vector<double>& omega,
                                              const std::vector<double>& changes) const {
  double largest = 0.0;
  for (const int cell : links_.cells()) {
    const std::size_t first = at(cell) * count_;
    const auto here = scales_of(omega.data() + first);
    for (std::size_t i = 0; i < count_; ++i) {
      const double relative = std::abs(changes[first + i]) / std::max(here[i], tiny);
      if (!(relative <= largest)) largest = std::isnan(relative) ? infinite : relative;
    }
  }
  return global_highest(processes_, largest);
}

double cell_measures::largest_share(const std::vector<double>& omega, const std::vector<double>& changes,
                                    double most) const {
  double share = 1.0;
  if (equation_.as_gas() == nullptr) return share;
  for (const int cell : links_.cells())
    for (const std::size_t i : {std::size_t{0}, count_ - 1}) {
      const std::size_t k = at(cell) * count_ + i;
      share = std::min(share, most * omega[k] / std::max(std::abs(changes[k]), 1e-300));
    }
  return global_lowest(processes_, share);
}

bool cell_measures::keeps_temperature(const std::vector<double>& before, const std::vector<double>& after,
                                      double share) const {
  const gas_model* gas = equation_.as_gas();
  if (gas == nullptr) return true;
  double least = 1.0;
  for (const int cell : links_.cells()) {
    const double *from = before.data() + at(cell) * count_, *to = after.data() + at(cell) * count_;
    const double kept =
        to[0] > 0.0 ? gas->molecules().state(to).T / gas->molecules().state(from).T : -infinite;
    least = std::isnan(kept) ? -infinite : std::min(least, kept);
  }
  return global_lowest(processes_, least) >= share;
}

double cell_measures::extent() const {
  const grid& mesh = space_.whole_mesh();
  double shortest = infinite;
  for (int d = 0; d < mesh.dimensions(); ++d) shortest = std::min(shortest, mesh.spacing(d) * mesh.cells(d));
  return shortest;
}

double cell_measures::thermal_speed(const std::vector<double>& omega) const {
  double speed = 0.0;
  if (const gas_model* gas = equation_.as_gas()) {
    speed = infinite;
    if (!links_.cells().empty())
      speed = std::sqrt(gas->molecules().state(omega.data() + at(links_.cells().front()) * count_).T);
    return global_lowest(processes_, speed);
  }
  for (int d = 0; d < space_.mesh().dimensions(); ++d)
    for (const double v : equation_.speeds(d)) speed = std::max(speed, std::abs(v));
  return speed;
}

double cell_measures::largest_optical_width(const std::vector<double>& omega,
                                            std::span<const double> rates) const {
  double width = 0.0, rate = 0.0;
  for (int d = 0; d < space_.mesh().dimensions(); ++d) width = std::max(width, space_.mesh().spacing(d));
  for (const int cell : links_.cells()) rate = std::max(rate, rates[at(cell)]);
  return width * global_highest(processes_, rate) / thermal_speed(omega);
}

double cell_measures::mean(std::span<const double> of_cells) const {
  std::array<exact_sum, 1> sum;
  for (const int cell : links_.cells()) sum[0].add(of_cells[at(cell)]);
  return global_values(processes_, sum)[0] / static_cast<double>(cells_);
}

}  // namespace apsis
