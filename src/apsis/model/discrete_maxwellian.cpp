#include <apsis/model/line_family.hpp>
#include <apsis/model/maxwellian.hpp>
#include <apsis/model/nearby_maxwellian.hpp>
#include <apsis/model/polar_maxwellian.hpp>
#include <apsis/model/realizable_moments.hpp>
#include <apsis/model/tensor_product.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace apsis {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// β_k of every direction and the common τ.
struct parameters {
  std::array<double, 3> beta{};
  double tau = 0.0;
};

/// The dual of entropy minimization, in units of Δv. It prescribes the means and Σ_k ⟨C_k⟩ = κ. Here κ is the
/// distance from the boundary on which the chosen parabolas C_k vanish.
class entropy_dual {
 public:
  entropy_dual(const velocity_grid& grid, const realizable_moments& moments,
               std::array<line_family, 3>& lines)
      : grid_(grid), moments_(moments), lines_(lines), d_(static_cast<std::size_t>(grid.dimensions())) {}

  /// Whether the moments lie inside the realizable set, so that some m has them and is positive. In
  /// directions whose mean is an end, m is positive at this end alone.
  bool interior() const { return std::min(moments_.above_least, moments_.below_greatest) > nothing; }

  void look_from(line_family::face face) {
    const bool nearest = face == line_family::face::nearest;
    energy_ = nearest ? moments_.above_least : moments_.below_greatest;
    for (std::size_t k = 0; k < d_; ++k)
      lines_[k].attach(grid_.line(static_cast<int>(k)), !grid_.uniform(), moments_.nearest[k],
                       moments_.offset[k], face);
  }

  /// Returns the parameters of the Gaussian with the variance of the moments. The variance is at least a
  /// tenth of the squared gap between the points with C_k = 0.
  parameters gaussian() const {
    double variance = moments_.square;
    for (std::size_t k = 0; k < d_; ++k) variance -= moments_.z[k] * moments_.z[k];
    parameters at;
    double gap = 0.0;
    for (std::size_t k = 0; k < d_; ++k) gap = std::max(gap, lines_[k].gap_square());
    at.tau = 0.5 / std::max(variance / static_cast<double>(d_), 0.1 * gap);
    for (std::size_t k = 0; k < d_; ++k) at.beta[k] = lines_[k].beta_of_gaussian(at.tau);
    return at;
  }

  /// Solves imbalance_k = 0 and log Σ⟨C_k⟩ = log κ by Newton's method in all parameters together. Returns
  /// false if the residual does not contract.
  bool newton(parameters at) {
    newton_end end;
    for (int iteration = 0; iteration < 20; ++iteration) {
      for (std::size_t k = 0; k < d_; ++k) sums_[k] = lines_[k].evaluate(at.beta[k], at.tau);
      const double residual = defect();
      const bool contracts = residual < 0.9 * end.previous();
      if (end.reached(residual)) return residual < rounding;
      if (!contracts) return false;
      step(at);
    }
    return false;
  }

  /// Solves the same equations by two nested searches for zeros of monotone functions. The inner one adjusts
  /// the means for given τ. The outer one adjusts Σ⟨C_k⟩, which decreases with τ. Returns false if Σ⟨C_k⟩ < κ
  /// at τ = 0, where the other boundary is nearer.
  bool search(parameters at) {
    const double start = at.tau;
    at.tau = 0.0;
    if (excess_at(at) < 0.0) return false;
    double lowest = 0.0, highest = infinity;
    newton_end end;
    move_to(start, at);
    for (int iteration = 0; iteration < 200; ++iteration) {
      const double residual = excess_at(at);
      const bool slow = !(std::abs(residual) < 0.5 * end.previous());
      if (end.reached(std::abs(residual))) break;
      (residual > 0.0 ? lowest : highest) = at.tau;
      double next = at.tau - residual / slope();
      if (next == at.tau) break;
      // The slope is a difference that suffers cancellation if nearly all mass is at two points.
      const double farthest = highest < infinity ? highest : 4.0 * (1.0 + at.tau);
      if (!(next > lowest && next < farthest) || (slow && highest < infinity)) {
        if (end.close()) break;
        next = 0.5 * (lowest + farthest);
      }
      if (next == lowest || next == highest) break;  // adjacent numbers
      move_to(next, at);
    }
    return true;
  }

  void take_limit() {
    for (std::size_t k = 0; k < d_; ++k) {
      sums_[k] = {};
      sums_[k].mass = lines_[k].take_limit();
    }
  }

  void write(double* m) const {
    double partition = grid_.weight();
    std::array<const double*, 3> weights{};
    for (std::size_t k = 0; k < d_; ++k) {
      partition *= sums_[k].mass;
      weights[k] = lines_[k].values();
    }
    constexpr double normal = 1e-290;
    if (moments_.rho > normal) return tensor_product(grid_, moments_.rho / partition, weights, m);
    // The factor would be a subnormal number with few digits.
    tensor_product(grid_, 1.0 / partition, weights, m);
    for (int j = 0; j < grid_.size(); ++j) m[j] *= moments_.rho;
  }

