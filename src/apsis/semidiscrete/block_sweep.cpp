#include <apsis/semidiscrete/block_sweep.hpp>

#include <apsis/scheme/limiter.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {
namespace {

/// Returns the number of cells to join into one row, so that rows with few components fill vectors.
int cells_of_a_row(int stride) {
  constexpr int enough = 64;
  return std::max(1, enough / std::max(stride, 1));
}

}  // namespace

kernel_work traffic(block_sweep::targets_view targets) {
  kernel_work each;
  for (const auto& to : targets) each.bytes += sizeof(double) * (to.fresh ? 1.0 : 2.0);
  return each;
}

std::vector<line_speeds> line_speeds::of(const model& equation, const grid& mesh) {
  std::vector<line_speeds> all;
  const field layout(1, equation.components());
  for (int direction = 0; direction < mesh.dimensions(); ++direction) {
    line_speeds line;
    const auto v = equation.speeds(direction);
    for (int cell = 0; cell < cells_of_a_row(layout.stride()); ++cell)
      for (std::size_t k = 0; k < static_cast<std::size_t>(layout.stride()); ++k) {
        line.per_cell.push_back(k < v.size() ? std::abs(v[k]) / mesh.spacing(direction) : 0.0);
        line.forward.push_back(k < v.size() && v[k] > 0.0 ? 1.0 : 0.0);
      }
    all.push_back(std::move(line));
  }
  return all;
}

aligned_vector<double> line_speeds::rates(const std::vector<line_speeds>& speeds) {
  aligned_vector<double> rates;
  for (const auto& line : speeds) {
    rates.resize(line.per_cell.size());
    for (std::size_t k = 0; k < rates.size(); ++k) rates[k] += line.per_cell[k];
  }
  return rates;
}

void line_speeds::limit_for_steps(std::vector<line_speeds>& speeds, double share, double rate_of_force,
                                  double kappa) {
  aligned_vector<double> rates = line_speeds::rates(speeds);
  if (rates.empty()) return;
  const double longest = *std::max_element(rates.begin(), rates.end()) + kappa * rate_of_force;
  for (double& rate : rates)
    rate = 1.0 / std::max(limiter::least_cfl_number,
                          longest > 0.0 ? share * kappa * ((rate + rate_of_force) / longest) : 1.0);
  for (auto& line : speeds) line.inverse_cfl = rates;
}

void line_speeds::limit_for_steady_states(std::vector<line_speeds>& speeds, double collisions) {
  aligned_vector<double> rates = line_speeds::rates(speeds);
  for (double& rate : rates) rate = limiter::steady_inverse_cfl(rate, collisions);
  for (auto& line : speeds) line.inverse_cfl = rates;
}

void block_sweep::reserve(const context& of, int cells, int cells_of_box, int width, std::size_t targets) {
  of_ = &of;
  halo_ = of.edges.halo();
  reach_ = of.edges.reach();
  const int beyond = 2 * (halo_ + reach_);
  rows_.reserve(static_cast<std::size_t>(cells) + static_cast<std::size_t>(beyond));
  targets_.reserve(targets);
  // A stretch has at least one cell.
  const auto most =
      static_cast<std::size_t>(of.space.mesh().dimensions()) * static_cast<std::size_t>(cells_of_box);
  visited_.reserve(most);
  visited_rows_.reserve(most * (1 + static_cast<std::size_t>(beyond)));
  if (cells_of_a_row(field::padded(of.equation.components())) > 1)
    visited_joined_.reserve(visited_rows_.capacity());
  make_room(cells, width);
  // Also for threads that reach the end of a segment only in a later step.
  const auto longest = static_cast<std::size_t>(width) * static_cast<std::size_t>(cells_of_a_row(width));
  for (auto* row : {&vacuum_, &in_, &out_}) row->resize(std::max(row->size(), longest));
}

void block_sweep::start(const context& of, const field& u) {
  of_ = &of;
  u_ = &u;
  halo_ = of.edges.halo();
  reach_ = of.edges.reach();
  visited_.clear();
  visited_rows_.clear();
  visited_joined_.clear();
}

