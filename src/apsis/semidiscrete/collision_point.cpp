#include <apsis/core/parallel.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/local_relaxation.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace apsis {
namespace {

class pointwise_collision final : public collision {
 public:
  pointwise_collision(const relaxation_model& equation, std::vector<double> epsilon)
      : equation_(equation), epsilon_(std::move(epsilon)) {}

  void solve(double a, double b, field& u) override {
    for_blocks(u, [&](int cell, local_relaxation& local) {
      double* row = u.row(cell);
      const auto weights = local.prepare(row, a, b, epsilon_[static_cast<std::size_t>(cell)], cell);
      const double* e = local.equilibrium();
      const double stay = weights.stay, relax = weights.relax;
#pragma omp simd
      for (int k = 0; k < u.components(); ++k) row[k] = stay * row[k] + relax * e[k];
    });
  }

  void scatter(const field& u, std::span<const target<field, double>> targets) override {
    for_blocks(u, [&](int cell, local_relaxation& local) {
      const double* row = u.row(cell);
      const double strength = local.strength(row, epsilon_[static_cast<std::size_t>(cell)], cell);
      const double* e = local.equilibrium();
      for (const auto& to : targets) {
        double* acc = to.acc->row(cell);
        for (int k = 0; k < u.components(); ++k)
          acc[k] = to.combine(acc[k], row[k], strength * (e[k] - row[k]));
      }
    });
  }

  double forward_euler_step(const field& u) const override {
    local_relaxation local;
    local.attach(equation_);
    double fastest = 0.0;
    for (int cell = 0; cell < u.cells(); ++cell)
      fastest = std::max(fastest, local.rate(u.row(cell)) / epsilon_[static_cast<std::size_t>(cell)]);
    return 1.0 / fastest;
  }

  double relaxation_time(const field& u) const override {
    local_relaxation local;
    local.attach(equation_);
    double shortest = std::numeric_limits<double>::infinity();
    for (int cell = 0; cell < u.cells(); ++cell)
      shortest =
          std::min(shortest, local.relaxation_time(u.row(cell), epsilon_[static_cast<std::size_t>(cell)]));
    return shortest;
  }

 private:
  template <class Body>
  void for_blocks(const field& u, Body body) {
    const int length = block_length(u.stride());
    parallel_for((u.cells() + length - 1) / length, [&](int block) {
      thread_local local_relaxation local;
      local.attach(equation_);
      const int end = std::min(u.cells(), (block + 1) * length);
      for (int cell = block * length; cell < end; ++cell) body(cell, local);
    });
  }

  const relaxation_model& equation_;
  std::vector<double> epsilon_;
};

}  // namespace

std::unique_ptr<collision> make_pointwise_collision(const relaxation_model& equation,
                                                    std::vector<double> epsilon) {
  return std::make_unique<pointwise_collision>(equation, std::move(epsilon));
}

}  // namespace apsis
