#include <apsis/run/monitor.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/mesh/on_host.hpp>
#include <apsis/scheme/row_check.hpp>
#include <apsis/semidiscrete/force_losses.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace apsis {

struct monitor::partial {
  std::vector<exact_sum> sums;  ///< of invariants, their scales, change and turn of the last one, entropy
  std::vector<double> densities, scales;                    ///< densities and scales of the cells of a block
  double lowest = std::numeric_limits<double>::infinity();  ///< smallest value; infinity without cells of gas
  long negative = 0;
  int not_finite = none, violating = none;  ///< first cell of each kind
  double value = 0.0;                       ///< the value that is not finite
  velocity_extremes velocities;

  static constexpr int none = std::numeric_limits<int>::max();
};

monitor::monitor(const run_setup& setup)
    : setup_(setup),
      equation_(*setup.equation),
      of_rows_(dynamic_cast<const checks_of_rows*>(setup.equation.get())),
      on_device_(setup.runs_on() == nullptr
                     ? nullptr
                     : device_row_checks::make(*setup.runs_on(), equation_, setup.mesh())),
      entropy_(equation_.entropy()),
      volume_(setup.cell_volume()),
      ends_(setup.open_ends()),
      entropy_bounds_(setup.entropy_bounds().value_or(std::vector<double>{})),
      torques_(setup),
      parts_(std::make_unique<per_thread<partial>>()),
      differences_(setup.mesh().size()),
      velocities_(setup),
      losses_(setup.config().force.acceleration ? force_losses::size(equation_.invariants().size()) : 0) {}

monitor::~monitor() = default;

namespace {

constexpr int cells_of_block = 16;

}  // namespace

/// Reads the rows once, cell by cell. Evaluates formulas of the densities for all cells together.
void monitor::check_cells(const field& u, int begin, int end, partial& own) const {
  const auto cells = static_cast<std::size_t>(end - begin), count = equation_.invariants().size();
  const profile::section timed(kernel::monitor, static_cast<double>(cells) * u.stride(),
                               {0.0, sizeof(double)});
  std::array<bool, cells_of_block> finite{};
  for (std::size_t k = 0; k < cells; ++k)
    finite[k] = check_row(u, begin + static_cast<int>(k), own.densities.data() + k * count, own);
  find_scales(end - begin, own);
  for (std::size_t k = 0; k < cells; ++k)
    if (finite[k])
      add_densities(begin + static_cast<int>(k), {own.densities.data() + k * count, count},
                    own.scales.data() + k * count, own);
  if (const int fit = cells_with_condition(u, begin, end); fit < end - begin)
    own.violating = std::min(own.violating, begin + fit);
}

void monitor::find_scales(int cells, partial& own) const {
  const std::size_t count = equation_.invariants().size(), all = static_cast<std::size_t>(cells) * count;
  if (of_rows_ != nullptr)
    return of_rows_->invariant_scales_of_rows({own.densities.data(), all}, cells, own.scales.data());
  for (std::size_t first = 0; first < all; first += count)
    equation_.invariant_scales({own.densities.data() + first, count}, own.scales.data() + first);
}

/// Returns the number of cells before the first that violates the condition of the model.
int monitor::cells_with_condition(const field& u, int begin, int end) const {
  if (equation_.condition().empty()) return end - begin;
  if (of_rows_ != nullptr) return of_rows_->first_unsupported(u.row(begin), u.stride(), end - begin);
  int fit = begin;
  while (fit < end && equation_.check_supported(u.row(fit)).problem.empty()) ++fit;
  return fit - begin;
}

