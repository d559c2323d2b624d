#include <apsis/semidiscrete/upwind_transport.hpp>

#include <apsis/core/first_error.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/model/vector_math.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/tiling.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace apsis {
namespace {

using targets_view = std::span<const target<field, double>>;

/// Largest number of components per sweep. With some dozens of cells, its buffers fit into
/// the first-level cache.
constexpr int most_columns = 32;
/// Smallest numbers of components and cells for which a separate sweep pays.
constexpr int least_columns = 16, least_cells = 16;
/// Limits on the length of a row and the number of tasks of a loop, so that sums with small numbers
/// fit into int.
constexpr int longest_row = 1 << 30, most_tasks = 1 << 30;
/// Number of cells of a task that adds force, rotation and source after all sweeps.
constexpr int cells_inside = 16;

/// Returns the first component of column 0 … columns of a row; columns are multiples of vectors.
int first_component(int width, int columns, int column) {
  if (column == columns) return width;
  return static_cast<int>(static_cast<long>(width / packet_length) * column / columns) * packet_length;
}

}  // namespace

struct upwind_transport::scratch {
  per_thread<block_sweep> sweeps;
  per_thread<std::vector<upwind::row_target>> rows;
  std::vector<double> given;  ///< amounts given by force, rotation and source

  /// Returns the boxes of a mesh, rebuilt only for another width or number of threads.
  const tiling& boxes(const domain& space, int longest, int parts) {
    if (made_ && longest == longest_made_ && parts == parts_made_) return *made_;
    made_.emplace(space.mesh(), longest, parts);
    longest_made_ = longest;
    parts_made_ = parts;
    for (auto& numbers : waves) numbers.clear();
    for (int number = 0; number < made_->count(); ++number)
      waves[space.is_inner(made_->box(number)) ? 0 : 1].push_back(number);
    return *made_;
  }
  /// Numbers of the boxes that depend on no other process, and of the other boxes.
  std::array<std::vector<int>, 2> waves;

 private:
  std::optional<tiling> made_;
  int longest_made_ = 0, parts_made_ = 0;
};

/// The division of a sweep into tasks: boxes of the tiling, or boxes times parts of the rows.
struct upwind_transport::sweep_plan {
  const tiling& boxes;
  int columns;    ///< parts of a row
  bool by_boxes;  ///< whether a task is a whole box, with complete cells at its end
};

upwind_transport::~upwind_transport() = default;

upwind_transport::upwind_transport(const model& equation, std::shared_ptr<domain> space,
                                   limited_reconstruction edges, const cell_unknown& unknown)
    : equation_(equation),
      space_(std::move(space)),
      edges_(std::move(edges)),
      unknown_(unknown),
      scratch_(std::make_unique<scratch>()) {
  const bool has_space = equation.space_dimensions() > 0;
  if (has_space) space_->reserve(equation.components(), edges_.ghosts());
  faces_ = std::make_unique<face_fluxes>(equation_, space_);
  if (has_space) speeds_ = line_speeds::of(equation, mesh());
  kappa_ = has_space ? cut_transport::kappa(edges_, mesh()) : edges_.kappa();
  if (has_space && mesh().cut() != nullptr)
    cut_ = std::make_unique<cut_transport>(equation_, space_, edges_, *faces_);
  limit_for_steps(1.0);
}

void upwind_transport::set_force(acceleration of) {
  force_ = std::make_unique<force>(equation_, space_, std::move(of), edges_);
  limit_for_steps(share_);
}

void upwind_transport::set_rotation(int radial) {
  rotation_ = std::make_unique<ring_rotation>(equation_, space_, radial, edges_);
  if (cut_) cut_->use_chords();
  limit_for_steps(share_);
}

void upwind_transport::set_source(source_rate rate) {
  source_ = std::make_unique<source>(equation_, space_, std::move(rate), unknown_);
}

