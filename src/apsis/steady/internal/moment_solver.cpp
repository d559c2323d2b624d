#include <apsis/steady/internal/moment_solver.hpp>

#include <algorithm>
#include <cmath>

#include <unsupported/Eigen/IterativeSolvers>

namespace apsis {
namespace {

/// Relative size of the residual after preconditioning. With directions and 1e-3, some flows take an eighth
/// more iterations to the steady state.
constexpr double tolerance_with_directions = 1e-4, tolerance_with_earlier_factors = 1e-5;
/// More iterations than this with earlier factors, for all right sides of a J, cost as much as new factors.
constexpr int iterations_with_earlier_factors = 12;
constexpr int iterations_with_directions = 240;
constexpr int iterations_until_restart = 60;
/// Most unknowns of a J that is factorized. Factors of this size take about 5 s.
constexpr int largest_plane = 60000, largest_space = 8000;
/// Fewest steps of alternating_directions on such a mesh.
constexpr double fewest_steps = 3.0;

/// Calls a function, as a preconditioner of Eigen.
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
  const double unknowns = moments * cells, band = 8.0 * moments * moments;
  if (!factorizes(directions, unknowns)) return fewest_steps * directions * band;
  switch (directions) {
    case 1:
      return band;
    case 2:
      return 11.0 * moments * moments * std::log2(unknowns);  // measured with 16² to 128² cells
    default:
      return 80.0 * moments * std::cbrt(unknowns);  // with 8³ to 16³ cells
  }
}

moment_solver::moment_solver(const moment_mesh& mesh)
    : mesh_(mesh), factorizes_(factorizes(mesh.directions, mesh.unknowns())) {}

void moment_solver::take(const moment_equations& equations, bool holds_neutral) {
  const Eigen::Index rows = matrix_.rows();
  matrix_ = bordered_matrix(mesh_, equations);
  are_those_of_matrix_ = false;
  iterations_ = 0;
  if (rows != matrix_.rows()) factors_.reset();
  neutral_.reset();
  directions_.reset();
  if (!factorizes_) {
    directions_ = std::make_unique<alternating_directions>(mesh_, equations);
    return;
  }
  // On a line factors cost less than iterations.
  if (factors_ == nullptr || holds_neutral || mesh_.directions == 1) factorize_again();
  if (holds_neutral) neutral_ = find_neutral_mode(*factors_);
}

void moment_solver::factorize_again() {
  factors_ = std::make_unique<sparse_factors>();
  factorize(Eigen::SparseMatrix<double>(matrix_), *factors_);
  are_those_of_matrix_ = true;
}

std::optional<Eigen::VectorXd> moment_solver::iterate(const Eigen::VectorXd& r,
                                                      const preconditioner& approximate, double tolerance,
                                                      int iterations) {
  Eigen::GMRES<Eigen::SparseMatrix<double, Eigen::RowMajor>, called_preconditioner> gmres;
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

Eigen::VectorXd moment_solver::solve(Eigen::VectorXd r) {
  if (neutral_) neutral_->remove_from_right_side(r);
  if (directions_) {
    const preconditioner steps = [this](const Eigen::VectorXd& of) { return directions_->solve(of); };
    if (auto x = iterate(r, steps, tolerance_with_directions, iterations_with_directions)) return *x;
  } else if (!are_those_of_matrix_ && iterations_ < iterations_with_earlier_factors) {
    const preconditioner earlier = [this](const Eigen::VectorXd& of) {
      return Eigen::VectorXd(factors_->solve(of));
    };
    if (auto x = iterate(r, earlier, tolerance_with_earlier_factors, iterations_with_earlier_factors))
      return *x;
  }
  if (!are_those_of_matrix_) factorize_again();
  Eigen::VectorXd x = factors_->solve(r);
  if (neutral_) neutral_->remove_from_solution(x);
  return x;
}

}  // namespace apsis
