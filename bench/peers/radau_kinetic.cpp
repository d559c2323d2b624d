#include "grouped_jacobian.hpp"
#include "radau_kinetic.hpp"

#include <apsis/core/errors.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseLU>

namespace apsis::bench::peers {
namespace {

using number = std::complex<double>;

class kinetic_equations {
 public:
  using vector = Eigen::VectorXd;
  using stages = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  static constexpr bool keeps_matrices = true;

  explicit kinetic_equations(kinetic_task& task)
      : task_(task), u_(task.initial()), sum_(task.initial()), differences_(make_differences()) {
    const Eigen::EigenSolver<Eigen::Matrix3d> of_weights(radau_tableau::get().weights);
    int pair = 0;
    for (int i = 0; i < 3; ++i) {
      if (of_weights.eigenvalues()[i].imag() == 0.0) real_ = i;
      if (of_weights.eigenvalues()[i].imag() > 0.0) pair = i;
    }
    pair_ = pair;
    values_ = of_weights.eigenvalues();
    vectors_ = of_weights.eigenvectors();
    inverse_ = vectors_.inverse();
    const auto n = static_cast<Eigen::Index>(u_.cells()) * u_.components();
    identity_.resize(n, n);
    identity_.setIdentity();
  }

  vector initial() const { return packed(task_.initial()); }

  vector rate(const vector& u) {
    using goal = target<field, double>;
    unpack(u, u_);
    const std::array<goal, 1> first = {{{&sum_, 0.0, 1.0, true}}}, more = {{{&sum_, 0.0, 1.0, false}}};
    try {
      task_.problem().add_transport(0.0, u_, first);
      task_.problem().add_collision(0.0, u_, more);
    } catch (const numerical_error&) {
      return vector::Constant(u.size(), std::numeric_limits<double>::quiet_NaN());
    }
    return packed(sum_);
  }

  void linearize(const vector& u) {
    jacobian_ = differences_([this](const vector& x) { return rate(x); }, u);
  }

  void factorize(double h) {
    const Eigen::SparseMatrix<double> of_real = identity_ - h * values_[real_].real() * jacobian_;
    const Eigen::SparseMatrix<number> of_pair =
        identity_.cast<number>() - h * values_[pair_] * jacobian_.cast<number>();
    if (!analysed_) {
      of_real_.analyzePattern(of_real);
      of_pair_.analyzePattern(of_pair);
      analysed_ = true;
    }
    of_real_.factorize(of_real);
    of_pair_.factorize(of_pair);
  }

  /// In the basis of the eigenvectors of A the stages decouple.
  stages newton_change(const stages& defect) const {
    const Eigen::Matrix<number, Eigen::Dynamic, 3> right = defect.cast<number>() * inverse_.transpose();
    const vector of_real = of_real_.solve(vector(right.col(real_).real()));
    const Eigen::VectorXcd of_pair = of_pair_.solve(Eigen::VectorXcd(right.col(pair_)));
    const Eigen::Matrix<number, Eigen::Dynamic, 3> sum =
        of_real.cast<number>() * vectors_.col(real_).transpose() +
        2.0 * of_pair * vectors_.col(pair_).transpose();
    return sum.real();
  }

  /// γ₀ is the real eigenvalue of A.
  vector filtered(const vector& v) const { return of_real_.solve(v); }

  const field& unpack(const vector& from, field& to) const {
    for (int cell = 0; cell < to.cells(); ++cell)
      for (int k = 0; k < to.components(); ++k) to.row(cell)[k] = from[cell * to.components() + k];
    return to;
  }

 private:
  grouped_jacobian make_differences() {
    return {u_.cells(), u_.components(), [this](const vector& x) { return rate(x); },
            packed(task_.initial())};
  }

  static vector packed(const field& from) {
    vector to(from.cells() * from.components());
    for (int cell = 0; cell < from.cells(); ++cell)
      for (int k = 0; k < from.components(); ++k) to[cell * from.components() + k] = from.row(cell)[k];
    return to;
  }

  kinetic_task& task_;
  field u_, sum_;
  grouped_jacobian differences_;
  int real_ = 0, pair_ = 0;
  Eigen::Vector3cd values_;             ///< eigenvalues of A
  Eigen::Matrix3cd vectors_, inverse_;  ///< eigenvectors, and the inverse of their matrix
  Eigen::SparseMatrix<double> jacobian_, identity_;
  bool analysed_ = false;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> of_real_;
  Eigen::SparseLU<Eigen::SparseMatrix<number>> of_pair_;
};

}  // namespace

outcome run_radau(kinetic_task& task, const radau_options& options, double seconds_allowed) {
  kinetic_equations system(task);
  radau_steps run(system, options);
  field u = task.initial();
  run_monitor timer(seconds_allowed);
  bool in_time = true;
  timer.start();
  const bool done = run.integrate(task.end(), [&](const Eigen::VectorXd& now) {
    in_time = timer.stepped(system.unpack(now, u));
    return in_time;
  });
  outcome measured = timer.result(u);
  measured.error = task.error(u);
  if (!in_time)
    measured.failure = "too slow";
  else if (!done || !std::isfinite(measured.error))
    measured.failure = "failed";
  return measured;
}

}  // namespace apsis::bench::peers