void block_sweep::visit(const stretch& cells) {
  if (cells.begin == cells.end) return;
  segment_ = &of_->space.segment_at(cells.direction, cells.segment);
  const visited one = {cells, {seen_beyond(false, cells), seen_beyond(true, cells)}, visited_rows_.size()};
  visited_.push_back(one);
  const auto count = static_cast<std::size_t>(rows_of(cells));
  visited_rows_.resize(one.first_row + count, nullptr);
  // Nothing reads more rows beyond a surface than the edges before it need.
  const int first = cells.begin - one.seen[0] - reach_, last = cells.end + one.seen[1] + reach_;
  of_->space.segment_rows(*u_, cells.direction, cells.segment, first, last,
                          visited_rows_.data() + one.first_row + (halo_ - one.seen[0]));
  const int stride = u_->stride();
  if (cells_of_a_row(stride) == 1) return;
  visited_joined_.resize(one.first_row + count, 1);
  const double* const* rows = visited_rows_.data() + one.first_row;
  int* joined = visited_joined_.data() + one.first_row;
  for (std::size_t j = count - 1; j-- > 0;)
    if (rows[j] != nullptr && rows[j] + stride == rows[j + 1]) joined[j] = joined[j + 1] + 1;
}

void block_sweep::run(int first, int last, targets_view targets) {
  for (const visited& one : visited_) sweep(one, first, last, targets);
}

void block_sweep::sweep(const visited& one, int first_component, int last_component, targets_view targets) {
  const place at{one.cells, first_component, last_component};
  prepare(one, at);
  const int cells = at.end - at.begin;
  const double numbers = static_cast<double>(cells) * width_;
  const auto [below, above] = seen_;
  {
    // Another block computes the edges of the halo too.
    const double repeated = 1.0 + static_cast<double>(below + above) / cells;
    const profile::section timed(kernel::edges, numbers,
                                 {repeated * of_->edges.scheme->operations(both_edges()), sizeof(double)});
    for (int i = at.begin - below; i < at.end + above;) {
      const run_of_cells run = run_from(i, at.end + above - i);
      make_edges(i, run);
      i += run.cells * run.joined;
    }
  }
  for (int ghost = at.begin - halo_; ghost < at.begin - below; ++ghost) empty(ghost);
  for (int ghost = at.end + above; ghost < at.end + halo_; ++ghost) empty(ghost);
  const profile::section timed(kernel::fluxes, numbers, work_of(targets, cells));
  const segment_end *lower = surface_at(false, at), *upper = surface_at(true, at);
  for (int i = at.begin; i < at.end;) {
    const run_of_cells run = run_from(i, at.end - i);
    const int next = i + run.cells * run.joined;
    const bool first = lower != nullptr && i == at.begin, last = upper != nullptr && next == at.end;
    add(i, run, at, targets, first || last);
    if (first) record(*lower, false, 0);
    if (last) record(*upper, true, run.joined - 1);
    i = next;
  }
}

/// Returns the surface at which a block ends; null if it does not end at a surface.
const segment_end* block_sweep::surface_at(bool upper, const place& at) const {
  const segment_end& end = segment_->ends[upper ? 1 : 0];
  const bool there = upper ? at.end == segment_->cells : at.begin == 0;
  return there && segment_->ends_here(upper) && end.surface >= 0 ? &end : nullptr;
}

/// Returns the number of cells of the halo in front of a surface that prescribes the incoming components. The
/// surface may be several cells away from the block, also across periodic faces and behind cells of other
/// processes. All sweeps that compute the same flux thus get the same number.
int block_sweep::seen_beyond(bool upper, const stretch& at) const {
  const std::size_t side = upper ? 1 : 0;
  int distance = (upper ? segment_->cells - at.end : at.begin) + segment_->beyond[side];
  for (const segment* one = segment_; distance < halo_;) {
    const segment_end& end = one->ends[side];
    if (end.surface >= 0) return of_->faces.prescribes(end.surface, end.place) ? distance : halo_;
    one = &of_->space.segment_at(at.direction, end.place);
    distance += one->cells + one->beyond[side];
  }
  return halo_;
}

/// Replaces a cell by vacuum in the fluxes.
void block_sweep::empty(int cell) {
  rows_[static_cast<std::size_t>(cell - first_row_)] = vacuum_.data();
  std::fill_n(left_.data() + offset(cell), width_, 0.0);
  std::fill_n(right_.data() + offset(cell), width_, 0.0);
}

