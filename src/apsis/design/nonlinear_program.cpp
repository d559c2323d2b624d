#include <apsis/design/nonlinear_program.hpp>

#include <algorithm>
#include <array>
#include <mutex>

#include <Eigen/QR>
#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

namespace apsis {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// MUMPS, the linear solver of Ipopt, keeps global state and must run on one thread at a time. The lock is
// released while functions of a program are evaluated, because this takes most of the time.
std::mutex& solver_guard() {
  static std::mutex guard;
  return guard;
}

class released_lock {
 public:
  released_lock() { solver_guard().unlock(); }
  ~released_lock() { solver_guard().lock(); }
  released_lock(const released_lock&) = delete;
  released_lock& operator=(const released_lock&) = delete;
};

Eigen::Map<const Eigen::VectorXd> vector_of(Index n, const Number* x) {
  return {x, n};
}

class program final : public Ipopt::TNLP {
 public:
  program(design_problem& problem, program_goal goal, Eigen::VectorXd start,
          const std::function<bool()>& stop, program_result& result)
      : problem_(problem), goal_(std::move(goal)), start_(std::move(start)), stop_(stop), result_(result) {
    chosen_ = independent_equations(problem_.jacobian(start_));
  }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian_entries, Index& hessian_entries,
                    IndexStyleEnum& style) override {
    n = static_cast<Index>(problem_.unknowns());
    m = rows();
    jacobian_entries = n * m;
    hessian_entries = n * (n + 1) / 2;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* least, Number* most) override {
    std::copy_n(problem_.lower().data(), n, lower);
    std::copy_n(problem_.upper().data(), n, upper);
    constexpr Number infinite = 2e19;
    std::fill_n(least, m, 0.0);
    std::fill_n(most, m, 0.0);
    auto k = chosen_.size();
    for (const auto& inequality : problem_.inequalities()) {
      least[k] = inequality.least;
      most[k++] = infinite;
    }
    std::fill_n(least + k, problem_.limits(), -infinite);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    std::copy_n(start_.data(), n, x);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    const released_lock free;
    value = goal_.linear.dot(vector_of(n, x));
    for (const auto& [what, weight] : squares())
      if (weight != 0.0) value += weight * problem_.half_square(what, vector_of(n, x));
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    const released_lock free;
    Eigen::VectorXd g = goal_.linear, part;
    for (const auto& [what, weight] : squares()) {
      if (weight == 0.0) continue;
      problem_.half_square(what, vector_of(n, x), &part);
      g += weight * part;
    }
    std::copy_n(g.data(), n, gradient);
    return g.allFinite();
  }

  bool eval_g(Index n, const Number* x, bool, Index, Number* values) override {
    const released_lock free;
    const Eigen::VectorXd c = problem_.residuals(vector_of(n, x));
    for (const auto k : chosen_) *values++ = c(k);
    for (const auto& inequality : problem_.inequalities()) {
      double sum = 0.0;
      for (const auto& [place, factor] : inequality.terms) sum += factor * x[place];
      *values++ = sum;
    }
    const Eigen::VectorXd limits = problem_.limit_values(vector_of(n, x));
    std::copy_n(limits.data(), limits.size(), values);
    return c.allFinite() && limits.allFinite();
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index m, Index entries, Index* row, Index* column,
                  Number* values) override {
    if (values == nullptr) {
      for (Index k = 0; k < entries; ++k) {
        row[k] = k / n;
        column[k] = k % n;
      }
      return true;
    }
    const released_lock free;
    const Eigen::MatrixXd J = problem_.jacobian(vector_of(n, x));
    std::fill_n(values, n * m, 0.0);
    Index at = 0;
    for (const auto k : chosen_)
      for (Index u = 0; u < n; ++u) values[at++] = J(k, u);
    for (const auto& inequality : problem_.inequalities()) {
      for (const auto& [place, factor] : inequality.terms) values[at + place] = factor;
      at += n;
    }
    const Eigen::MatrixXd limits = problem_.limit_jacobian(vector_of(n, x));
    for (Eigen::Index k = 0; k < limits.rows(); ++k)
      for (Index u = 0; u < n; ++u) values[at++] = limits(k, u);
    return J.allFinite() && limits.allFinite();
  }

