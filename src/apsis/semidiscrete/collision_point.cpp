#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/local_relaxation.hpp>
#include <apsis/semidiscrete/relaxation_rows.hpp>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace apsis {
namespace {

class pointwise_collision final : public cellwise_collision {
 public:
  pointwise_collision(const relaxation_model& equation, std::vector<double> epsilon, bool limited)
      : equation_(equation), epsilon_(std::move(epsilon)), limited_(limited) {}

  void solve(double, double a, double b, field& u) override {
    prepare(u);
    parallel_blocks(u.cells(), points_at_once(u.stride()),
                    [&](int begin, int end) { relax(a, b, u, begin, end - begin, 2.0 * sizeof(double)); });
  }

  void prepare(const field& u) override { prepare_points(u.stride()); }

  void solve_cells(double a, double b, field& u, int begin, int end) override {
    const int length = points_at_once(u.stride());
    // Rows that were just written are in the cache.
    for (int first = begin; first < end; first += length)
      relax(a, b, u, first, std::min(end - first, length), 0.0);
  }

  void add_collision(double, const field& u, std::span<const target<field, double>> targets) override {
    prepare(u);
    rows_.prepare([&](auto& rows) { rows.reserve(targets.size()); });
    parallel_blocks(u.cells(), points_at_once(u.stride()), [&](int begin, int end) {
      const auto& local = equilibria_of(u, begin, end - begin);
      auto& rows = rows_.here();
      for (int cell = begin; cell < end; ++cell) {
        upwind::rows_of(targets, cell, rows);
        const relaxation::strong_rows point{local.strength(cell - begin, epsilon_at(cell), cell), u.row(cell),
                                            local.equilibrium(cell - begin)};
        relaxation::add_collision({&point, 1}, u.row(cell), u.stride(), rows);
      }
    });
  }

  double forward_euler_step(const field& u) const override {
    local_relaxation local;
    local.attach(equation_, 1);
    double fastest = 0.0;
    for (int cell = 0; cell < u.cells(); ++cell)
      fastest = std::max(fastest, local.rate(u.row(cell)) / epsilon_at(cell));
    return 1.0 / fastest;
  }

  double relaxation_time(const field& u) const override {
    local_relaxation local;
    local.attach(equation_, 1);
    double shortest = std::numeric_limits<double>::infinity();
    for (int cell = 0; cell < u.cells(); ++cell)
      shortest = std::min(shortest, local.relaxation_time(u.row(cell), epsilon_at(cell)));
    return shortest;
  }

 private:
  double epsilon_at(int cell) const { return epsilon_[static_cast<std::size_t>(cell)]; }

  void prepare_points(int stride) {
    local_.prepare([&](auto& local) { local.attach(equation_, points_at_once(stride), limited_); });
  }

  void relax(double a, double b, field& u, int begin, int cells, double bytes) {
    auto& local = equilibria_of(u, begin, cells);
    const profile::section timed(kernel::relaxation, static_cast<double>(cells) * u.stride(),
                                 {relaxation::operations_of_combine, bytes});
    local.find_weights(a, b, epsilon_.data() + begin, cells);
    for (int p = 0; p < cells; ++p) {
      const auto weights = local.weights(p);
      relaxation::combine(weights.stay, weights.relax, local.equilibrium(p), u.stride(), u.row(begin + p));
    }
  }

  /// In scratch space of this thread, until the next call.
  local_relaxation& equilibria_of(const field& u, int begin, int cells) {
    auto& local = local_.here();
    local.find_equilibria(u.row(begin), u.stride(), cells, begin);
    return local;
  }

  const relaxation_model& equation_;
  std::vector<double> epsilon_;
  per_thread<local_relaxation> local_;
  per_thread<std::vector<upwind::row_target>> rows_;
  bool limited_;
};

}  // namespace

std::unique_ptr<collision> make_pointwise_collision(const relaxation_model& equation,
                                                    std::vector<double> epsilon, bool limited) {
  return std::make_unique<pointwise_collision>(equation, std::move(epsilon), limited);
}

}  // namespace apsis
