#include <apsis/semidiscrete/transport.hpp>

#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/model/vector_math.hpp>
#include <apsis/scheme/limiter.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace apsis {
namespace {

using targets_view = std::span<const target<field, double>>;

/// Returns the number of cells that are joined into one row, so that rows of few components fill vectors.
int cells_of_a_row(int stride) {
  constexpr int enough = 64;
  return std::max(1, enough / std::max(stride, 1));
}

/// Largest number of components per sweep: with some dozens of cells, its buffers fit into the first-level
/// cache.
constexpr int most_columns = 32;
/// Smallest numbers of components and cells that are worth a separate sweep.
constexpr int least_columns = 16, least_cells = 16;
/// Limits on the length of a row and the tasks of a loop, so that sums with a few others fit into int.
constexpr int longest_row = 1 << 30, most_tasks = 1 << 30;

/// Returns the memory traffic of the accumulators per number: a write, and a read unless they are fresh.
kernel_work traffic(targets_view targets) {
  kernel_work each;
  for (const auto& to : targets) each.bytes += sizeof(double) * (to.fresh ? 1.0 : 2.0);
  return each;
}

/// Returns the number of cells beyond a block whose edges are needed: one for the flux, one more for its
/// limiter.
int halo_of(const spatial_discretization& discretization) {
  return discretization.positivity == limiter_kind::fluxes ? 2 : 1;
}

/// Returns the number of cells on either side on which edges and limiter of a cell depend.
int reach_of(const spatial_discretization& discretization) {
  return std::max(discretization.scheme->ghost_width(), halo_of(discretization));
}

/// Returns the first component of column 0 … columns of a row; columns are multiples of vectors.
int first_component(int width, int columns, int column) {
  if (column == columns) return width;
  return static_cast<int>(static_cast<long>(width / packet_length) * column / columns) * packet_length;
}

}  // namespace

/// T along one direction for some components of some cells of a pencil.
class transport::block_sweep {
 public:
  struct place {
    int direction, pencil, begin, end;  ///< cells of the pencil
    int first, last;                    ///< components
  };

  /// Allocates buffers for `cells` cells of at most `width` components.
  void reserve(const transport& from, int cells, int width, std::size_t targets) {
    find_reach(from);
    const auto rows = static_cast<std::size_t>(cells) + 2 * static_cast<std::size_t>(halo_ + reach_);
    rows_.reserve(rows);
    joined_.reserve(rows);
    targets_.reserve(targets);
    make_room(from, cells, width);
  }

  void run(const transport& from, const field& u, const place& at, targets_view targets) {
    if (at.begin == at.end) return;
    prepare(from, u, at);
    const double numbers = static_cast<double>(at.end - at.begin) * width_;
    {
      const profile::section timed(kernel::edges, numbers,
                                   {from.discretization_.scheme->operations(both_edges()), sizeof(double)});
      for (int i = at.begin - halo_; i < at.end + halo_;) {
        const run_of_cells run = run_from(i, at.end + halo_ - i);
        make_edges(i, run);
        i += run.cells * run.joined;
      }
    }
    for (const bool upper : {false, true})
      if (touches({at.direction, upper}, at) && from.faces_->prescribes({at.direction, upper}))
        empty_beyond(upper ? at.end : -1, upper ? 1 : -1);
    const profile::section timed(kernel::fluxes, numbers, work_of(targets));
    for (int i = at.begin; i < at.end;) {
      const run_of_cells run = run_from(i, at.end - i);
      add(i, run, at, targets);
      i += run.cells * run.joined;
    }
    for (const bool upper : {false, true})
      if (touches({at.direction, upper}, at)) record({at.direction, upper}, at);
  }

 private:
  /// Either separate cells, or cells that are contiguous in memory, as are their neighbours, and form a
  /// single "cell" for the kernels.
  struct run_of_cells {
    int cells, joined;
  };

  /// Whether a block ends at a face that is not periodic.
  bool touches(const face& where, const place& at) const {
    return (where.upper ? at.end == from_->mesh().cells(at.direction) : at.begin == 0) &&
           from_->faces_->records(where);
  }

