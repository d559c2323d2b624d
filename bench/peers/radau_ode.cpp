#include "radau_ode.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/LU>

namespace apsis::bench::peers {
namespace {

class two_equations {
 public:
  using vector = Eigen::Vector2d;
  using stages = Eigen::Matrix<double, 2, 3>;
  static constexpr bool keeps_matrices = false;

  explicit two_equations(const stiff_task& task) : task_(task) {}

  vector initial() const {
    const auto u = task_.initial();
    return {u[0], u[1]};
  }

  vector rate(double, const vector& u) const {
    const stiff_task::state at{u[0], u[1]};
    const auto slow = task_.transport(at), fast = task_.collision(at);
    return {slow[0] + fast[0], slow[1] + fast[1]};
  }

  void linearize(double, const vector& u) {
    const stiff_task::state at{u[0], u[1]};
    jacobian_ = task_.transport_jacobian(at) + task_.collision_jacobian(at);
  }

  void factorize(double h) {
    const auto& method = radau_tableau::get();
    matrix6 system = matrix6::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) system.block<2, 2>(2 * i, 2 * j) -= h * method.weights(i, j) * jacobian_;
    of_stages_.compute(system);
    of_error_.compute(Eigen::Matrix2d::Identity() - h * method.gamma0 * jacobian_);
  }

  stages newton_change(const stages& defect) const {
    const Eigen::Matrix<double, 6, 1> right = defect.reshaped(), change = of_stages_.solve(right);
    return change.reshaped(2, 3);
  }

  vector filtered(const vector& v) const { return of_error_.solve(v); }

 private:
  using matrix6 = Eigen::Matrix<double, 6, 6>;

  const stiff_task& task_;
  Eigen::Matrix2d jacobian_;
  Eigen::PartialPivLU<matrix6> of_stages_;
  Eigen::PartialPivLU<Eigen::Matrix2d> of_error_;
};

}  // namespace

outcome run_radau(const stiff_task& task, const radau_options& options) {
  two_equations system(task);
  radau_steps run(system, options);
  outcome measured;
  measured.smallest = std::numeric_limits<double>::infinity();
  const bool done = run.integrate(0.0, 1.0, [&](const Eigen::Vector2d& u) {
    measured.smallest = std::min({measured.smallest, u[0], u[1]});
    ++measured.steps;
    return true;
  });
  if (!done) {
    measured.failure = "failed";
    return measured;
  }
  measured.seconds =
      seconds_per_call([&] { run.integrate(0.0, 1.0, [](const Eigen::Vector2d&) { return true; }); });
  measured.error = task.error({run.value()[0], run.value()[1]});
  measured.smallest_final = std::min(run.value()[0], run.value()[1]);
  return measured;
}

}  // namespace apsis::bench::peers
