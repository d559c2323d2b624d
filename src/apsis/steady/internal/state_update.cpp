#include <apsis/steady/internal/state_update.hpp>

#include <apsis/semidiscrete/gathered_cells.hpp>

#include <cstddef>
#include <utility>

namespace apsis {
namespace {

/// One iteration leaves at least this part of the temperature of every cell.
constexpr double lowest_cooling = 0.1;
/// Smallest part to which a correction is reduced for that purpose.
constexpr double smallest_share = 1e-3;

std::vector<double> sum_of(const std::vector<double>& a, double share, const std::vector<double>& b) {
  std::vector<double> found(a);
  for (std::size_t k = 0; k < a.size(); ++k) found[k] += share * b[k];
  return found;
}

}  // namespace

state_update::state_update(const problem_builder& space, const cell_measures& cells,
                           const std::vector<double>& start, int depth)
    : space_(space), cells_(cells), scales_(cells.largest_scales(start)), mixture_(depth) {}

void state_update::apply(const plan& how, const std::vector<double>& omega, const field& delta, field& f) {
  std::vector<double> change(omega.size());
  cells_.moments_of(delta, change);
  double share = 1.0;
  anderson::weights weights{{}, sum_of(omega, 1.0, change)};
  while (share > smallest_share && !cells_.keeps_temperature(omega, weights.of_mixture, lowest_cooling)) {
    share *= 0.5;
    weights.of_mixture = sum_of(omega, share, change);
  }
  const bool mixes = how.mixes && share == 1.0;
  if (mixes) {
    const std::size_t count = scales_.size();
    for (std::size_t k = 0; k < change.size(); ++k) change[k] /= scales_[k % count];
    anderson::weights mixed =
        mixture_.weigh(space_.processes(), gather_cells(space_, std::move(change), static_cast<int>(count)),
                       weights.of_mixture);
    if (cells_.keeps_temperature(omega, mixed.of_mixture, lowest_cooling)) weights = std::move(mixed);
  } else {
    mixture_.clear();
  }
  const double factor = how.total_mass ? *how.total_mass / cells_.sums(weights.of_mixture)[0] : 1.0;
  if (mixes)
    mixture_.move(weights, delta, factor, f);
  else
    move(delta, share, factor, f);
}

}  // namespace apsis