void upwind_transport::limit_for_steps(double share) {
  share_ = share;
  // All molecules of a component move with one velocity.
  const auto rates = rotation_ ? rotation_->rates_with(speeds_) : line_speeds::rates(speeds_);
  fastest_ = rates.empty() ? 0.0 : *std::max_element(rates.begin(), rates.end());
  const double of_force = force_ ? force_->rate() : 0.0;  // part of 1/Δt_FE
  const double step = share * forward_euler_step();
  if (rotation_)
    rotation_->limit_for_steps(step / rounding_allowance, speeds_);
  else
    line_speeds::limit_for_steps(speeds_, share, of_force, kappa_);
  if (cut_)
    cut_->limit_for_steps(
        step, rotation_ ? rotation_->left() : aligned_vector<double>(rates.size(), 1.0 - step * of_force));
  if (force_) force_->limit_for_steps(share);
}

void upwind_transport::limit_for_steady_states(double collisions) {
  limit_for_steps(1.0);
  if (rotation_)
    rotation_->limit_for_steady_states(collisions, speeds_);
  else
    line_speeds::limit_for_steady_states(speeds_, collisions);
  if (cut_)
    cut_->limit_for_steady_states(collisions,
                                  rotation_ ? rotation_->rates_with(speeds_) : line_speeds::rates(speeds_));
}

double upwind_transport::growth_of_source(double t, const field& u) const {
  return source_depends_on_state() ? source_->growth(t, u) : 0.0;
}

double upwind_transport::forward_euler_step() const {
  const double rate = fastest_ + kappa_ * (force_ ? force_->rate() : 0.0);
  return rounding_allowance * kappa_ / rate;  // 1/0 is the infinity of a model without space
}

bool upwind_transport::add_transport(double t, const field& u, targets_view targets,
                                     const cells_job& then) const {
  const bool moves =
      std::any_of(targets.begin(), targets.end(), [](const auto& to) { return to.beta != 0.0; });
  if (!moves) {
    add_weighted(u, targets, then);
    return static_cast<bool>(then);
  }
  if (equation_.space_dimensions() == 0) {
    add_source(u, targets);
    return false;
  }
  first_error failure;
  if (!force_ && !rotation_ && !source_) return sweep(t, u, targets, then);
  if (force_) force_->prepare(u);
  if (rotation_) rotation_->prepare(u);
  if (source_) failure.run([&] { source_->update(t, u); });
  const auto inside = [&](int begin, int end) {
    if (force_) force_->add(t, u, targets, begin, end);
    if (rotation_) rotation_->add(u, targets, begin, end);
    if (source_) source_->add(targets, begin, end);
    if (then) then(begin, end);
  };
  bool done = false;
  // Other processes wait for the rows of this one, even if its source has failed.
  failure.run([&] { done = sweep(t, u, targets, failure ? cells_job() : cells_job::of(inside)); });
  if (!done && !failure)
    failure.run([&] {
      parallel_blocks(u.cells(), cells_inside,
                      [&](int begin, int end) { for_cells_in(mesh().fluid(), begin, end, inside); });
    });
  account_inside();
  failure.rethrow();
  return static_cast<bool>(then);
}

/// Adds up the amounts that force, rotation and source gave. Their sums are collective, and are computed even
/// if this process has failed.
void upwind_transport::account_inside() const {
  std::vector<double>& given = scratch_->given;
  given.clear();
  if (force_) {
    force_->integrate();
    given = force_->given();
  }
  if (rotation_) {
    rotation_->integrate();
    given.insert(given.end(), rotation_->given().begin(), rotation_->given().end());
  }
  if (source_) given.insert(given.end(), source_->given().begin(), source_->given().end());
  if (force_) given.insert(given.end(), force_->losses().begin(), force_->losses().end());
  // A single process stores the amounts that all processes have received.
  if (!space_->processes().is_root()) std::fill(given.begin(), given.end(), 0.0);
  faces_->set_inside(given);
}

void upwind_transport::combine(std::span<const linear_term<field, double>> terms, field& sum) const {
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto& [alpha, u] = terms[k];
    if (k == 0 && u == &sum && alpha == 1.0) continue;
    const target<field, double> to{&sum, alpha, 0.0, k == 0};
    add_weighted(*u, {&to, 1}, {});
  }
}