 private:
  /// Moments do not resolve distances from the boundary up to this one; they count as 0.
  static constexpr double nothing = 1e-100;
  /// Residual tolerance of newton(); search() iterates further.
  static constexpr double rounding = 1e-13;

  double total_energy() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < d_; ++k) sum += sums_[k].energy;
    return sum;
  }

  /// Returns log(Σ⟨C_k⟩/κ).
  double excess() const { return line_family::log_of_ratio(total_energy(), energy_); }

  /// Returns the largest residual of the equations, which are all logarithms. NaN or infinite if
  /// weights underflow.
  double defect() const {
    double largest = std::abs(excess());
    for (std::size_t k = 0; k < d_; ++k) {
      if (lines_[k].fixed()) continue;
      const double h = std::abs(sums_[k].imbalance());
      if (!(h <= largest)) largest = h;
    }
    return largest;
  }

  /// Takes one Newton step, which eliminates the β_k from the equation of the energy.
  void step(parameters& at) const {
    struct line {
      double imbalance = 0.0, by_tau = 0.0;  // in units of their slope in β
    };
    std::array<line, 3> lines{};
    double rest = -total_energy() * excess(), corner = 0.0;
    for (std::size_t k = 0; k < d_; ++k) {
      if (lines_[k].fixed()) continue;
      const auto by = lines_[k].differentiate(sums_[k]);
      const double unit = 1.0 / by.imbalance_by_beta;
      lines[k] = {sums_[k].imbalance() * unit, by.imbalance_by_tau * unit};
      rest += by.energy_by_beta * lines[k].imbalance;
      corner += by.energy_by_tau - by.energy_by_beta * lines[k].by_tau;
    }
    const double change = rest / corner;
    at.tau += change;
    for (std::size_t k = 0; k < d_; ++k) at.beta[k] -= lines[k].imbalance + lines[k].by_tau * change;
  }

  /// Adjusts β_k such that all means are as prescribed, and returns excess(). slopes_ ← the slopes there.
  double excess_at(parameters& at) {
    for (std::size_t k = 0; k < d_; ++k) {
      sums_[k] = lines_[k].solve(at.tau, at.beta[k]);
      slopes_[k] = lines_[k].differentiate(sums_[k]);
    }
    return excess();
  }

  /// Returns the derivative of excess_at() with respect to τ at its last call.
  double slope() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < d_; ++k)
      if (!lines_[k].fixed())
        sum += slopes_[k].energy_by_tau -
               slopes_[k].energy_by_beta * slopes_[k].imbalance_by_tau / slopes_[k].imbalance_by_beta;
    return sum / total_energy();
  }

  /// Moves to another τ, to first order along the curve on which the means are as prescribed.
  void move_to(double tau, parameters& at) const {
    for (std::size_t k = 0; k < d_; ++k)
      if (!lines_[k].fixed()) {
        const double change = -(tau - at.tau) * slopes_[k].imbalance_by_tau / slopes_[k].imbalance_by_beta;
        if (std::isfinite(change)) at.beta[k] += change;
      }
    at.tau = tau;
  }

  const velocity_grid& grid_;
  const realizable_moments& moments_;
  std::array<line_family, 3>& lines_;
  std::size_t d_;
  double energy_ = 0.0;
  std::array<line_family::sums, 3> sums_{};
  std::array<line_family::slopes, 3> slopes_{};
};

}  // namespace

bool discrete_maxwellian(const velocity_grid& grid, const double* omega, double* m, line_moments* of_m) {
  if (grid.is_polar()) return discrete_maxwellian_on_rings(grid, omega, m);
  const fluid_state state = to_fluid_state(omega, grid.dimensions());
  return (state.admissible() && nearby_maxwellian(grid, state, m, of_m)) ||
         general_maxwellian(grid, omega, m);
}

bool general_maxwellian(const velocity_grid& grid, const double* omega, double* m) {
  const auto moments = compute_realizable(grid, omega);
  if (!moments) return false;
  if (!(moments->rho > 0.0)) {
    std::fill_n(m, grid.size(), 0.0);
    return true;
  }
  thread_local std::array<line_family, 3> lines;
  entropy_dual dual(grid, *moments, lines);
  if (!dual.interior()) {
    const bool cold = moments->above_least <= moments->below_greatest;
    dual.look_from(cold ? line_family::face::nearest : line_family::face::farthest);
    dual.take_limit();
  } else {
    dual.look_from(line_family::face::nearest);
    const parameters start = dual.gaussian();
    if (!dual.newton(start) && !dual.search(start)) {
      dual.look_from(line_family::face::farthest);
      dual.search({});
    }
  }
  dual.write(m);
  return true;
}

bool discrete_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m) {
  const auto d = static_cast<std::size_t>(grid.dimensions());
  std::array<double, 5> omega{};
  double square = static_cast<double>(d) * state.T;
  omega[0] = state.rho;
  for (std::size_t k = 0; k < d; ++k) {
    omega[1 + k] = state.rho * state.u[k];
    square += state.u[k] * state.u[k];
  }
  omega[1 + d] = 0.5 * state.rho * square;
  return discrete_maxwellian(grid, omega.data(), m);
}

}  // namespace apsis
