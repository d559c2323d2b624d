#include <apsis/core/errors.hpp>
#include <apsis/core/relaxation_flow.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/relaxation_rows.hpp>
#include <apsis/model/velocity_support.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace apsis {
namespace {

/// Solves stages in closed form: v = (u + μ E(ω))/(1 + μ), ω = ℛu, μ = aC/ε + |b|(C/ε)² (paper, proof of
/// Proposition AP). Exact solutions are v = e^{−z}u + (1 − e^{−z})E(ω), z = aC/ε.
///
/// Each step (moments, equilibria, weights, combination) processes all points of a batch before the next
/// begins. A step is a chain of dependent operations, and interleaving points hides its latency.
class relaxation_collision final : public point_collision {
 public:
  relaxation_collision(const relaxation_model& equation, const batch_limits& limits)
      : equation_(equation),
        keeps_sign_(limits.keeps_sign),
        exact_(limits.stages == stage_solution::exact),
        moments_(equation.moment_count()),
        pitch_(limits.pitch) {
    const auto points = static_cast<std::size_t>(limits.points);
    omega_.resize(points * static_cast<std::size_t>(moments_));
    // Padding stays zero, like that of the rows of a field.
    equilibria_.assign(points * static_cast<std::size_t>(pitch_), 0.0);
    for (auto* numbers : {&rates_, &weight_of_u_, &weight_of_e_}) numbers->resize(points);
    relaxing_.resize(static_cast<std::size_t>(equation.relaxing_count()));
    rows_.reserve(points);
  }

  void solve_stage(double a, double b, const point_batch& at, double* u) override {
    find_targets(a, b, at, u);
    const profile::section timed(kernel::relaxation, numbers(at),
                                 {relaxation::operations_of_combine, at.cached ? 0.0 : 2.0 * sizeof(double)});
    find_weights(a, b, at);
    for (int p = 0; p < at.count; ++p) {
      const auto k = static_cast<std::size_t>(p);
      relaxation::combine(weight_of_u_[k], weight_of_e_[k], equilibrium(p), width(at), u + p * at.pitch);
    }
  }

  void solve_stage_means(double a, double b, const point_batch& at, double* u,
                         std::span<const double> weights, double* means) override {
    find_targets(a, b, at, u);
    const profile::section timed(kernel::relaxation, numbers(at) / static_cast<double>(weights.size()),
                                 {relaxation::operations_of_mean(weights.size()), sizeof(double)});
    find_weights(a, b, at);
    const int per_group = static_cast<int>(weights.size());
    rows_.resize(weights.size());
    for (int first = 0; first < at.count; first += per_group, means += at.pitch) {
      for (int q = 0; q < per_group; ++q) {
        const auto k = static_cast<std::size_t>(first) + static_cast<std::size_t>(q);
        const double weight = weights[static_cast<std::size_t>(q)];
        rows_[static_cast<std::size_t>(q)] = relaxation::contribution(
            weight, weight_of_u_[k], weight_of_e_[k], u + static_cast<std::ptrdiff_t>(first + q) * at.pitch,
            equilibrium(first + q));
      }
      relaxation::mean(rows_, width(at), means);
    }
  }

  /// Computes v − u = w (E − u) with the weight w ≤ 1 of E. For E ≥ 0 this is at least −u, however it is
  /// rounded. Targets that depend on relaxing moments may be negative; the base class handles their stages.
  void solve_stage_changes(double a, double b, const point_batch& at, const double* u,
                           double* change) override {
    if (!relaxing_.empty()) return point_collision::solve_stage_changes(a, b, at, u, change);
    find_targets(a, b, at, u);
    const profile::section timed(kernel::relaxation, numbers(at),
                                 {relaxation::operations_of_combine, at.cached ? 0.0 : sizeof(double)});
    find_weights(a, b, at);
    for (int p = 0; p < at.count; ++p)
      relaxation::change(weight_of_e_[static_cast<std::size_t>(p)], equilibrium(p), u + p * at.pitch,
                         width(at), change + p * at.pitch);
  }

  void evaluate(const point_batch& at, const double* u, double* q) override {
    find_targets(0.0, 0.0, at, u, true);
    for (int p = 0; p < at.count; ++p)
      relaxation::change(strength(p, at), equilibrium(p), u + p * at.pitch, width(at), q + p * at.pitch);
  }

  double take_cut() override { return std::exchange(cut_, 0.0); }

  double forward_euler_step(const double* u, double epsilon) override { return epsilon / rate(u); }