/// Stores the upwind values at a surface, from those of a run of cells. `joined` is the number of the cell
/// in the run.
void block_sweep::record(const segment_end& end, bool upper, int joined) {
  const double* forward = line_->forward.data() + first_component_;
  const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(joined) * width_;
  const double *of_forward = (upper ? out_ : in_).data() + first,
               *of_backward = (upper ? in_ : out_).data() + first;
  double* values = of_->faces.recorded(end.surface, end.place) + first_component_;
  for (int k = 0; k < width_; ++k) values[k] = forward[k] != 0.0 ? of_forward[k] : of_backward[k];
}

bool block_sweep::both_edges() const {
  return of_->edges.limits_edges();
}

kernel_work block_sweep::work_of(targets_view targets, int cells) const {
  kernel_work each = traffic(targets);
  each.operations = upwind::operations(of_->edges.limits_fluxes(), cells) +
                    upwind::operations_of_target * static_cast<double>(targets.size());
  return each;
}

void block_sweep::prepare(const visited& one, const place& at) {
  line_ = &of_->speeds[static_cast<std::size_t>(at.direction)];
  segment_ = &of_->space.segment_at(at.direction, at.segment);
  width_ = at.last - at.first;
  first_component_ = at.first;
  whole_rows_ = width_ == u_->stride();
  first_edge_ = at.begin - halo_;
  first_row_ = first_edge_ - reach_;
  seen_ = one.seen;
  rows_.clear();
  const double* const* rows = visited_rows_.data() + one.first_row;
  for (int k = 0; k < rows_of(at); ++k)
    rows_.push_back(rows[k] == nullptr ? vacuum_.data() : rows[k] + at.first);
  joined_ = visited_joined_.empty() ? nullptr : visited_joined_.data() + one.first_row;
  make_room(at.end - at.begin, width_);
}

/// If neighbours are joined, a row of edges ends beyond its last cell.
void block_sweep::make_room(int cells, int width) {
  const auto numbers = (static_cast<std::size_t>(cells) + 2 * static_cast<std::size_t>(halo_)) *
                       static_cast<std::size_t>(width);
  for (auto* edges : {&left_, &right_})
    if (edges->size() < numbers) edges->resize(numbers);
  if (of_->equation.has_source() && source_.size() < numbers) source_.resize(numbers);
}

block_sweep::run_of_cells block_sweep::run_from(int i, int most) const {
  const int long_enough = cells_of_a_row(width_);
  if (!whole_rows_ || long_enough == 1) return {most, 1};
  const int together = joined_[i - reach_ - first_row_] - 2 * reach_;
  return {1, std::max(1, std::min({long_enough, most, together}))};
}

void block_sweep::make_edges(int i, const run_of_cells& run) {
  const auto& scheme = *of_->edges.scheme;
  const int width = run.joined * width_;
  double *left = left_.data() + offset(i), *right = right_.data() + offset(i);
  if (!both_edges())
    return scheme.outflow_edges(row(i), run.cells, width, line_->forward.data() + first_component_, right);
  scheme.edges(row(i), run.cells, width, left, right);
  for (int j = 0; j < run.cells; ++j)
    limiter::apply(*row(i + j), width, left + static_cast<std::ptrdiff_t>(j) * width,
                   right + static_cast<std::ptrdiff_t>(j) * width);
}

const double* block_sweep::source(int i, const run_of_cells& run) {
  for (int j = i; j < i + run.cells * run.joined; ++j)
    of_->equation.source(*row(j), source_.data() + offset(j));
  return source_.data() + offset(i);
}

void block_sweep::add(int i, const run_of_cells& run, const place& at, targets_view targets,
                      bool at_surface) {
  const bool first = at.direction == 0;
  const int apart = of_->space.mesh().stride(at.direction), cell = segment_->first + i * apart;
  upwind::rows_of(targets, cell, targets_, {at.first, apart, first});
  const double* right = right_.data() + offset(i);
  const upwind::cells some{row(i),
                           both_edges() ? left_.data() + offset(i) : right,
                           right,
                           width_,
                           run.cells,
                           run.joined * width_,
                           line_->forward.data() + at.first,
                           line_->per_cell.data() + at.first,
                           line_->inverse_cfl.data() + at.first,
                           first && of_->equation.has_source() ? source(i, run) : nullptr,
                           at_surface ? in_.data() : nullptr,
                           at_surface ? out_.data() : nullptr};
  if (of_->edges.limits_fluxes()) {
    upwind::add_limited(some, targets_);
  } else {
    upwind::add(some, targets_);
  }
}

}  // namespace apsis
