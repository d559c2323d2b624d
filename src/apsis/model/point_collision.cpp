#include <apsis/model/point_collision.hpp>

#include <algorithm>
#include <limits>

namespace apsis {

void point_collision::solve_stage_means(double a, double b, const point_batch& at, double* u,
                                        std::span<const double> weights, double* means) {
  solve_stage(a, b, at, u);
  const auto per_group = static_cast<std::ptrdiff_t>(weights.size());
  for (std::ptrdiff_t group = 0; group < at.count / per_group; ++group) {
    const double* of_group = u + group * per_group * at.pitch;
    double* mean = means + group * at.pitch;
    for (std::ptrdiff_t k = 0; k < at.pitch; ++k) {
      double sum = 0.0;
      for (std::ptrdiff_t q = 0; q < per_group; ++q)
        sum += weights[static_cast<std::size_t>(q)] * of_group[q * at.pitch + k];
      mean[k] = sum;
    }
  }
}

void point_collision::solve_stage_changes(double a, double b, const point_batch& at, const double* u,
                                          double* change) {
  const std::ptrdiff_t numbers = at.count * at.pitch;
  std::copy_n(u, numbers, change);
  solve_stage(a, b, at, change);
  for (std::ptrdiff_t k = 0; k < numbers; ++k) change[k] -= u[k];
}

double point_collision::take_cut() {
  return 0.0;
}

double point_collision::forward_euler_step(const double*, double) {
  return 0.0;
}

double point_collision::relaxation_time(const double*, double) {
  return std::numeric_limits<double>::infinity();
}

}  // namespace apsis