/// Returns the extremes, densities and entropy of a row. The entropy of rows with negative or invalid
/// values is not computed.
device_row_checks::row monitor::look_at(const field& u, int cell, double* densities) const {
  if (on_device_) {
    const auto found = on_device_->of(cell);
    std::copy_n(found.densities, equation_.invariants().size(), densities);
    return found;
  }
  const double* row = u.row(cell);
  const row_extremes extremes = compute_extremes(row, u.components());
  equation_.invariant_densities(row, densities);
  const bool counts = entropy_ && extremes.negative == 0 && !std::isnan(extremes.lowest);
  return {extremes, densities, counts ? entropy_->density(row) : 0.0};
}

/// Computes the densities of a row, and adds its extremes and entropy to `own`. Returns
/// whether the row is finite.
bool monitor::check_row(const field& u, int cell, double* densities, partial& own) const {
  const device_row_checks::row found = look_at(u, cell, densities);
  const auto [low, below] = found.extremes;
  if (std::isnan(low)) {
    if (cell < own.not_finite) own.value = low;
    own.not_finite = std::min(own.not_finite, cell);
    return false;
  }
  own.lowest = std::min(own.lowest, low);
  own.negative += below;
  if (velocities_.active()) velocities_.look(densities, cell, own.velocities);
  if (entropy_ && below == 0)
    own.sums.back().add(setup_.mesh().gas_share(cell) * entropy_of(found.entropy, cell, densities[0]));
  return true;
}

void monitor::add_densities(int cell, std::span<const double> densities, const double* scales,
                            partial& own) const {
  const double share = setup_.mesh().gas_share(cell);
  const std::size_t count = densities.size();
  for (std::size_t k = 0; k < count; ++k) {
    own.sums[k].add(share * densities[k]);
    own.sums[count + k].add(share * scales[k]);
  }
  if (count == 0) return;
  const auto [change, turn] = differences_.record(cell, densities.back());
  own.sums[2 * count].add(share * change);
  own.sums[2 * count + 1].add(share * turn);
}

/// Returns the entropy of a cell, from the entropy and the density of its row. About an axis the row is r f,
/// with density r ρ, and r η(f) = η(r f) − r ρ log r for a gas.
double monitor::entropy_of(double entropy, int cell, double density) const {
  if (!setup_.mesh().has_axis()) return entropy;
  return entropy - density * std::log(setup_.mesh().radius(setup_.mesh().centre(cell)));
}

/// Returns the state where its rows are checked: on the device if possible, otherwise a copy on the host.
const field& monitor::checkable(const field& u, field& room) const {
  return on_device_ ? u : on_host(u, room);
}

/// Returns the sums and extremes over the cells of this process, added over all threads.
monitor::partial monitor::check_block(const field& u) const {
  const std::size_t count = equation_.invariants().size();
  partial empty;
  empty.sums.resize(2 * count + 3);
  empty.densities.resize(cells_of_block * count);
  empty.scales.resize(cells_of_block * count);
  std::vector<partial*> parts;
  if (on_device_) on_device_->evaluate(u);
  const loops_over numbers(u.size());
  parts_->prepare([&](partial& own) {
    own = empty;
    parts.push_back(&own);
  });
  parallel_blocks(u.cells(), cells_of_block, [&](int begin, int end) {
    for_cells_in(setup_.mesh().fluid(), begin, end,
                 [&](int from, int to) { check_cells(u, from, to, parts_->here()); });
  });
  for (const partial* own : parts) {
    for (std::size_t k = 0; k < empty.sums.size(); ++k) empty.sums[k].add(own->sums[k]);
    empty.lowest = std::min(empty.lowest, own->lowest);
    empty.negative += own->negative;
    if (own->not_finite < empty.not_finite) empty.value = own->value;
    empty.not_finite = std::min(empty.not_finite, own->not_finite);
    empty.violating = std::min(empty.violating, own->violating);
    empty.velocities.add(own->velocities);
  }
  return empty;
}

