#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>
#include <apsis/semidiscrete/point_times.hpp>
#include <apsis/semidiscrete/sweep.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace apsis {
namespace {

class cell_average_collision final : public collision {
 public:
  cell_average_collision(const model& equation, std::shared_ptr<domain> space, limited_reconstruction edges,
                         std::vector<double> epsilon, stage_solution stages)
      : equation_(equation),
        space_(std::move(space)),
        edges_(std::move(edges)),
        epsilon_(std::move(epsilon)),
        stages_(stages) {
    space_->reserve(equation.components(), edges_.scheme->ghost_width());
  }

  void solve(double t, double a, double b, field& u) override {
    if (result_.cells() != u.cells() || result_.components() != u.components())
      result_ = field(u.cells(), u.components());
    for_batches(t, u, [&](const point_batch& at, scratch& own) {
      own.local->solve_stage_means(a, b, at, own.points.data(), gauss3::weight, result_.row(at.first_cell));
    });
    std::swap(u, result_);  // neighbours need the old averages, so new ones are in another field
  }

  void add_collision(double t, const field& u, std::span<const target<field, double>> targets) override {
    const std::size_t length = static_cast<std::size_t>(cells_per_batch(u)) * gauss3::points;
    scratch_.prepare([&](auto& own) {
      own.rates.resize(length * static_cast<std::size_t>(u.stride()));
      own.rows.reserve(targets.size());
    });
    for_batches(t, u, [&](const point_batch& at, scratch& own) {
      own.local->evaluate(at, own.points.data(), own.rates.data());
      std::array<collision_rows::weighted_row, gauss3::points> points;
      const double* rates = own.rates.data();
      for (int cell = at.first_cell; cell < at.first_cell + at.count / gauss3::points; ++cell) {
        for (std::size_t q = 0; q < points.size(); ++q, rates += u.stride())
          points[q] = {gauss3::weight[q], rates};
        upwind::rows_of(targets, cell, own.rows);
        collision_rows::add(points, u.row(cell), u.stride(), own.rows);
      }
    });
  }

  /// Uses the rate of the averages. The rates at the Gauss points differ only by the accuracy of the scheme.
  double forward_euler_step(const field& u) const override {
    return smallest_time(equation_, u, epsilon_, gauss3::points, limited(),
                         &point_collision::forward_euler_step);
  }

  double relaxation_time(const field& u) const override {
    return smallest_time(equation_, u, epsilon_, gauss3::points, limited(),
                         &point_collision::relaxation_time);
  }

  double take_cut() override { return take_largest_cut(scratch_); }

 private:
  struct scratch {
    pencil_block block;
    aligned_vector<double> points,  ///< values at Gauss points of a batch
        rates;                      ///< Q/ε there
    std::unique_ptr<point_collision> local;
    std::vector<upwind::row_target> rows;
  };

  bool limited() const { return edges_.keeps_sign(); }
  static int cells_per_batch(const field& u) {
    return std::max(1, points_per_batch(u.stride()) / gauss3::points);
  }

  void prepare(const field& u) {
    const int points = cells_per_batch(u) * gauss3::points;
    scratch_.prepare([&](auto& own) {
      own.block.reserve(edges_, std::min(collision_block_length(u.stride()), u.cells()), 0, u.stride());
      own.points.resize(static_cast<std::size_t>(points) * static_cast<std::size_t>(u.stride()));
      if (!own.local) own.local = equation_.make_collision({points, u.stride(), limited(), stages_});
    });
  }

  /// Calls body(batch, scratch) for batches of the Gauss points of whole cells, with their values in
  /// scratch.points.
  template <class Body>
  void for_batches(double t, const field& u, const Body& body) {
    space_->fill_ghosts(t, u);
    prepare(u);
    const int length = cells_per_batch(u);
    parallel_blocks(u.cells(), collision_block_length(u.stride()), [&](int begin, int end) {
      auto& own = scratch_.here();
      {
        const profile::section timed(kernel::edges, static_cast<double>(end - begin) * u.stride(),
                                     {edges_.scheme->operations(true), sizeof(double)});
        own.block.load(u, *space_, edges_, 0, 0, begin, end, 0);
      }
      for (int i = begin; i < end; i += length) {
        const int cells = std::min(length, end - i);
        find_points(own.block, i, cells, u.stride(), own.points.data());
        body({.count = cells * gauss3::points,
              .pitch = u.stride(),
              .epsilon = epsilon_.data() + static_cast<std::ptrdiff_t>(i) * gauss3::points,
              .first_cell = i,
              .points_per_cell = gauss3::points},
             own);
      }
    });
  }

  void find_points(pencil_block& block, int begin, int cells, int stride, double* points) const {
    const profile::section timed(kernel::points, static_cast<double>(cells) * stride,
                                 {collision_rows::operations_of_points(limited()), 0.0});
    for (int i = begin; i < begin + cells;
         ++i, points += static_cast<std::ptrdiff_t>(gauss3::points) * stride)
      collision_rows::gauss_values(
          {block.row(i - 1), block.row(i), block.row(i + 1), block.left_edge(i), block.right_edge(i)},
          limited(), stride, points);
  }

  const model& equation_;
  std::shared_ptr<domain> space_;
  limited_reconstruction edges_;
  std::vector<double> epsilon_;
  stage_solution stages_;
  field result_;
  per_thread<scratch> scratch_;
};

}  // namespace

std::unique_ptr<collision> make_cell_average_collision(const model& equation, std::shared_ptr<domain> space,
                                                       limited_reconstruction edges,
                                                       std::vector<double> epsilon, stage_solution stages) {
  if (space->mesh().dimensions() != 1)
    throw input_error(
        "collisions at Gauss points need one space dimension (cell averages collide at the Gauss points of "
        "intervals); use point values");
  return std::make_unique<cell_average_collision>(equation, std::move(space), std::move(edges),
                                                  std::move(epsilon), stages);
}

}  // namespace apsis
