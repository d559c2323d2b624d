#include <apsis/steady/continuation.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/steady/milder_ends.hpp>
#include <apsis/steady/rarer_gases.hpp>

#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Tolerance of the solutions, which are only starts.
constexpr double loose = 1e-2;
constexpr int most_iterations = 100;

}  // namespace

struct continuation::attempt {
  attempt(const relaxation_model& equation, problem_builder of, const field& start, int images)
      : space(std::move(of)),
        problem(space.build()),
        solver(equation, space, *problem, start, {loose, most_iterations, images}) {}

  problem_builder space;
  std::unique_ptr<semidiscrete_problem> problem;
  steady_solver solver;
};

continuation::continuation(const relaxation_model& equation, std::size_t size, int images)
    : equation_(equation), size_(size), images_(images) {}

continuation::~continuation() = default;

steady_iteration continuation::iterate(field& f) {
  if (!now_) {
    now_ = std::make_unique<attempt>(equation_, problem(next_), f, images_);
    now_->solver.restart(damping_);
  }
  const steady_iteration done = now_->solver.iterate(f);
  damping_ = done.damping;
  if (done.number >= most_iterations)
    throw numerical_error(fmt::format("the steady state with {} is not found in {} iterations",
                                      name_of(next_), most_iterations));
  if (done.converged) {
    now_.reset();
    ++next_;
  }
  return done;
}

std::unique_ptr<continuation> make_continuation(std::size_t number, const relaxation_model& equation,
                                                const problem_builder& space, const field& start,
                                                double optical_length, int images) {
  if (number == 0) {
    std::vector<double> factors = rarer_gases::factors(optical_length);
    if (factors.empty()) return nullptr;
    return std::make_unique<rarer_gases>(equation, space, std::move(factors), images);
  }
  if (!milder_ends::possible(equation, space)) return nullptr;
  return std::make_unique<milder_ends>(equation, space, start, images);
}

}  // namespace apsis
