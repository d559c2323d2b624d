#include <apsis/model/nearby_maxwellian.hpp>

#include <apsis/model/formulas/nearby.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/line_powers.hpp>
#include <apsis/model/nearby_cells.hpp>
#include <apsis/model/tensor_product.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace apsis {
namespace {

/// Weights along each direction of a grid, which are Gaussians at the start.
class nearby_lines {
 public:
  nearby_lines(const velocity_grid& grid, const fluid_state& state, const std::array<double*, 3>& weights)
      : d_(static_cast<std::size_t>(grid.dimensions())),
        newton_(scalar::nearby_newton<double>::start(grid.dimensions(), state.T, std::sqrt(state.T))),
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
    return newton_.found > 0.0;
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
  scalar::nearby_newton<double> newton_;
  std::array<double*, 3> weights_;
  std::array<line_powers::points, 3> points_{};
  std::array<double, 3> u_{};
};

/// Fewer cells are faster one by one.
constexpr std::size_t worth_a_group = 3;

/// m ← Newton's method for one row.
bool nearby_maxwellian_of(const velocity_grid& grid, const row_of_state& row) {
  if (grid.dimensions() > 1) return nearby_maxwellian(grid, row.state, row.m);
  return nearby_maxwellian_on_line(grid, {row.state.rho, row.state.u[0], row.state.T}, row.m);
}

/// Newton's method for up to eight cells side by side.
class nearby_group {
 public:
  nearby_group(const velocity_grid& grid, std::span<const row_of_state> rows) : grid_(grid), rows_(rows) {
    const auto d = static_cast<std::size_t>(grid.dimensions());
    int numbers = 0;
    for (int k = 0; k < grid.dimensions(); ++k) numbers += nearby_cells::numbers_for(grid.line(k).points());
    lanes().resize(static_cast<std::size_t>(numbers));
    problem_.dimensions = grid.dimensions();
    problem_.weight_of_grid = grid.weight();
    problem_.lanes = lanes().data();
    for (std::size_t i = 0; i < nearby_cells::together; ++i) {
      const fluid_state& state = of_lane(i).state;
      problem_.T[i] = state.T;
      problem_.rho[i] = state.rho;
      for (std::size_t k = 0; k < d; ++k) problem_.of[k].u[i] = state.u[k];
    }
    for (std::size_t k = 0; k < d; ++k) set_direction(k);
  }

  void solve() {
    nearby_cells::solve(problem_);
    if (problem_.dimensions == 1) return;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (has_found(i))
        tensor_product(grid_, problem_.factor[i],
                       {problem_.of[0].rows[i], problem_.of[1].rows[i], problem_.of[2].rows[i]}, rows_[i].m);
  }
  bool has_found(std::size_t i) const {
    return problem_.found[i] > 0.0 && rows_[i].state.rho >= scalar::dense_enough;
  }

 private:
  static aligned_vector<double>& lanes() {
    thread_local aligned_vector<double> all;
    return all;
  }
  /// The last row fills the lanes without a row.
  const row_of_state& of_lane(std::size_t i) const { return rows_[std::min(i, rows_.size() - 1)]; }

  /// Sets the points and the Gaussians of direction k.
  void set_direction(std::size_t k) {
    const velocity_line& line = grid_.line(static_cast<int>(k));
    auto& of = problem_.of[k];
    of.line = {line.points(), line.v().data(), grid_.uniform() ? nullptr : line.weights().data()};
    if (grid_.dimensions() == 1) {
      for (std::size_t i = 0; i < nearby_cells::together; ++i) of.rows[i] = of_lane(i).m;
      return;
    }
    thread_local std::array<aligned_vector<double>, 3> gaussians;
    const auto n = static_cast<std::size_t>(line.points());
    gaussians[k].resize(nearby_cells::together * n);
    std::array<velocity_rows::gaussian, nearby_cells::together>
        curves;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    for (std::size_t i = 0; i < nearby_cells::together; ++i) {
      of.rows[i] = gaussians[k].data() + std::min(i, rows_.size() - 1) * n;
      curves[i] = {1.0, of.u[i], problem_.T[i]};
    }
    gaussians_on(line, curves.data(), static_cast<int>(rows_.size()), gaussians[k].data(), line.points());
  }

  const velocity_grid& grid_;
  std::span<const row_of_state> rows_;
  nearby_cells::problem problem_{};
};

}  // namespace

int discrete_maxwellians(const velocity_grid& grid, std::span<const row_of_state> rows) {
  for (std::size_t first = 0; first < rows.size(); first += nearby_cells::together) {
    const auto group =
        rows.subspan(first, std::min<std::size_t>(nearby_cells::together, rows.size() - first));
    std::array<bool, nearby_cells::together> found{};
    if (group.size() < worth_a_group) {
      for (std::size_t i = 0; i < group.size(); ++i) found[i] = nearby_maxwellian_of(grid, group[i]);
    } else {
      nearby_group cells(grid, group);
      cells.solve();
      for (std::size_t i = 0; i < group.size(); ++i) found[i] = cells.has_found(i);
    }
    for (std::size_t i = 0; i < group.size(); ++i)
      if (!found[i] && !general_maxwellian(grid, group[i].omega, group[i].m))
        return static_cast<int>(first + i);
  }
  return static_cast<int>(rows.size());
}

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