  /// Replaces the ghost cells from `first` outwards, as the fluxes see them, by vacuum.
  void empty_beyond(int first, int outwards) {
    vacuum_.resize(std::max(vacuum_.size(), static_cast<std::size_t>(width_)));
    for (int k = 0; k < halo_; ++k) {
      const int ghost = first + k * outwards;
      rows_[static_cast<std::size_t>(ghost - first_row_)] = vacuum_.data();
      std::fill_n(left_.data() + offset(ghost), width_, 0.0);
      std::fill_n(right_.data() + offset(ghost), width_, 0.0);
    }
  }

  /// Stores the upwind values at a face.
  void record(const face& where, const place& at) {
    const int cell = where.upper ? at.end - 1 : 0;
    const auto width = static_cast<std::size_t>(width_);
    in_.resize(std::max(in_.size(), width));
    out_.resize(std::max(out_.size(), width));
    const double* right = right_.data() + offset(cell);
    const upwind::cells one{row(cell),
                            both_edges() ? left_.data() + offset(cell) : right,
                            right,
                            width_,
                            1,
                            width_,
                            line_->forward.data() + at.first,
                            line_->per_cell.data() + at.first,
                            nullptr};
    upwind::fluxes_of_cell(one, from_->discretization_.positivity == limiter_kind::fluxes, in_.data(),
                           out_.data());
    double* values = from_->faces_->recorded(where, at.pencil) + at.first;
    for (std::size_t k = 0; k < width; ++k)
      values[k] =
          (line_->forward[k + static_cast<std::size_t>(at.first)] != 0.0) == where.upper ? out_[k] : in_[k];
  }

  bool both_edges() const { return from_->discretization_.positivity == limiter_kind::edges; }

  kernel_work work_of(targets_view targets) const {
    kernel_work each = traffic(targets);
    each.operations = upwind::operations(from_->discretization_.positivity == limiter_kind::fluxes) +
                      upwind::operations_of_target * static_cast<double>(targets.size());
    return each;
  }

  void prepare(const transport& from, const field& u, const place& at) {
    from_ = &from;
    line_ = &from.speeds_[static_cast<std::size_t>(at.direction)];
    width_ = at.last - at.first;
    first_component_ = at.first;
    whole_rows_ = width_ == u.stride();
    find_reach(from);
    first_edge_ = at.begin - halo_;
    const int beyond = halo_ + reach_;
    first_row_ = at.begin - beyond;
    from.space_->pencil_rows(u, at.direction, at.pencil, first_row_, at.end + beyond, rows_);
    joined_.assign(rows_.size(), 1);
    if (cells_of_a_row(u.stride()) > 1)
      for (std::size_t j = rows_.size() - 1; j-- > 0;)
        if (rows_[j] + width_ == rows_[j + 1]) joined_[j] = joined_[j + 1] + 1;
    for (auto& row : rows_) row += at.first;
    make_room(from, at.end - at.begin, width_);
  }

  void find_reach(const transport& from) {
    halo_ = halo_of(from.discretization_);
    reach_ = reach_of(from.discretization_);
  }

  /// Where neighbours are joined, a row of edges ends beyond its last cell.
  void make_room(const transport& from, int cells, int width) {
    const auto numbers = (static_cast<std::size_t>(cells) + 2 * static_cast<std::size_t>(halo_)) *
                         static_cast<std::size_t>(width);
    for (auto* edges : {&left_, &right_})
      if (edges->size() < numbers) edges->resize(numbers);
    if (from.equation_.has_source() && source_.size() < numbers) source_.resize(numbers);
  }

  const double* const* row(int i) const { return rows_.data() + (i - first_row_); }
  std::size_t offset(int i) const {
    return static_cast<std::size_t>(i - first_edge_) * static_cast<std::size_t>(width_);
  }

  run_of_cells run_from(int i, int most) const {
    const int long_enough = cells_of_a_row(width_);
    if (!whole_rows_ || long_enough == 1) return {most, 1};
    const int together = joined_[static_cast<std::size_t>(i - reach_ - first_row_)] - 2 * reach_;
    return {1, std::max(1, std::min({long_enough, most, together}))};
  }

  void make_edges(int i, const run_of_cells& run) {
    const auto& scheme = *from_->discretization_.scheme;
    const int width = run.joined * width_;
    double *left = left_.data() + offset(i), *right = right_.data() + offset(i);
    if (!both_edges())
      return scheme.outflow_edges(row(i), run.cells, width, line_->forward.data() + first_component_, right);
    scheme.edges(row(i), run.cells, width, left, right);
    for (int j = 0; j < run.cells; ++j)
      limiter::apply(*row(i + j), width, left + static_cast<std::ptrdiff_t>(j) * width,
                     right + static_cast<std::ptrdiff_t>(j) * width);
  }

