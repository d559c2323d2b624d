#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/local_relaxation.hpp>
#include <apsis/semidiscrete/relaxation_rows.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace apsis {
namespace {

class cell_average_collision final : public collision {
 public:
  cell_average_collision(const relaxation_model& equation, std::shared_ptr<domain> space, stencil how,
                         std::vector<double> epsilon)
      : equation_(equation), space_(std::move(space)), how_(std::move(how)), epsilon_(std::move(epsilon)) {
    space_->reserve(equation.components(), how_.scheme->ghost_width());
  }

  void solve(double t, double a, double b, field& u) override {
    if (result_.cells() != u.cells() || result_.components() != u.components())
      result_ = field(u.cells(), u.components());
    for_blocks(t, u, [&](int begin, int cells, const double* points, local_relaxation& local) {
      const auto pitch = static_cast<std::ptrdiff_t>(u.stride());
      const profile::section timed(kernel::relaxation, static_cast<double>(cells) * u.stride(),
                                   {relaxation::operations_of_average, sizeof(double)});
      local.find_weights(a, b, epsilon_.data() + static_cast<std::ptrdiff_t>(begin) * gauss3::points,
                         cells * gauss3::points);
      for (int i = 0; i < cells; ++i) {
        relaxation::weighted_rows rows[gauss3::points];
        for (int q = 0; q < gauss3::points; ++q) {
          const int p = i * gauss3::points + q;
          const auto weights = local.weights(p);
          const double w = gauss3::weight[static_cast<std::size_t>(q)];
          rows[q] = {w * weights.stay, w * weights.relax, points + p * pitch, local.equilibrium(p)};
        }
        relaxation::average(rows, u.stride(), result_.row(begin + i));
      }
    });
    std::swap(u, result_);  // neighbours need the old averages, so the new ones are made beside them
  }

  void add_collision(double t, const field& u, std::span<const target<field, double>> targets) override {
    rows_.prepare([&](auto& rows) { rows.reserve(targets.size()); });
    for_blocks(t, u, [&](int begin, int cells, const double* points, const local_relaxation& local) {
      auto& rows = rows_.here();
      for (int i = 0; i < cells; ++i) {
        relaxation::strong_rows at[gauss3::points];
        for (int q = 0; q < gauss3::points; ++q) {
          const int p = i * gauss3::points + q;
          const double w = gauss3::weight[static_cast<std::size_t>(q)];
          at[q] = {w * local.strength(p, epsilon_at(begin + i, q), begin + i),
                   points + static_cast<std::ptrdiff_t>(p) * u.stride(), local.equilibrium(p)};
        }
        upwind::rows_of(targets, begin + i, rows);
        relaxation::add_collision(at, u.row(begin + i), u.stride(), rows);
      }
    });
  }

  /// With the rate of the averages; the rates at the Gauss points differ by the accuracy of the scheme.
  double forward_euler_step(const field& u) const override {
    local_relaxation local;
    local.attach(equation_, 1);
    double fastest = 0.0;
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int q = 0; q < gauss3::points; ++q)
        fastest = std::max(fastest, local.rate(u.row(cell)) / epsilon_at(cell, q));
    return 1.0 / fastest;
  }

  double relaxation_time(const field& u) const override {
    local_relaxation local;
    local.attach(equation_, 1);
    double shortest = std::numeric_limits<double>::infinity();
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int q = 0; q < gauss3::points; ++q)
        shortest = std::min(shortest, local.relaxation_time(u.row(cell), epsilon_at(cell, q)));
    return shortest;
  }

 private:
  double epsilon_at(int cell, int q) const {
    return epsilon_[static_cast<std::size_t>(cell) * gauss3::points + static_cast<std::size_t>(q)];
  }

  /// body(first cell, number of cells, rows of the values at their Gauss points, the equilibria there).
  template <class Body>
  void for_blocks(double t, const field& u, Body body) {
    space_->fill_ghosts(t, u);
    const int at_once = std::max(1, points_at_once(u.stride()) / gauss3::points);
    const int longest = collision_block_length(u.stride());
    scratch_.prepare([&](auto& own) {
      own.block.reserve(how_, std::min(longest, u.cells()), 0, u.stride());
      own.local.attach(equation_, at_once * gauss3::points, how_.positivity != limiter_kind::none);
      own.points.resize(static_cast<std::size_t>(at_once * gauss3::points) *
                        static_cast<std::size_t>(u.stride()));
    });
    parallel_blocks(u.cells(), longest, [&](int begin, int end) {
      auto& [block, points, local] = scratch_.here();
      {
        const profile::section timed(kernel::edges, static_cast<double>(end - begin) * u.stride(),
                                     {how_.scheme->operations(true), sizeof(double)});
        block.load(u, *space_, how_, 0, 0, begin, end, 0);
      }
      for (int i = begin; i < end; i += at_once) {
        const int cells = std::min(at_once, end - i);
        find_points(block, i, cells, u.stride(), points.data());
        local.find_equilibria(points.data(), u.stride(), cells * gauss3::points, i, gauss3::points);
        body(i, cells, points.data(), local);
      }
    });
  }

  void find_points(pencil_block& block, int begin, int cells, int stride, double* points) const {
    const bool limited = how_.positivity != limiter_kind::none;
    const profile::section timed(kernel::points, static_cast<double>(cells) * stride,
                                 {relaxation::operations_of_points(limited), 0.0});
    for (int i = begin; i < begin + cells;
         ++i, points += static_cast<std::ptrdiff_t>(gauss3::points) * stride)
      relaxation::gauss_values(
          {block.row(i - 1), block.row(i), block.row(i + 1), block.left_edge(i), block.right_edge(i)},
          limited, stride, points);
  }

  const relaxation_model& equation_;
  std::shared_ptr<domain> space_;
  stencil how_;
  std::vector<double> epsilon_;
  field result_;
  struct scratch {
    pencil_block block;
    aligned_vector<double> points;
    local_relaxation local;
  };
  per_thread<scratch> scratch_;
  per_thread<std::vector<upwind::row_target>> rows_;
};

}  // namespace

std::unique_ptr<collision> make_cell_average_collision(const relaxation_model& equation,
                                                       std::shared_ptr<domain> space, stencil how,
                                                       std::vector<double> epsilon) {
  if (space->mesh().dimensions() != 1)
    throw input_error(
        "the finite volume formulation collides at the Gauss points of intervals and knows one space "
        "dimension only; use the finite difference formulation");
  return std::make_unique<cell_average_collision>(equation, std::move(space), std::move(how),
                                                  std::move(epsilon));
}

}  // namespace apsis
