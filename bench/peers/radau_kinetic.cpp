#include "grouped_jacobian.hpp"
#include "radau_basis.hpp"
#include "radau_kinetic.hpp"

#include <apsis/core/errors.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <limits>

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
    const auto n = static_cast<Eigen::Index>(u_.cells()) * u_.components();
    identity_.resize(n, n);
    identity_.setIdentity();
  }

  vector initial() const { return packed(task_.initial()); }

  vector rate(double, const vector& u) { return rate(u); }
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

  void linearize(double, const vector& u) {
    jacobian_ = differences_([this](const vector& x) { return rate(x); }, u);
  }

  void factorize(double h) {
    const Eigen::SparseMatrix<double> of_real = identity_ - h * radau_basis::get().real_value() * jacobian_;
    const Eigen::SparseMatrix<number> of_pair =
        identity_.cast<number>() - h * radau_basis::get().pair_value() * jacobian_.cast<number>();
    if (!analysed_) {
      of_real_.analyzePattern(of_real);
      of_pair_.analyzePattern(of_pair);
      analysed_ = true;
    }
    of_real_.factorize(of_real);
    of_pair_.factorize(of_pair);
  }

  stages newton_change(const stages& defect) const {
    return radau_basis::get().solve(
        defect, [this](const vector& v) -> vector { return of_real_.solve(v); },
        [this](const Eigen::VectorXcd& v) -> Eigen::VectorXcd { return of_pair_.solve(v); });
  }

  /// Uses the factors of the real system, because γ₀ is the real eigenvalue of A.
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
  const bool done = run.integrate(0.0, task.end(), [&](const Eigen::VectorXd& now) {
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
