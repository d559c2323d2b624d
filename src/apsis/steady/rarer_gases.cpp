#include <apsis/steady/rarer_gases.hpp>

#include <apsis/core/errors.hpp>

#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double ratio = 4.0;
/// A gas whose domain is at most so many mean free paths long settles from any start.
constexpr double short_length = 10.0;
/// Of the solutions, which are starts.
constexpr double loose = 1e-2;
constexpr int most_iterations = 100;

}  // namespace

struct rarer_gases::gas {
  gas(const relaxation_model& equation, const problem_builder& denser, double factor, const field& start,
      int images)
      : space(problem_builder(denser).with_epsilon_times(factor)),
        problem(space.build()),
        solver(equation, space, *problem, start, {loose, most_iterations, images}) {}

  problem_builder space;
  std::unique_ptr<semidiscrete_problem> problem;
  steady_solver solver;
};

std::vector<double> rarer_gases::factors(double optical_length) {
  std::vector<double> found;
  for (double factor = ratio; optical_length * ratio > short_length * factor; factor *= ratio)
    found.insert(found.begin(), factor);
  return found;
}

rarer_gases::rarer_gases(const relaxation_model& equation, const problem_builder& space,
                         std::vector<double> factors, int images)
    : equation_(equation), space_(space), factors_(std::move(factors)), images_(images) {}

rarer_gases::~rarer_gases() = default;

steady_iteration rarer_gases::iterate(field& f) {
  if (!now_) {
    now_ = std::make_unique<gas>(equation_, space_, factors_[next_], f, images_);
    now_->solver.restart(damping_);
  }
  const steady_iteration done = now_->solver.iterate(f);
  damping_ = done.damping;
  if (done.number >= most_iterations)
    throw numerical_error(
        fmt::format("the steady state with {:g} times the epsilon is not found in {} iterations",
                    factors_[next_], most_iterations));
  if (done.converged) {
    now_.reset();
    ++next_;
  }
  return done;
}

}  // namespace apsis
