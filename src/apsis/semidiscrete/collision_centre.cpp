#include <apsis/core/errors.hpp>
#include <apsis/core/first_error.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/centre_rows.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>
#include <apsis/semidiscrete/point_times.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace apsis {
namespace {

class cell_centre_collision final : public collision {
 public:
  cell_centre_collision(const model& equation, std::shared_ptr<domain> space, bool limited,
                        std::vector<double> epsilon, stage_solution stages)
      : equation_(equation),
        space_(std::move(space)),
        limited_(limited),
        epsilon_(std::move(epsilon)),
        stages_(stages) {
    space_->reserve(equation.components(), centre_rows::reach);
  }

  /// The averages change by M d with d = v − p. Rows of d have no moments, so that collisions conserve
  /// for any p.
  void solve(double, double a, double b, field& u) override {
    find_changes(u, limited_, [&](const point_batch& at, scratch& own) {
      double *points = own.points.data(), *d = changes_.row(at.first_cell);
      own.local->solve_stage_changes(a, b, at, points, d);
      const int width = u.stride();
      if (!limited_ || !centre_rows::is_negative(u.row(at.first_cell), d, at.count * width)) return;
      for (int k = 0; k < at.count; ++k, points += width, d += width) {
        const int cell = at.first_cell + k;
        if (centre_rows::is_negative(u.row(cell), d, width))
          keep_sign(a, b, u.row(cell), batch(u, cell, cell + 1), points, *own.local, d);
      }
    });
    if (result_.cells() != u.cells() || result_.components() != u.components())
      result_ = field(u.cells(), u.components());
    for_changes(u,
                [&](int begin, int count, const double* const* averages, const double* const* d, scratch&) {
                  centre_rows::add_averages(averages, d, count, limited_, u.stride(), result_.row(begin));
                });
    std::swap(u, result_);
  }

  void add_collision(double, const field& u, std::span<const target<field, double>> targets) override {
    find_changes(u, false, [&](const point_batch& at, scratch& own) {
      own.local->evaluate(at, own.points.data(), changes_.row(at.first_cell));
    });
    scratch_.prepare([&](auto& own) { own.rows.reserve(targets.size()); });
    for_changes(u, [&](int begin, int count, const double* const*, const double* const* q, scratch& own) {
      constexpr double side = 1.0 / 24.0;
      for (int i = 0; i < count; ++i) {
        const std::array<collision_rows::weighted_row, 3> points = {
            {{side, q[i - 1]}, {1.0 - 2.0 * side, q[i]}, {side, q[i + 1]}}};
        upwind::rows_of(targets, begin + i, own.rows);
        collision_rows::add(points, u.row(begin + i), u.stride(), own.rows);
      }
    });
  }

  /// Uses the rate of the averages, as for collisions at Gauss points.
  double forward_euler_step(const field& u) const override {
    return smallest_time(equation_, u, epsilon_, 1, limited_, &point_collision::forward_euler_step);
  }

  double relaxation_time(const field& u) const override {
    return smallest_time(equation_, u, epsilon_, 1, limited_, &point_collision::relaxation_time);
  }

  double take_cut() override { return take_largest_cut(scratch_); }

 private:
  struct scratch {
    std::vector<const double*> averages, changes;  ///< rows of a batch and of its neighbours
    aligned_vector<double> points;                 ///< values at the centres of a batch
    std::unique_ptr<point_collision> local;
    std::vector<upwind::row_target> rows;
  };

  point_batch batch(const field& u, int begin, int end) const {
    return {
        .count = end - begin, .pitch = u.stride(), .epsilon = epsilon_.data() + begin, .first_cell = begin};
  }

  /// If ū + d, d = v − p, has negative components, replaces p by min(p, ū) in these components, and finally
  /// in all. Then v ≥ 0 and p ≤ ū leave no negative component.
  static void keep_sign(double a, double b, const double* average, const point_batch& at, double* p,
                        point_collision& local, double* d) {
    constexpr int rounds = 3;
    const int width = static_cast<int>(at.pitch);
    for (int round = 0; round <= rounds; ++round) {
      centre_rows::lower(average, d, round == rounds, width, p);
      local.solve_stage_changes(a, b, at, p, d);
      if (!centre_rows::is_negative(average, d, width)) return;
    }
  }