std::vector<double> upwind_transport::observe_surfaces(double t, const field& u) const {
  if (equation_.space_dimensions() == 0) return {};
  struct observation {
    face_fluxes& of;
    explicit observation(face_fluxes& faces) : of(faces) { of.observe(true); }
    ~observation() { of.observe(false); }
  } const watched(*faces_);
  sweep(t, u, {}, {});
  return faces_->observed();
}

void upwind_transport::add_source(const field& u, targets_view targets) const {
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

void upwind_transport::add_weighted(const field& u, targets_view targets, const cells_job& then) const {
  scratch_->rows.prepare([&](auto& rows) { rows.reserve(targets.size()); });
  // Blocks are short enough that the length of a row fits into an int.
  const int longest = std::min(block_length(u.stride()), std::max(1, longest_row / std::max(u.stride(), 1)));
  parallel_blocks(u.cells(), longest, [&](int begin, int end) {
    auto& rows = scratch_->rows.here();
    kernel_work each = traffic(targets);
    each.bytes += sizeof(double);
    each.operations = 2.0 * static_cast<double>(targets.size());
    // Rows of solid cells are 0 in every state.
    for_cells_in(mesh().fluid(), begin, end, [&](int from, int to) {
      const int numbers = (to - from) * u.stride();
      const profile::section timed(kernel::multiples, numbers, each);
      upwind::rows_of(targets, from, rows);
      upwind::add_weights(u.row(from), numbers, rows);
    });
    if (then) then(begin, end);
  });
}

/// Calls body(segment, begin, end) for the cells of a box along a direction, as cells of segments.
template <class Body>
void upwind_transport::for_segments(int direction, const cell_box& box, const Body& body) const {
  const auto k = static_cast<std::size_t>(direction);
  const int inner = mesh().stride(direction), first = box.first[k], last = first + box.cells[k];
  const auto& table = space_->segments();
  cell_box lines = box;
  lines.cells[k] = 1;
  for (int a = 0; a < lines.cells[0]; ++a)
    for (int b = 0; b < lines.cells[1]; ++b)
      for (int c = 0; c < lines.cells[2]; ++c) {
        std::array<int, 3> at = {box.first[0] + a, box.first[1] + b, box.first[2] + c};
        at[k] = 0;
        const int start = (at[0] * mesh().cells(1) + at[1]) * mesh().cells(2) + at[2];
        const int pencil = start / (inner * mesh().cells(direction)) * inner + start % inner;
        for (int s = table.first_of(direction, pencil); s < table.first_of(direction, pencil + 1); ++s) {
          const segment& one = space_->segment_at(direction, s);
          const int begin = std::max(first - one.offset, 0), end = std::min(last - one.offset, one.cells);
          if (begin < end) body(s, begin, end);
        }
      }
}

/// Looks up the rows of a box for sweeps along all directions; `all` and `u` must outlive the sweeps.
block_sweep& upwind_transport::sweep_of_box(const block_sweep::context& all, const field& u,
                                            const cell_box& box) const {
  block_sweep& sweep = scratch_->sweeps.here();
  sweep.start(all, u);
  for (int direction = 0; direction < mesh().dimensions(); ++direction)
    for_segments(direction, box,
                 [&](int segment, int begin, int end) { sweep.visit({direction, segment, begin, end}); });
  return sweep;
}

/// Adds the fluxes that enter through surfaces at the cells of a box.
void upwind_transport::complete_box(double t, const field& u, targets_view targets,
                                    const cell_box& box) const {
  if (space_->budget_surfaces().empty()) return;
  for (int direction = 0; direction < mesh().dimensions(); ++direction)
    for_segments(direction, box, [&](int number, int begin, int end) {
      const segment& one = space_->segment_at(direction, number);
      for (const bool upper : {false, true}) {
        const auto& [surface, place] = one.ends[upper ? 1 : 0];
        if (surface < 0 || !one.ends_here(upper) || (upper ? end != one.cells : begin != 0)) continue;
        const profile::section timed(kernel::walls, equation_.components(), traffic(targets));
        if (space_->is_border_of_cut_cells(surface))
          cut_->complete(surface, place, u, targets);
        else
          faces_->complete(surface, place, t, targets);
      }
    });
}

void upwind_transport::finish_box(const cell_box& box, const cells_job& then) const {
  const int direction = mesh().dimensions() - 1;
  for_segments(direction, box, [&](int number, int begin, int end) {
    const int first = space_->segment_at(direction, number).first;
    then(first + begin, first + end);
  });
}

bool upwind_transport::sweep(double t, const field& u, targets_view targets, const cells_job& then) const {
  const int n = mesh().cells(0), width = u.stride();
  const bool on_a_line = mesh().dimensions() == 1;
  // A source is a function of all components of a cell.
  const bool whole_cells = equation_.has_source();
  int columns = whole_cells ? 1 : (width + most_columns - 1) / most_columns;
  const int longest = sweep_block_length(std::min(width, most_columns));
  // There are enough parts for threads of different speed to finish at about the same time.
  const int team = threads_here(), enough = team == 1 ? 1 : 4 * team;
  const bool parts_of_a_line = on_a_line && n / least_cells >= team;
  const tiling& boxes = scratch_->boxes(*space_, longest, parts_of_a_line ? team : 1);
  const bool by_boxes = on_a_line ? parts_of_a_line : boxes.count() >= enough;
  if (!whole_cells && !by_boxes && static_cast<long>(boxes.count()) * columns < enough)
    columns = std::max(columns, width / least_columns);
  if (!by_boxes) columns = static_cast<int>(std::clamp<long>(most_tasks / boxes.count(), 1, columns));
  const int widest = (width / packet_length / columns + 1) * packet_length;
  const block_sweep::context all{equation_, *space_, edges_, speeds_, *faces_};
  scratch_->sweeps.prepare([&](auto& sweep) {
    sweep.reserve(all, std::min(std::max({mesh().cells(0), mesh().cells(1), mesh().cells(2)}), longest),
                  boxes.most_cells(), std::min(width, widest + width % packet_length), targets.size());
  });
  const sweep_plan plan{boxes, columns, by_boxes};
  if (cut_) cut_->prepare(u);
  first_error failure;
  failure.run([&] {
    // Boxes that do not need rows of other processes are swept while these rows arrive.
    space_->begin_ghosts(t, u);
    sweep_boxes(t, u, targets, plan, scratch_->waves[0], then);
    space_->finish_ghosts(t, u);
    sweep_boxes(t, u, targets, plan, scratch_->waves[1], then);
  });
  // Other processes wait for the values at cut cells, even if a boundary of this process has failed.
  if (cut_) failure.run([&] { cut_->add(t, u, targets, by_boxes && !failure ? then : cells_job()); });
  failure.rethrow();
  return by_boxes && then;
}

void upwind_transport::sweep_boxes(double t, const field& u, targets_view targets, const sweep_plan& plan,
                                   const std::vector<int>& numbers, const cells_job& then) const {
  const int count = static_cast<int>(numbers.size()), columns = plan.columns;
  const auto component = [&](int column) { return first_component(u.stride(), columns, column); };
  const block_sweep::context all{equation_, *space_, edges_, speeds_, *faces_};
  const auto box = [&](int k) { return plan.boxes.box(numbers[static_cast<std::size_t>(k)]); };
  const auto after_box = [&] {
    if (thread_number() == 0) space_->advance_ghosts();
  };
  if (plan.by_boxes)
    return parallel_for(count, [&](int k) {
      const cell_box here = box(k);
      block_sweep& sweep = sweep_of_box(all, u, here);
      for (int column = 0; column < columns; ++column)
        sweep.run(component(column), component(column + 1), targets);
      complete_box(t, u, targets, here);
      if (then) finish_box(here, then);
      after_box();
    });
  parallel_for(count * columns, [&](int task) {
    const int column = task % columns;
    sweep_of_box(all, u, box(task / columns)).run(component(column), component(column + 1), targets);
    after_box();
  });
  parallel_for(count, [&](int k) { complete_box(t, u, targets, box(k)); });
}

}  // namespace apsis
