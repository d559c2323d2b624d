#include <apsis/model/nearby_maxwellian.hpp>

#include <apsis/model/formulas/nearby.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/line_powers.hpp>
#include <apsis/model/tensor_product.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {
namespace {

/// Weights along each direction of a grid, which are Gaussians at the start.
class nearby_lines {
 public:
  nearby_lines(const velocity_grid& grid, const fluid_state& state, const std::array<double*, 3>& weights)
      : d_(static_cast<std::size_t>(grid.dimensions())),
        newton_(scalar::nearby_newton::start(grid.dimensions(), state.T)),
        weights_(weights) {
    for (std::size_t k = 0; k < d_; ++k) {
      const velocity_line& line = grid.line(static_cast<int>(k));
      points_[k] = {line.points(), line.v().data(), grid.uniform() ? nullptr : line.weights().data()};
      u_[k] = state.u[k];
      newton_.of[k].set_ends(line.v().front() - u_[k], line.v().back() - u_[k]);
      set_sums(k, line_powers::sum(points_[k], u_[k], weights_[k]));
    }
  }

  /// Runs Newton's method. Returns false if a step is not small.
  bool solve() {
    while (newton_.advance())
      for (std::size_t k = 0; k < d_; ++k)
        set_sums(k, line_powers::change(points_[k], u_[k], newton_.beta[k], newton_.gamma, weights_[k]));
    return newton_.found;
  }

  /// Returns the factor that gives the product of the weights the density ρ.
  double factor(const velocity_grid& grid, double rho) const {
    return rho / (grid.weight() * newton_.mass());
  }

  void get_moments(line_moments* moments) const {
    if (moments == nullptr) return;
    moments->known = true;
    for (std::size_t k = 0; k < d_; ++k)
      for (std::size_t p = 0; p < line_moments::powers; ++p)
        moments->of[k][p] = newton_.of[k].sums[p] / newton_.of[k].sums[0];
  }

 private:
  void set_sums(std::size_t k, const line_powers::sums& sums) {
    std::copy(sums.begin(), sums.end(), newton_.of[k].sums);
  }

  std::size_t d_;
  scalar::nearby_newton newton_;
  std::array<double*, 3> weights_;
  std::array<line_powers::points, 3> points_{};
  std::array<double, 3> u_{};
};

}  // namespace

bool nearby_maxwellian_on_line(const velocity_grid& grid, const line_state& state, double* m,
                               line_moments* moments) {
  if (!(state.rho >= scalar::dense_enough)) return false;
  nearby_lines lines(grid, {state.rho, {state.u, 0.0, 0.0}, state.T}, {m});
  if (!lines.solve()) return false;
  grid_sums::scale(lines.factor(grid, state.rho), m, grid.size(), m);
  lines.get_moments(moments);
  return true;
}

bool nearby_maxwellian(const velocity_grid& grid, const fluid_state& state, double* m,
                       line_moments* moments) {
  if (!(state.rho >= scalar::dense_enough)) return false;
  const auto d = static_cast<std::size_t>(grid.dimensions());
  if (d == 1) {
    const line_state on_line{state.rho, state.u[0], state.T};
    formula_maxwellian(grid, state, m);
    return nearby_maxwellian_on_line(grid, on_line, m, moments);
  }
  thread_local std::array<aligned_vector<double>, 3> weights;
  std::array<double*, 3> w{};
  for (std::size_t k = 0; k < d; ++k) {
    const velocity_line& line = grid.line(static_cast<int>(k));
    weights[k].resize(static_cast<std::size_t>(line.points()));
    const velocity_rows::gaussian curve{1.0, state.u[k], state.T};
    gaussians_on(line, &curve, 1, weights[k].data(), 0);
    w[k] = weights[k].data();
  }
  nearby_lines lines(grid, state, w);
  if (!lines.solve()) return false;
  tensor_product(grid, lines.factor(grid, state.rho), {w[0], w[1], w[2]}, m);
  lines.get_moments(moments);
  return true;
}

}  // namespace apsis