  void prepare(const field& u) {
    if (changes_.cells() != u.cells() || changes_.components() != u.components())
      changes_ = field(u.cells(), u.components());
    for (auto& row : across_) row.resize(static_cast<std::size_t>(u.stride()));
    const int length = points_per_batch(u.stride());
    scratch_.prepare([&](auto& own) {
      const auto numbers = static_cast<std::size_t>(length) * static_cast<std::size_t>(u.stride());
      for (auto* rows : {&own.averages, &own.changes})
        rows->reserve(static_cast<std::size_t>(length) + 2 * static_cast<std::size_t>(centre_rows::reach));
      own.points.resize(numbers);
      if (!own.local) own.local = equation_.make_collision({length, u.stride(), limited_, stages_});
    });
  }

  /// Calls body(batch, scratch) for batches of cells, with the values at their centres in scratch.points. The
  /// body writes rows of changes_. The changes are then sent to other processes, even after a failure,
  /// because these processes wait for them.
  template <class Body>
  void find_changes(const field& u, bool limited, const Body& body) {
    prepare(u);
    space_->exchange(u);
    first_error failure;
    failure.run([&] { at_all_centres(u, limited, body); });
    std::vector<const double*>& rows = scratch_.here().averages;
    rows_of(u, -1, 1, rows);
    std::copy_n(rows.front(), u.stride(), across_[0].data());
    rows_of(u, u.cells() - 1, u.cells() + 1, rows);
    std::copy_n(rows.back(), u.stride(), across_[1].data());
    space_->exchange(changes_);
    failure.rethrow();
  }

  template <class Body>
  void at_all_centres(const field& u, bool limited, const Body& body) {
    parallel_blocks(u.cells(), points_per_batch(u.stride()), [&](int begin, int end) {
      scratch& own = scratch_.here();
      rows_of(u, begin - centre_rows::reach, end + centre_rows::reach, own.averages);
      {
        const profile::section timed(kernel::points, static_cast<double>(end - begin) * u.stride(),
                                     {centre_rows::operations(), 4.0 * sizeof(double)});
        centre_rows::values(own.averages.data() + centre_rows::reach, end - begin, limited, u.stride(),
                            own.points.data());
      }
      body(batch(u, begin, end), own);
    });
  }

  /// Calls body(begin, count, averages, changes, scratch) for batches of cells, with rows i = −1 … count.
  template <class Body>
  void for_changes(const field& u, const Body& body) {
    parallel_blocks(u.cells(), points_per_batch(u.stride()), [&](int begin, int end) {
      scratch& own = scratch_.here();
      rows_of(u, begin - 1, end + 1, own.averages);
      rows_of(changes_, begin - 1, end + 1, own.changes);
      // The memory for rows of other processes now has their changes.
      if (begin == 0) own.averages.front() = across_[0].data();
      if (end == u.cells()) own.averages.back() = across_[1].data();
      body(begin, end - begin, own.averages.data() + 1, own.changes.data() + 1, own);
    });
  }

  /// rows ← the rows of cells begin … end−1, mirrored where the gas ends: no flux of M passes a wall.
  void rows_of(const field& of, int begin, int end, std::vector<const double*>& rows) const {
    space_->segment_rows(of, 0, 0, begin, end, rows);
    const segment& line = space_->segment_at(0, 0);
    const auto row = [&](int cell) -> const double*& { return rows[static_cast<std::size_t>(cell - begin)]; };
    const int first = -line.beyond[0], last = line.cells + line.beyond[1];
    if (line.ends[0].surface >= 0)
      for (int cell = begin; cell < first; ++cell) row(cell) = row(2 * first - 1 - cell);
    if (line.ends[1].surface >= 0)
      for (int cell = end - 1; cell >= last; --cell) row(cell) = row(2 * last - 1 - cell);
  }

  const model& equation_;
  std::shared_ptr<domain> space_;
  bool limited_;
  std::vector<double> epsilon_;
  stage_solution stages_;
  field changes_,  ///< changes of the point values in a stage, or their rates
      result_;     ///< new averages, while neighbours need the old ones
  std::array<aligned_vector<double>, 2>
      across_;  ///< averages of the cells before the first and after the last one
  per_thread<scratch> scratch_;
};

}  // namespace

std::unique_ptr<collision> make_cell_centre_collision(const model& equation, std::shared_ptr<domain> space,
                                                      bool limited, std::vector<double> epsilon,
                                                      stage_solution stages) {
  if (space->mesh().dimensions() != 1)
    throw input_error(
        "collisions at the centres of cells need one space dimension (averages are mapped along one line); "
        "use point values");
  return std::make_unique<cell_centre_collision>(equation, std::move(space), limited, std::move(epsilon),
                                                 stages);
}

}  // namespace apsis