  bool eval_h(Index n, const Number* x, bool, Number objective_factor, Index, const Number* multipliers, bool,
              Index entries, Index* row, Index* column, Number* values) override {
    if (values == nullptr) {
      Index at = 0;
      for (Index i = 0; i < n; ++i)
        for (Index j = 0; j <= i && at < entries; ++j, ++at) {
          row[at] = i;
          column[at] = j;
        }
      return true;
    }
    const released_lock free;
    design_problem::weights given;
    given.equations = Eigen::VectorXd::Zero(problem_.equations());
    for (std::size_t k = 0; k < chosen_.size(); ++k) given.equations(chosen_[k]) = multipliers[k];
    given.limits = vector_of(static_cast<Index>(problem_.limits()), multipliers + rows() - problem_.limits());
    given.error = objective_factor * goal_.error_weight;
    given.band = objective_factor * goal_.band_weight;
    given.layer = objective_factor * goal_.layer_weight;
    const Eigen::MatrixXd H = problem_.hessian(vector_of(n, x), given);
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j <= i; ++j) *values++ = H(i, j);
    return H.allFinite();
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number, Number, Number,
                             Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    return !stop_ || !stop_();
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    result_.x = vector_of(n, x);
  }

 private:
  Index rows() const {
    return static_cast<Index>(chosen_.size() + problem_.inequalities().size()) +
           static_cast<Index>(problem_.limits());
  }
  std::array<std::pair<design_problem::measure, double>, 3> squares() const {
    return {{{design_problem::measure::error, goal_.error_weight},
             {design_problem::measure::band, goal_.band_weight},
             {design_problem::measure::layer, goal_.layer_weight}}};
  }

  design_problem& problem_;
  program_goal goal_;
  Eigen::VectorXd start_;
  const std::function<bool()>& stop_;
  program_result& result_;
  std::vector<Eigen::Index> chosen_;
};

std::string to_text(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return "solved";
    case Ipopt::Solved_To_Acceptable_Level:
      return "solved to an acceptable level";
    case Ipopt::Maximum_Iterations_Exceeded:
      return "too many iterations";
    case Ipopt::User_Requested_Stop:
      return "stopped";
    case Ipopt::Infeasible_Problem_Detected:
      return "infeasible";
    case Ipopt::Restoration_Failed:
      return "restoration failed";
    default:
      return "status " + std::to_string(static_cast<int>(status));
  }
}

}  // namespace

std::vector<Eigen::Index> independent_equations(const Eigen::MatrixXd& jacobian) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(jacobian.transpose());
  factors.setThreshold(1e-9);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index k = 0; k < factors.rank(); ++k) chosen.push_back(factors.colsPermutation().indices()(k));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

program_goal goal_of(const design_problem& problem, design_objective objective, double band_weight) {
  program_goal goal{Eigen::VectorXd::Zero(problem.unknowns())};
  switch (objective) {
    case design_objective::largest_r:
    case design_objective::efficiency:
      goal.linear(problem.place_of_r()) = -1.0;
      break;
    case design_objective::smallest_mixed:
      goal.layer_weight = band_weight * band_weight;
      [[fallthrough]];
    case design_objective::smallest_band:
      goal.band_weight = band_weight * band_weight;
      [[fallthrough]];
    case design_objective::smallest_error:
      goal.error_weight = 1.0;
      break;
  }
  return goal;
}

program_result optimize(design_problem& problem, const program_goal& goal, const Eigen::VectorXd& x,
                        const std::function<bool()>& stop, int most_iterations) {
  program_result result;
  result.x = x;
  const std::lock_guard lock(solver_guard());
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> solver = IpoptApplicationFactory();
  const auto options = solver->Options();
  options->SetStringValue("sb", "yes");
  options->SetIntegerValue("print_level", 0);
  options->SetIntegerValue("max_iter", most_iterations);
  options->SetNumericValue("tol", 1e-9);
  options->SetNumericValue("constr_viol_tol", 1e-11);
  // Signs must be exact: bounds are neither relaxed nor violated.
  options->SetNumericValue("bound_relax_factor", 0.0);
  options->SetStringValue("mu_strategy", "adaptive");
  if (solver->Initialize() != Ipopt::Solve_Succeeded) {
    result.status = "Ipopt does not start";
    return result;
  }
  const Ipopt::SmartPtr<Ipopt::TNLP> task = new program(problem, goal, x, stop, result);
  const auto status = solver->OptimizeTNLP(task);
  result.status = to_text(status);
  result.solved = status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level;
  result.residual = problem.residuals(result.x).lpNorm<Eigen::Infinity>();
  return result;
}

}  // namespace apsis
