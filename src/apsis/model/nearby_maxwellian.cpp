#include <apsis/model/nearby_maxwellian.hpp>

#include <apsis/model/formulas/exponential.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/line_powers.hpp>
#include <apsis/model/tensor_product.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace apsis {
namespace {

/// Weights w = exp(βc + γc²) along one direction, c = v − u, as moments per mass.
class weighted_line {
 public:
  weighted_line() = default;
  weighted_line(const velocity_line& line, bool uniform, double u, double* w)
      : points_{line.points(), line.v().data(), uniform ? nullptr : line.weights().data()},
        u_(u),
        farthest_(std::max(std::abs(line.v().front() - u), std::abs(line.v().back() - u))),
        w_(w),
        sums_(line_powers::sum(points_, u, w)) {}

  double mass() const { return sums_[0]; }                    ///< Σ w
  double mean() const { return sums_[1] / sums_[0]; }         ///< ⟨c⟩
  double mean_square() const { return sums_[2] / sums_[0]; }  ///< ⟨c²⟩
  const double* weights() const { return w_; }                ///< w
  void get_moments(std::array<double, line_moments::powers>& of) const {
    for (std::size_t p = 0; p < of.size(); ++p) of[p] = sums_[p] / sums_[0];
  }

  /// Derivatives of ⟨c⟩ and ⟨c²⟩, that of ⟨c²⟩ by β being that of ⟨c⟩ by γ.
  struct slopes {
    double mean_by_beta, mean_by_gamma, square_by_gamma;
  };
  slopes differentiate() const {
    const double per_mass = 1.0 / sums_[0], c = sums_[1] * per_mass, square = sums_[2] * per_mass;
    return {square - c * c, sums_[3] * per_mass - c * square, sums_[4] * per_mass - square * square};
  }

  /// Returns the largest |βc + γc²|.
  double largest_exponent(double beta, double gamma) const {
    return (std::abs(beta) + std::abs(gamma) * farthest_) * farthest_;
  }
  void change(double beta, double gamma) { sums_ = line_powers::change(points_, u_, beta, gamma, w_); }

 private:
  line_powers::points points_{};
  double u_ = 0.0, farthest_ = 0.0;
  double* w_ = nullptr;
  line_powers::sums sums_{};
};

/// The equations ⟨c_k⟩ = 0 and Σ_k ⟨c_k²⟩ = d T.
class nearby_lines {
 public:
  nearby_lines(const std::array<weighted_line, 3>& lines, int dimensions, double T)
      : lines_(lines),
        d_(static_cast<std::size_t>(dimensions)),
        square_(dimensions * T),
        speed_(std::sqrt(T)) {}

  /// Newton's method. Returns false where a step is not small.
  bool solve() {
    constexpr double rounding = 4.5e-16;  // two roundings
    constexpr double close = 1e-13;       // sums of a few dozen terms may not come nearer than this
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < 8; ++iteration) {
      const double size = defect();
      if (size <= rounding || (size < close && !(size < 0.5 * before))) return true;
      if (!(size < before) || !step()) return false;
      before = size;
    }
    return false;
  }

  double mass() const {
    double product = 1.0;
    for (std::size_t k = 0; k < d_; ++k) product *= lines_[k].mass();
    return product;
  }
  const weighted_line& operator[](std::size_t k) const { return lines_[k]; }

  void get_moments(line_moments* moments) const {
    if (moments == nullptr) return;
    moments->known = true;
    for (std::size_t k = 0; k < d_; ++k) lines_[k].get_moments(moments->of[k]);
  }

 private:
  double missing_square() const {
    double rest = square_;
    for (std::size_t k = 0; k < d_; ++k) rest -= lines_[k].mean_square();
    return rest;
  }

  /// Largest relative residual; NaN without mass.
  double defect() const {
    double largest = std::abs(missing_square()) / square_;
    for (std::size_t k = 0; k < d_; ++k) {
      const double h = std::abs(lines_[k].mean()) / speed_;
      if (!(h <= largest)) largest = h;
    }
    return largest;
  }

  /// The β_k are eliminated from the equation of the energy.
  bool step() {
    struct of_line {
      double mean, by_gamma;  // in units of the slope by β
    };
    std::array<of_line, 3> of{};
    double rest = missing_square(), slope = 0.0;
    for (std::size_t k = 0; k < d_; ++k) {
      const auto by = lines_[k].differentiate();
      of[k] = {lines_[k].mean() / by.mean_by_beta, by.mean_by_gamma / by.mean_by_beta};
      rest += by.mean_by_gamma * of[k].mean;
      slope += by.square_by_gamma - by.mean_by_gamma * of[k].by_gamma;
    }
    const double gamma = rest / slope;
    const auto beta = [&](std::size_t k) { return -of[k].mean - of[k].by_gamma * gamma; };
    for (std::size_t k = 0; k < d_; ++k)
      if (!(lines_[k].largest_exponent(beta(k), gamma) <= scalar::small_exponent)) return false;
    for (std::size_t k = 0; k < d_; ++k) lines_[k].change(beta(k), gamma);
    return true;
  }

  std::array<weighted_line, 3> lines_;
  std::size_t d_;
  double square_, speed_;
};

/// Densities from which on no weight that matters is a subnormal number.
constexpr double dense = 1e-250;

}  // namespace

bool nearby_maxwellian_on_line(const velocity_grid& grid, const line_state& state, double* m,
                               line_moments* moments) {
  if (!(state.rho >= dense)) return false;
  nearby_lines lines({weighted_line(grid.last_line(), grid.uniform(), state.u, m)}, 1, state.T);
  if (!lines.solve()) return false;
  grid_sums::scale(state.rho / (grid.weight() * lines.mass()), m, grid.size(), m);
  lines.get_moments(moments);
  return true;
}

bool nearby_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m,
                       line_moments* moments) {
  if (!(state.rho >= dense)) return false;
  const auto d = static_cast<std::size_t>(grid.dimensions());
  if (d == 1) {
    const line_state on_line{state.rho, state.u[0], state.T};
    formula_maxwellian(grid, state, m);
    return nearby_maxwellian_on_line(grid, on_line, m, moments);
  }
  thread_local std::array<aligned_vector<double>, 3> weights;
  std::array<weighted_line, 3> of;
  for (std::size_t k = 0; k < d; ++k) {
    const velocity_line& line = grid.line(static_cast<int>(k));
    weights[k].resize(static_cast<std::size_t>(line.points()));
    const velocity_rows::gaussian curve{1.0, state.u[k], state.T};
    gaussians_on(line, &curve, 1, weights[k].data(), 0);
    of[k] = weighted_line(line, grid.uniform(), state.u[k], weights[k].data());
  }
  nearby_lines lines(of, grid.dimensions(), state.T);
  if (!lines.solve()) return false;
  std::array<const double*, 3> g{};
  for (std::size_t k = 0; k < d; ++k) g[k] = lines[k].weights();
  tensor_product(grid, state.rho / (grid.weight() * lines.mass()), g, m);
  lines.get_moments(moments);
  return true;
}

}  // namespace apsis
