#include <apsis/exec/parallel.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>
#include <apsis/semidiscrete/point_times.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace apsis {
namespace {

class pointwise_collision final : public cellwise_collision {
 public:
  pointwise_collision(const model& equation, std::vector<double> epsilon, bool keeps_sign,
                      std::vector<cell_range> cells, stage_solution stages)
      : equation_(equation),
        cells_(std::move(cells)),
        epsilon_(std::move(epsilon)),
        keeps_sign_(keeps_sign),
        stages_(stages) {
    if (cells_.empty()) cells_.push_back({0, static_cast<int>(epsilon_.size())});
  }

  void solve(double, double a, double b, field& u) override {
    prepare(u);
    for_blocks(u, [&](int begin, int end) {
      scratch_.here().local->solve_stage(a, b, batch(u, begin, end), u.row(begin));
    });
  }

  void prepare(const field& u) override {
    const int points = points_per_batch(u.stride());
    scratch_.prepare([&](auto& own) {
      if (!own.local) own.local = equation_.make_collision({points, u.stride(), keeps_sign_, stages_});
    });
  }

  void solve_cells(double a, double b, field& u, int begin, int end) override {
    const int length = points_per_batch(u.stride());
    for (int first = begin; first < end; first += length) {
      auto points = batch(u, first, std::min(end, first + length));
      points.cached = true;
      scratch_.here().local->solve_stage(a, b, points, u.row(first));
    }
  }

  void add_collision(double, const field& u, std::span<const target<field, double>> targets) override {
    prepare(u);
    const int length = points_per_batch(u.stride());
    scratch_.prepare([&](auto& own) {
      own.rates.resize(static_cast<std::size_t>(length) * static_cast<std::size_t>(u.stride()));
      own.rows.reserve(targets.size());
    });
    for_blocks(u, [&](int begin, int end) {
      auto& own = scratch_.here();
      own.local->evaluate(batch(u, begin, end), u.row(begin), own.rates.data());
      for (int cell = begin; cell < end; ++cell) {
        const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(cell - begin) * u.stride();
        const collision_rows::weighted_row point{1.0, own.rates.data() + offset};
        upwind::rows_of(targets, cell, own.rows);
        collision_rows::add({&point, 1}, u.row(cell), u.stride(), own.rows);
      }
    });
  }

  double forward_euler_step(const field& u) const override {
    return smallest_time(equation_, u, epsilon_, 1, keeps_sign_, &point_collision::forward_euler_step,
                         cells_);
  }

  double relaxation_time(const field& u) const override {
    return smallest_time(equation_, u, epsilon_, 1, keeps_sign_, &point_collision::relaxation_time, cells_);
  }

  double take_cut() override { return take_largest_cut(scratch_); }

 private:
  point_batch batch(const field& u, int begin, int end) const {
    return {
        .count = end - begin, .pitch = u.stride(), .epsilon = epsilon_.data() + begin, .first_cell = begin};
  }

  /// Calls body(begin, end) for blocks of cells that form a batch, on all threads.
  template <class Body>
  void for_blocks(const field& u, const Body& body) const {
    parallel_blocks(u.cells(), points_per_batch(u.stride()),
                    [&](int begin, int end) { for_cells_in(cells_, begin, end, body); });
  }

  const model& equation_;
  std::vector<cell_range> cells_;
  std::vector<double> epsilon_;
  bool keeps_sign_;
  stage_solution stages_;
  struct scratch {
    std::unique_ptr<point_collision> local;
    aligned_vector<double> rates;  ///< Q/ε of a batch
    std::vector<upwind::row_target> rows;
  };
  per_thread<scratch> scratch_;
};

}  // namespace

std::unique_ptr<collision> make_pointwise_collision(const model& equation, std::vector<double> epsilon,
                                                    bool keeps_sign, std::vector<cell_range> cells,
                                                    stage_solution stages) {
  return std::make_unique<pointwise_collision>(equation, std::move(epsilon), keeps_sign, std::move(cells),
                                               stages);
}

}  // namespace apsis
