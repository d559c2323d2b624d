#include <apsis/core/errors.hpp>
#include <apsis/design/finish.hpp>
#include <apsis/method/precision.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/QR>
#include <fmt/format.h>

namespace apsis {
namespace {

/// Newton's method in 60 digits on the equations of a design problem. Its Jacobian is factorized once in
/// double precision, and each iteration gains ten digits or more.
class exact_solution {
 public:
  exact_solution(design_problem& problem, const Eigen::VectorXd& x)
      : problem_(problem), equations_(problem.sweep<mp_real>()), x_(x.begin(), x.end()) {
    constexpr double near = 1e-9;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      std::optional<double> bound;
      for (const double value : {problem.lower()(k), problem.upper()(k)})
        if (std::abs(x(k) - value) <= near) bound = value;
      if (bound)
        x_[static_cast<std::size_t>(k)] = mp_real(*bound);
      else
        free_.push_back(k);
    }
    Eigen::MatrixXd matrix(problem.equations(), static_cast<Eigen::Index>(free_.size()));
    const Eigen::MatrixXd all = problem.jacobian(x);
    for (std::size_t k = 0; k < free_.size(); ++k)
      matrix.col(static_cast<Eigen::Index>(k)) = all.col(free_[k]);
    solver_.compute(matrix);
  }

  /// Returns whether all residuals fall below `tolerance`.
  bool solve(const mp_real& tolerance) {
    constexpr int most_iterations = 20;
    for (int n = 0; n < most_iterations; ++n) {
      const auto residuals = evaluate();
      mp_real largest(0);
      for (const auto& value : residuals) largest = std::max(largest, mp_real(abs(value)));
      if (largest <= tolerance) return true;
      Eigen::VectorXd scaled(static_cast<Eigen::Index>(residuals.size()));
      for (std::size_t k = 0; k < residuals.size(); ++k)
        scaled(static_cast<Eigen::Index>(k)) = static_cast<double>(residuals[k] / largest);
      const Eigen::VectorXd change = solver_.solve(scaled);
      for (std::size_t k = 0; k < free_.size(); ++k)
        x_[static_cast<std::size_t>(free_[k])] -= largest * mp_real(change(static_cast<Eigen::Index>(k)));
    }
    return false;
  }

  const std::vector<mp_real>& unknowns() const { return x_; }

 private:
  std::vector<mp_real> evaluate() {
    equations_.evaluate(problem_.form_of(x_));
    std::vector<mp_real> residuals;
    for (std::size_t k = 0; k < equations_.size(); ++k) residuals.push_back(equations_.residual(k));
    for (const auto& row : problem_.rows()) {
      mp_real sum(-1);
      for (const auto place : row) sum += x_[static_cast<std::size_t>(place)];
      residuals.push_back(sum);
    }
    return residuals;
  }

  design_problem& problem_;
  condition_sweep<mp_real> equations_;
  std::vector<mp_real> x_;
  std::vector<Eigen::Index> free_;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver_;
};

/// Formats short decimals exactly, others with `digits` decimals.
std::string to_text(const mp_real& value, int digits) {
  const auto rounded = static_cast<double>(value);
  std::string exact = fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);
  if (mp_real(rounded) == value && exact.size() < 10) return exact;
  return value.str(digits, std::ios_base::fixed);
}

}  // namespace

method to_polished_two_step_method(const design_task& task, const design_candidate& candidate,
                                   const std::string& name, int digits) {
  design_problem problem(candidate.pattern, task.demands);
  exact_solution exact(problem, candidate.x);
  if (!exact.solve(pow(mp_real(10), -digits - 3)))
    throw numerical_error(
        fmt::format("'{}' cannot be polished to {} digits (its equations are singular to "
                    "rounding); try another seed",
                    name, digits));
  const auto form = problem.form_of(exact.unknowns());
  const std::size_t rows = form.stages();
  method m;
  m.name = name;
  m.title = fmt::format("designed two-step method of order {}", task.demands.order);
  m.citation = "apsis design";
  m.steps = 2;
  m.claims.order = task.demands.order;
  bool relaxes = true;  // with a margin of 0 some row may not relax
  for (std::size_t i = 1; i < rows; ++i) relaxes = relaxes && (form.D(i, i) != 0 || form.ddot[i] != 0);
  if (relaxes) m.claims.type = "A";
  if (task.demands.regime == regime_demand::slow) m.claims.intermediate = "slow";
  auto& e = m.exact;
  e.P = e.W = e.D = matrix<std::string>(rows, rows);
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      e.P(i, j) = to_text(form.P(i, j), digits);
      e.W(i, j) = to_text(form.W(i, j), digits);
      e.D(i, j) = to_text(form.D(i, j), digits);
    }
    e.ddot.push_back(to_text(form.ddot[i], digits));
  }
  m.claims.ssp_coefficient = e.r = to_text(form.r, digits);
  return m;
}

}  // namespace apsis