  double relaxation_time(const double* u, double epsilon) override {
    const double thickness = epsilon / rate(u);
    return thickness > 0.0 ? thickness : std::numeric_limits<double>::infinity();
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  static int width(const point_batch& at) { return static_cast<int>(at.pitch); }
  static double numbers(const point_batch& at) {
    return static_cast<double>(at.count) * static_cast<double>(at.pitch);
  }
  static long cell(int p, const point_batch& at) { return at.first_cell + p / at.points_per_cell; }

  /// Computes the target of every point: E(ℛu), or the target of a stage with relaxing moments. With
  /// `explicit_rate` and a = b = 0 it is the target of Q(u). A stage with a = b = 0 does not use its target.
  void find_targets(double a, double b, const point_batch& at, const double* u, bool explicit_rate = false) {
    const profile::section timed(kernel::equilibria, numbers(at),
                                 {equation_.operations_of_equilibrium(), 0.0});
    equation_.moments_of_rows(u, at.pitch, at.count, omega(0));
    const int p = relaxing_.empty() ? equation_.equilibria(omega(0), at.count, equilibria_.data(), pitch_)
                                    : relaxed_targets(a, b, at, u, explicit_rate);
    if (p == at.count) return;
    const std::string beyond = why_beyond_velocities(equation_, omega(p));
    throw numerical_error(
        "no local equilibrium (" + (beyond.empty() ? equation_.why_inadmissible(omega(p)) + "); " + advice()
                                                   : beyond + "); use a larger velocity.max"),
        {-1, unknown, cell(p, at), *omega(p)});
  }

  /// Computes the targets of stages with relaxing moments. Returns the number of points before the first
  /// without a target.
  int relaxed_targets(double a, double b, const point_batch& at, const double* u, bool explicit_rate) {
    for (int p = 0; p < at.count; ++p) {
      const double* row = u + p * at.pitch;
      const double rate = equation_.rate(omega(p));
      const auto weights = relax_weights(a, b, rate, at.epsilon[p]);
      // For an explicit Q(u) keep is 0, because its forward Euler step ε/C ends at the target.
      const double keep = kept_part(weights);
      equation_.relaxing_moments(row, omega(p), relaxing_.data());
      equation_.relax(coefficients_of_stage(a, b, rate, at.epsilon[p]), relaxing_.data());
      double cut = 0.0;
      if (!equation_.target(omega(p), relaxing_.data(), row, keep, equilibria_.data() + p * pitch_, cut))
        return p;
      if (explicit_rate || weights.of_e > 0.0) cut_ = std::max(cut_, cut);
    }
    return at.count;
  }

  void find_weights(double a, double b, const point_batch& at) {
    const int points = at.count;
    const double* epsilon = at.epsilon;
    double *rates = rates_.data(), *weight_of_u = weight_of_u_.data(), *weight_of_e = weight_of_e_.data();
    for (int p = 0; p < points; ++p) rates[p] = equation_.rate(omega(p));
    if (exact_) {
      for (int p = 0; p < points; ++p) {
        const auto weights = flow_weights(a, rates[p], epsilon[p]);
        weight_of_u[p] = weights.of_u;
        weight_of_e[p] = weights.of_e;
      }
      return;
    }
#pragma omp simd
    for (int p = 0; p < points; ++p) {
      const auto weights = relax_weights(a, b, rates[p], epsilon[p]);
      weight_of_u[p] = weights.of_u;
      weight_of_e[p] = weights.of_e;
    }
  }

  /// Returns C/ε.
  double strength(int p, const point_batch& at) const {
    if (!(at.epsilon[p] > 0.0))
      throw numerical_error(
          "Q/epsilon does not exist for epsilon = 0 (the method evaluates it explicitly); choose an "
          "implicit or IMEX method",
          {-1, unknown, cell(p, at), at.epsilon[p]});
    return equation_.rate(omega(p)) / at.epsilon[p];
  }

  double rate(const double* u) {
    equation_.moments(u, omega(0));
    return equation_.rate(omega(0));
  }

  /// Returns advice for messages. Moments of nonnegative rows have an equilibrium, so that positivity avoids
  /// the error.
  const char* advice() const {
    if (!equation_.positive()) return "use a smaller step";
    if (!equation_.why_signed().empty())
      return "use model.tails = \"nonnegative\" with the positivity limiter, or a smaller step";
    return keeps_sign_
               ? "use steps within r dt_FE (time.safety = 1, and a method with r > 0), which keep all "
                 "values nonnegative"
               : "use the positivity limiter or a smaller step";
  }

  double* omega(int p) { return omega_.data() + p * moments_; }
  const double* omega(int p) const { return omega_.data() + p * moments_; }
  const double* equilibrium(int p) const { return equilibria_.data() + p * pitch_; }

  const relaxation_model& equation_;
  bool keeps_sign_, exact_;
  double cut_ = 0.0;  ///< result of the next take_cut()
  std::ptrdiff_t moments_, pitch_;
  aligned_vector<double> omega_, equilibria_, rates_, weight_of_u_, weight_of_e_;
  std::vector<double> relaxing_;  ///< s of one point
  std::vector<relaxation::weighted_rows> rows_;
};

}  // namespace

std::unique_ptr<point_collision> relaxation_model::make_collision(const batch_limits& limits) const {
  return std::make_unique<relaxation_collision>(*this, limits);
}

}  // namespace apsis
