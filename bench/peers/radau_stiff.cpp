// Radau IIA on the stiff problems of the literature.
#include "radau_basis.hpp"
#include "radau_steps.hpp"
#include "stiff_set.hpp"

#include <complex>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SparseLU>

namespace apsis::bench::peers {
namespace radau_stiff {
namespace {

using number = std::complex<double>;

/// The matrices I − hλJ for the real eigenvalue λ and for one of the pair, stored as dense matrices.
class dense_matrices {
 public:
  explicit dense_matrices(const stiff_system& of)
      : jacobian_(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(of.size()),
                                        static_cast<Eigen::Index>(of.size()))) {}

  void set(std::size_t i, std::size_t j, double value) {
    jacobian_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value;
  }
  void factorize(double of_real, number of_pair) {
    const Eigen::Index n = jacobian_.rows();
    real_.compute(Eigen::MatrixXd::Identity(n, n) - of_real * jacobian_);
    pair_.compute(Eigen::MatrixXcd::Identity(n, n) - of_pair * jacobian_.cast<number>());
  }
  Eigen::VectorXd solve_real(const Eigen::VectorXd& v) const { return real_.solve(v); }
  Eigen::VectorXcd solve_pair(const Eigen::VectorXcd& v) const { return pair_.solve(v); }

 private:
  Eigen::MatrixXd jacobian_;
  Eigen::PartialPivLU<Eigen::MatrixXd> real_;
  Eigen::PartialPivLU<Eigen::MatrixXcd> pair_;
};

/// The same matrices, stored as sparse matrices.
class sparse_matrices {
 public:
  explicit sparse_matrices(const stiff_system& of) {
    const auto n = static_cast<int>(of.size());
    std::vector<Eigen::Triplet<double>> places;
    for (std::size_t j = 0; j < of.size(); ++j)
      for (const std::size_t i : of.pattern().rows(j))
        places.emplace_back(static_cast<int>(i), static_cast<int>(j), 1.0);
    jacobian_.resize(n, n);
    jacobian_.setFromTriplets(places.begin(), places.end());
    identity_.resize(n, n);
    identity_.setIdentity();
    real_.analyzePattern(jacobian_);
    pair_.analyzePattern(jacobian_.cast<number>());
  }

  void set(std::size_t i, std::size_t j, double value) {
    jacobian_.coeffRef(static_cast<int>(i), static_cast<int>(j)) = value;
  }
  void factorize(double of_real, number of_pair) {
    real_.factorize(identity_ - of_real * jacobian_);
    pair_.factorize(identity_.cast<number>() - of_pair * jacobian_.cast<number>());
  }
  Eigen::VectorXd solve_real(const Eigen::VectorXd& v) const { return real_.solve(v); }
  Eigen::VectorXcd solve_pair(const Eigen::VectorXcd& v) const { return pair_.solve(v); }

 private:
  Eigen::SparseMatrix<double> jacobian_, identity_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> real_;
  Eigen::SparseLU<Eigen::SparseMatrix<number>> pair_;
};

template <class Matrices>
class equations {
 public:
  using vector = Eigen::VectorXd;
  using stages = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  static constexpr bool keeps_matrices = true;

  equations(stiff_system& system, double rtol) : system_(system), matrices_(system) {
    const auto start = system.problem().start(), absolute = absolute_tolerances(system.problem(), rtol);
    start_ = to_vector(start);
    absolute_ = to_vector(absolute);
  }

  void start_from(const vector& u) { start_ = u; }
  const vector& initial() const { return start_; }
  const vector& absolute() const { return absolute_; }
  vector rate(double t, const vector& u) {
    vector out(u.size());
    system_.rate(t, u.data(), out.data());
    return out;
  }
  void linearize(double t, const vector& u) {
    system_.jacobian(t, u.data(),
                     [this](std::size_t i, std::size_t j, double value) { matrices_.set(i, j, value); });
  }
  void factorize(double h) {
    const auto& basis = radau_basis::get();
    matrices_.factorize(h * basis.real_value(), h * basis.pair_value());
  }
  stages newton_change(const stages& defect) const {
    return radau_basis::get().solve(
        defect, [this](const vector& v) { return matrices_.solve_real(v); },
        [this](const Eigen::VectorXcd& v) { return matrices_.solve_pair(v); });
  }
  vector filtered(const vector& v) const { return matrices_.solve_real(v); }

 private:
  static vector to_vector(const std::vector<double>& of) {
    return Eigen::Map<const vector>(of.data(), static_cast<Eigen::Index>(of.size()));
  }

  stiff_system& system_;
  Matrices matrices_;
  vector start_, absolute_;
};

template <class Matrices>
stiff_outcome integrate(const stiff_problem_entry& problem, const stiff_limits& limits) {
  const stiff_clock clock(limits.seconds);
  stiff_system system(problem);
  system.begin(0);
  equations<Matrices> all(system, limits.rtol);
  stiff_outcome found;
  bool in_time = true;
  for (std::size_t piece = 0; piece + 1 < problem.times.size() && found.failure.empty(); ++piece) {
    system.begin(piece);
    radau_steps run(all, radau_options{.rtol = limits.rtol, .most_attempts = 100000000});
    const bool done =
        run.integrate(problem.times[piece], problem.times[piece + 1], [&](const Eigen::VectorXd&) {
          ++found.steps;
          in_time = !clock.is_over();
          return in_time;
        });
    if (!done) found.failure = in_time ? "failed" : too_slow;
    all.start_from(run.value());
  }
  const auto& u = all.initial();
  found.u.assign(u.data(), u.data() + u.size());
  found.rates = system.rates();
  found.jacobians = static_cast<double>(system.jacobians());
  return found;
}

}  // namespace
}  // namespace radau_stiff

stiff_outcome run_radau_stiff(const stiff_problem_entry& problem, const stiff_limits& limits) {
  return problem.pattern != nullptr ? radau_stiff::integrate<radau_stiff::sparse_matrices>(problem, limits)
                                    : radau_stiff::integrate<radau_stiff::dense_matrices>(problem, limits);
}

}  // namespace apsis::bench::peers
