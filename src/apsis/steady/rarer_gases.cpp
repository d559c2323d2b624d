#include <apsis/steady/rarer_gases.hpp>

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

constexpr double ratio_of_lengths = 4.0;
/// The iteration converges from any start if the domain is at most this many mean free paths long.
constexpr double short_length = 10.0;

}  // namespace

std::vector<double> rarer_gases::factors(double optical_length) {
  std::vector<double> found;
  for (double factor = ratio_of_lengths; optical_length * ratio_of_lengths > short_length * factor;
       factor *= ratio_of_lengths)
    found.insert(found.begin(), factor);
  return found;
}

rarer_gases::rarer_gases(const relaxation_model& equation, const problem_builder& space,
                         std::vector<double> factors, int images)
    : continuation(equation, factors.size(), images), space_(space), factors_(std::move(factors)) {}

problem_builder rarer_gases::problem(std::size_t number) const {
  return problem_builder(space_).with_epsilon_times(factors_[number]);
}

std::string rarer_gases::name() const {
  return fmt::format("steady states with {:g} times the epsilon", fmt::join(factors_, ", "));
}

std::string rarer_gases::name_of(std::size_t number) const {
  return fmt::format("{:g} times the epsilon", factors_[number]);
}

}  // namespace apsis