monitor::totals monitor::sum(const field& u) const {
  const std::size_t count = equation_.invariants().size();
  partial mine = check_block(u);
  communicator& processes = setup_.processes();
  run_collectively(processes, [&] {
    if (mine.not_finite != partial::none)
      throw numerical_error(
          "a value of the state is not finite (unstable step or invalid data); use a smaller step",
          {-1, std::numeric_limits<double>::quiet_NaN(), setup_.number_in_whole_mesh(mine.not_finite),
           mine.value});
  });
  const std::vector<double> sums = global_values(processes, mine.sums);
  std::array<std::int64_t, 2> counts = {mine.negative, mine.violating == partial::none ? 0 : 1};
  processes.sum(counts);
  totals t;
  std::array<double, 3> least = {mine.lowest, mine.velocities.margins.room,
                                 mine.velocities.margins.resolution};
  processes.lowest(least);
  t.lowest = least[0];
  t.velocities = mine.velocities;
  t.margins = {least[1], least[2]};
  t.negative = counts[0];
  t.violated = counts[1] > 0;
  if (mine.violating != partial::none) t.violating = mine.violating;
  for (std::size_t k = 0; k < count; ++k) {
    t.invariants.push_back(volume_ * sums[k]);
    t.scales.push_back(volume_ * sums[count + k]);
  }
  if (count > 0 && sums[2 * count - 1] > 0.0) {
    t.change = sums[2 * count] / sums[2 * count - 1];
    t.turn = sums[2 * count + 1] / sums[2 * count - 1];
  }
  t.entropy = !entropy_ || t.negative > 0 ? std::numeric_limits<double>::quiet_NaN() : volume_ * sums.back();
  return t;
}

step_record monitor::start(const field& state) {
  field room;
  const field& u = checkable(state, room);
  totals t = sum(u);
  invariants_ = t.invariants;
  scales_ = t.scales;
  if (velocities_.active()) {
    velocities_.set_mass(invariants_.front());
    differences_.restart();
    t = sum(u);  // now without cells of little mass
  }
  keep_velocities(t);
  step_record record;
  if (!equation_.cut_moment().empty()) record.cut = {0.0};
  record.received.assign(ends_.size() * invariants_.size(), 0.0);
  record.flux = record.received;
  if (!losses_.empty()) record.lost.assign(invariants_.size() - 1, 0.0);
  record.torque = torques_.of({});
  record.min_value = t.lowest;
  record.negative_values = t.negative;
  record.entropy = t.entropy;
  record.entropy_change = std::numeric_limits<double>::quiet_NaN();
  compare(t, invariants_, record.flux, record);
  return record;
}

void monitor::keep_velocities(const totals& t) {
  extremes_ = t.velocities;
  margins_ = t.margins;
}

void monitor::watch_velocities(const field& u, const step_record& last, run_summary& summary) {
  if (last.step == 0) return velocities_.start(extremes_, margins_, u, summary);
  if (!losses_.empty() && losses_[force_losses::held] > 0.0)
    velocities_.add_held(losses_[force_losses::held] / last.total.front(), u, last, summary);
  if (!losses_.empty()) velocities_.add_lost(u, last, summary);
  velocities_.update(extremes_, margins_, u, last, summary);
}

step_record monitor::check(const budgeted_state& after, double dt, const step_record& previous, double cut) {
  field room;
  const field& u = checkable(after.unknowns, room);
  if (velocities_.active()) velocities_.set_mass(previous.total.front());
  const totals t = sum(u);
  keep_velocities(t);
  step_record record;
  if (!previous.cut.empty()) record.cut = {0.0 - global_lowest(setup_.processes(), -cut)};
  record.min_value = t.lowest;
  record.negative_values = t.negative;
  record.entropy = t.entropy;
  record.entropy_change = t.entropy - previous.entropy;
  record.violation = violation_in(u, t);
  record.density_change = t.change;
  record.density_turn = t.turn;
  record.torque = torques_.of(after.budget.amounts());
  for (double& torque : record.torque) torque /= dt;
  std::vector<double> received = received_through_faces(after.budget.amounts());
  take_losses(received, dt, t, record);
  for (std::size_t k = 0; k < entropy_bounds_.size(); ++k)
    record.entropy_change -= entropy_bounds_[k] * received[k];
  record.received = previous.received;
  for (std::size_t k = 0; k < received.size(); ++k) {
    record.received[k] += received[k];
    record.flux.push_back(received[k] / dt);
  }
  compare(t, previous.total, received, record);
  return record;
}

