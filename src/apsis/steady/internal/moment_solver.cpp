#include <apsis/steady/internal/moment_solver.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <unsupported/Eigen/IterativeSolvers>

namespace apsis {
namespace {

/// Relative size of the residual after preconditioning. With directions and 1e-3, some flows need 1/8 more
/// iterations to the steady state. Equations of first order are used for thin cells, for which the sweep
/// determines the number of iterations.
constexpr double tolerance_with_directions = 1e-4, tolerance_of_first_order = 1e-2,
                 tolerance_with_earlier_factors = 1e-5;
/// New factors cost about as much as this many iterations with earlier factors, for all right-hand sides
/// of a J.
constexpr int iterations_with_earlier_factors = 6;
constexpr int iterations_with_directions = 240;
/// Directions of an earlier J are renewed if they need this many times the iterations of new ones.
constexpr double growth_with_earlier_directions = 1.25;
constexpr int iterations_until_restart = 60;
/// Largest number of unknowns for which J is factorized. The factors then take about 2 GB.
constexpr int largest_plane = 250000, largest_space = 25000;

/// Calls a function as a preconditioner of Eigen.
class called_preconditioner {
 public:
  using function = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

  called_preconditioner() = default;
  void call(const function& approximate) { approximate_ = &approximate; }
  template <class Matrix>
  called_preconditioner& analyzePattern(const Matrix&) {  // NOLINT(readability-identifier-naming): of Eigen
    return *this;
  }
  template <class Matrix>
  called_preconditioner& factorize(const Matrix&) {
    return *this;
  }
  template <class Matrix>
  called_preconditioner& compute(const Matrix&) {
    return *this;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& r) const { return (*approximate_)(r); }
  static Eigen::ComputationInfo info() { return Eigen::Success; }

 private:
  const function* approximate_ = nullptr;
};

}  // namespace

bool moment_solver::factorizes(int directions, double unknowns) {
  return directions == 1 || unknowns <= (directions == 2 ? largest_plane : largest_space);
}

double moment_solver::numbers_of_cell(int directions, int moments, double cells) {
  const double square = moments * moments;
  // Measured sizes. Factors of J include the largest sum of blocks for later parts.
  if (!factorizes(directions, moments * cells)) {
    const double steps = alternating_directions::steps(2.0 * std::pow(cells, 1.0 / directions));
    return 20.0 * steps * directions * square;  // factors of lines
  }
  const double depth = std::log2(cells) + 2.0;
  switch (directions) {
    case 1:
      return 14.0 * square;
    case 2:
      return (0.7 * depth * depth + 42.0) * square;  // 16² to 240² cells
    default:
      return 6.7 * std::pow(cells, 0.6) * square;  // 6³ to 11³ cells
  }
}

moment_solver::moment_solver(const moment_mesh& mesh)
    : mesh_(mesh), factorizes_(factorizes(mesh.directions, mesh.unknowns())) {}

void moment_solver::take(moment_equations equations, bool holds_neutral) {
  const Eigen::Index rows = matrix_.rows();
  matrix_ = bordered_matrix(mesh_, equations);
  are_those_of_matrix_ = false;
  iterations_ = 0;
  if (rows != matrix_.rows()) factors_.reset();
  neutral_.reset();
  if (!factorizes_) {
    if (rows != matrix_.rows()) directions_.reset();
    equations_ = std::move(equations);
    if (!directions_) renew_directions();
    return;
  }
  // On a line, factors cost less than iterations.
  if (factors_ == nullptr || holds_neutral || mesh_.directions == 1) factorize_again();
  if (holds_neutral) neutral_ = find_neutral_mode(*factors_);
}

void moment_solver::factorize_again() {
  auto fresh = factors_ ? std::move(factors_) : std::make_unique<frontal_factors>(ends_of_parts());
  fresh->factorize(matrix_);
  factors_ = std::move(fresh);  // null if factorize() has thrown
  are_those_of_matrix_ = true;
}

/// Appends the equations of sums to the last part, because J may be singular without them.
std::vector<int> moment_solver::ends_of_parts() const {
  std::vector<int> ends;
  int cells = 0;
  for (const int count : mesh_.parts) ends.push_back(mesh_.moments * (cells += count));
  if (ends.empty()) ends.resize(1);
  ends.back() = static_cast<int>(matrix_.rows());
  return ends;
}

std::optional<Eigen::VectorXd> moment_solver::iterate(const Eigen::VectorXd& r,
                                                      const preconditioner& approximate, double tolerance,
                                                      int iterations) {
  Eigen::GMRES<row_matrix, called_preconditioner> gmres;
  gmres.compute(matrix_);
  gmres.preconditioner().call(approximate);
  gmres.set_restart(std::min(iterations, iterations_until_restart));
  gmres.setMaxIterations(iterations);
  gmres.setTolerance(tolerance);
  Eigen::VectorXd x = gmres.solve(r);
  iterations_ += static_cast<int>(gmres.iterations());
  if (gmres.info() != Eigen::Success || !x.allFinite()) return std::nullopt;
  return x;
}

void moment_solver::renew_directions() {
  directions_ = std::make_unique<alternating_directions>(mesh_, *equations_);
  iterations_of_new_ = 0;
}

std::optional<Eigen::VectorXd> moment_solver::solve_with_directions(const Eigen::VectorXd& r) {
  const preconditioner steps = [this](const Eigen::VectorXd& of) { return directions_->solve(of); };
  const double tolerance = mesh_.first_order ? tolerance_of_first_order : tolerance_with_directions;
  if (!directions_) renew_directions();
  const bool are_new = iterations_of_new_ == 0;
  const int most = are_new ? iterations_with_directions
                           : static_cast<int>(growth_with_earlier_directions * iterations_of_new_) + 1;
  iterations_ = 0;
  if (auto x = iterate(r, steps, tolerance, most)) {
    if (are_new) iterations_of_new_ = std::max(iterations_, 1);
    return x;
  }
  if (are_new) return std::nullopt;
  renew_directions();
  return solve_with_directions(r);
}

Eigen::VectorXd moment_solver::solve(Eigen::VectorXd r) {
  if (neutral_) neutral_->remove_from_right_side(r);
  if (!factorizes_) {
    if (auto x = solve_with_directions(r)) return *x;
    directions_.reset();  // a later J needs new ones
    throw numerical_error(
        fmt::format("the moment equations of the steady state are not solved ({} iterations do not suffice, "
                    "and {} unknowns are too many to factorize); use a coarser mesh, or march in time",
                    iterations_with_directions, matrix_.rows()));
  }
  if (!are_those_of_matrix_ && iterations_ < iterations_with_earlier_factors) {
    const preconditioner earlier = [this](const Eigen::VectorXd& of) { return factors_->solve(of); };
    if (auto x = iterate(r, earlier, tolerance_with_earlier_factors, iterations_with_earlier_factors))
      return *x;
  }
  if (!are_those_of_matrix_) factorize_again();
  Eigen::VectorXd x = factors_->solve(r);
  if (neutral_) neutral_->remove_from_solution(x);
  return x;
}

}  // namespace apsis