  const double* source(int i, const run_of_cells& run) {
    for (int j = i; j < i + run.cells * run.joined; ++j)
      from_->equation_.source(*row(j), source_.data() + offset(j));
    return source_.data() + offset(i);
  }

  void add(int i, const run_of_cells& run, const place& at, targets_view targets) {
    const bool first = at.direction == 0;
    const auto& mesh = from_->mesh();
    const int apart = mesh.stride(at.direction), cell = mesh.first_cell(at.direction, at.pencil) + i * apart;
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
                             first && from_->equation_.has_source() ? source(i, run) : nullptr};
    if (from_->discretization_.positivity == limiter_kind::fluxes) {
      upwind::add_limited(some, targets_);
    } else {
      upwind::add(some, targets_);
    }
  }

  const transport* from_ = nullptr;
  const line_speeds* line_ = nullptr;
  std::vector<const double*> rows_;
  std::vector<int> joined_;
  std::vector<upwind::row_target> targets_;
  aligned_vector<double> left_, right_, source_, vacuum_, in_, out_;
  int width_ = 0, first_component_ = 0, halo_ = 0, reach_ = 0, first_row_ = 0, first_edge_ = 0;
  bool whole_rows_ = false;
};

struct transport::scratch {
  per_thread<block_sweep> sweeps;
  per_thread<std::vector<upwind::row_target>> rows;
};

transport::~transport() = default;
transport::transport(transport&&) noexcept = default;

transport::transport(const model& equation, std::shared_ptr<domain> space,
                     spatial_discretization discretization)
    : equation_(equation),
      space_(std::move(space)),
      discretization_(std::move(discretization)),
      scratch_(std::make_unique<scratch>()) {
  faces_ = std::make_unique<face_fluxes>(equation_, space_);
  if (equation.space_dimensions() == 0) return;
  space_->reserve(equation.components(), halo_of(discretization_) + reach_of(discretization_));
  const field layout(1, equation.components());
  for (int direction = 0; direction < mesh().dimensions(); ++direction) {
    line_speeds line;
    const auto v = equation.speeds(direction);
    for (int cell = 0; cell < cells_of_a_row(layout.stride()); ++cell)
      for (std::size_t k = 0; k < static_cast<std::size_t>(layout.stride()); ++k) {
        line.per_cell.push_back(k < v.size() ? std::abs(v[k]) / mesh().spacing(direction) : 0.0);
        line.forward.push_back(k < v.size() && v[k] > 0.0 ? 1.0 : 0.0);
      }
    speeds_.push_back(std::move(line));
  }
}

void transport::set_force(acceleration of) {
  force_ = std::make_unique<force>(equation_, space_, std::move(of), discretization_);
}

void transport::set_source(source_rate rate, formulation unknowns) {
  source_ = std::make_unique<source>(equation_, space_, std::move(rate), unknowns);
}

double transport::forward_euler_step() const {
  double rate = force_ ? force_->rate() : 0.0;  // 1/0 is the infinity of a model without space
  for (const auto& line : speeds_) rate += *std::max_element(line.per_cell.begin(), line.per_cell.end());
  return rounding_allowance * (discretization_.positivity != limiter_kind::none ? limiter::end_weight : 1.0) /
         rate;
}

bool transport::add_transport(double t, const field& u, targets_view targets, const cells_job& then) const {
  const bool moves =
      std::any_of(targets.begin(), targets.end(), [](const auto& to) { return to.beta != 0.0; });
  if (!moves) {
    faces_->add_gains(u, targets, false);
    add_weighted(u, targets, then);
    return static_cast<bool>(then);
  }
  if (equation_.space_dimensions() == 0) {
    add_source(u, targets);
    return false;
  }
  space_->fill_ghosts(t, u);
  const int dimensions = mesh().dimensions();
  for (int direction = 0; direction + 1 < dimensions; ++direction)
    add_direction(t, u, targets, direction, {});
  // Cells are complete pencil by pencil only where one direction is all there is.
  const bool alone = dimensions == 1 && !force_ && !source_;
  const bool done = add_direction(t, u, targets, dimensions - 1, alone ? then : cells_job());
  std::vector<double> given;  // inside the domain
  if (force_) {
    force_->add(t, u, targets);
    given = force_->given();
  }
  if (source_) {
    source_->add(t, targets);
    given.insert(given.end(), source_->given().begin(), source_->given().end());
  }
  faces_->add_gains(u, targets, true, given);
  return done;
}