/// Moves the losses of a force from the end of `received` into the record.
void monitor::take_losses(std::vector<double>& received, double dt, const totals& t, step_record& record) {
  const auto first = received.end() - static_cast<std::ptrdiff_t>(losses_.size());
  std::copy(first, received.end(), losses_.begin());
  received.erase(first, received.end());
  if (losses_.empty()) return;
  const double drive = losses_.back();
  double square = 0.0;
  for (std::size_t k = force_losses::lost; k + 1 < losses_.size(); ++k) {
    record.lost.push_back(losses_[k] / dt);
    if (k + 2 < losses_.size()) square += losses_[k] * losses_[k];
  }
  if (!(drive > 0.0)) return;
  const double speed = std::sqrt(2.0 * t.invariants.back() / t.invariants.front());
  record.lost_share = {std::sqrt(square) / drive, std::abs(record.lost.back() * dt) / (speed * drive)};
}

/// Returns the amounts summed over the ends of each face, [face][invariant], then the losses of a force.
std::vector<double> monitor::received_through_faces(const std::vector<double>& amounts) const {
  const std::size_t count = invariants_.size();
  std::vector<exact_sum> sums(ends_.size() * count + losses_.size());
  std::size_t first = 0;
  for (std::size_t face = 0; face < ends_.size(); ++face) {
    for (std::size_t k = first; k < std::min(first + ends_[face] * count, amounts.size()); ++k)
      sums[face * count + (k - first) % count].add(amounts[k]);
    first += ends_[face] * count;
  }
  for (std::size_t k = first; k < amounts.size(); ++k) sums[ends_.size() * count + k - first].add(amounts[k]);
  return global_values(setup_.processes(), sums);
}

/// Returns the violation in the first such cell of the mesh; nothing without one.
std::optional<condition_violation> monitor::violation_in(const field& u, const totals& t) const {
  if (!t.violated) return std::nullopt;
  // An error makes all processes agree on the first cell.
  try {
    run_collectively(setup_.processes(), [&] {
      if (t.violating < 0) return;
      const double* row = u.row(t.violating);
      const auto found = equation_.check_supported(row);
      throw numerical_error(found.reached.empty() ? found.problem : found.reached,
                            {-1, 0.0, setup_.number_in_whole_mesh(t.violating), row[0]});
    });
  } catch (const numerical_error& first) {
    return condition_violation{first.site().cell, first.site().value, first.problem()};
  }
  return std::nullopt;
}

void monitor::compare(const totals& t, const std::vector<double>& before, const std::vector<double>& received,
                      step_record& record) const {
  record.total = t.invariants;
  const std::size_t count = invariants_.size();
  for (std::size_t k = 0; k < count; ++k) {
    double since_start = 0.0, passed = 0.0, in_step = 0.0;
    for (std::size_t f = 0; f < ends_.size(); ++f) {
      since_start += record.received[f * count + k];
      passed += std::abs(record.received[f * count + k]);
      in_step += received[f * count + k];
    }
    const double content = std::max(scales_[k], t.scales[k]), all = std::max(content, passed);
    const double defect = std::abs(t.invariants[k] - invariants_[k] - since_start),
                 of_step = std::abs(t.invariants[k] - before[k] - in_step);
    record.conservation_defect.push_back(all > 0.0 ? defect / all : defect);
    record.defect_of_step.push_back(content > 0.0 ? of_step / content : of_step);
  }
}

}  // namespace apsis