void transport::complete_face(const face& where, int pencil, double t, targets_view targets) const {
  if (faces_->records(where)) faces_->complete(where, pencil, t, targets);
}

void transport::add_source(const field& u, targets_view targets) const {
  std::vector<double> t(static_cast<std::size_t>(u.stride()), 0.0);
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (equation_.has_source()) equation_.source(u.row(cell), t.data());
    for (const auto& to : targets)
      for (int k = 0; k < u.stride(); ++k) {
        double& acc = to.acc->row(cell)[k];
        acc = to.combine(acc, u.row(cell)[k], t[static_cast<std::size_t>(k)]);
      }
  }
}

void transport::add_weighted(const field& u, targets_view targets, const cells_job& then) const {
  scratch_->rows.prepare([&](auto& rows) { rows.reserve(targets.size()); });
  // As many cells as make a row whose length is an int.
  const int longest = std::min(block_length(u.stride()), std::max(1, longest_row / std::max(u.stride(), 1)));
  parallel_blocks(u.cells(), longest, [&](int begin, int end) {
    auto& rows = scratch_->rows.here();
    const int cells = end - begin;
    upwind::rows_of(targets, begin, rows);
    {
      kernel_work each = traffic(targets);
      each.bytes += sizeof(double);
      each.operations = 2.0 * static_cast<double>(targets.size());
      const profile::section timed(kernel::multiples, static_cast<double>(cells) * u.stride(), each);
      upwind::add_weights(u.row(begin), cells * u.stride(), rows);
    }
    if (then) then(begin, end);
  });
}

bool transport::add_direction(double t, const field& u, targets_view targets, int direction,
                              const cells_job& then) const {
  const int n = mesh().cells(direction), pencils = mesh().pencils(direction), width = u.stride();
  // A source is a function of all components of a cell.
  const bool whole_cells = equation_.has_source();
  int columns = whole_cells ? 1 : (width + most_columns - 1) / most_columns;
  // Parts of one pencil for all threads, or pencils, or parts of rows.
  const bool by_cells = pencils == 1 && n / least_cells >= threads();
  const part_blocks blocks(n, sweep_block_length(std::min(width, most_columns)), by_cells ? threads() : 1);
  // So many parts that threads of different speed end at about the same time.
  const int enough = threads() == 1 ? 1 : 4 * threads();
  const long pieces = static_cast<long>(pencils) * blocks.count();
  if (!whole_cells && !by_cells && pieces * columns < enough)
    columns = std::max(columns, width / least_columns);
  if (!by_cells) columns = static_cast<int>(std::clamp<long>(most_tasks / pieces, 1, columns));
  const auto component = [&](int column) { return first_component(width, columns, column); };
  const int longest = std::min(n, sweep_block_length(std::min(width, most_columns)));
  const int widest = (width / packet_length / columns + 1) * packet_length;
  scratch_->sweeps.prepare([&](auto& sweep) {
    sweep.reserve(*this, longest, std::min(width, widest + width % packet_length), targets.size());
  });
  const auto sweep = [&](int pencil, int block, int column) {
    scratch_->sweeps.here().run(
        *this, u,
        {direction, pencil, blocks.begin(block), blocks.end(block), component(column), component(column + 1)},
        targets);
  };
  if (by_cells) {
    parallel_for(blocks.count(), [&](int block) {
      for (int column = 0; column < columns; ++column) sweep(0, block, column);
      const bool cells = blocks.begin(block) < blocks.end(block);
      if (cells && blocks.begin(block) == 0) complete_face({direction, false}, 0, t, targets);
      if (cells && blocks.end(block) == n) complete_face({direction, true}, 0, t, targets);
      if (then) then(blocks.begin(block), blocks.end(block));
    });
    return static_cast<bool>(then);
  }
  parallel_for(static_cast<int>(pieces) * columns, [&](int task) {
    sweep(task / columns / blocks.count(), task / columns % blocks.count(), task % columns);
  });
  parallel_for(pencils, [&](int pencil) {
    for (const bool upper : {false, true}) complete_face({direction, upper}, pencil, t, targets);
  });
  return false;
}

}  // namespace apsis
