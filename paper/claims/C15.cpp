#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/study/model_properties.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C15_claim {
namespace {

/// Returns the absolute values of the model's initial data at a random position, disturbed over eight
/// decades. A fifth of them are exactly 0.
std::vector<double> nonnegative_data(const model& m, random_source& random) {
  std::vector<double> u(static_cast<std::size_t>(m.components()));
  const int data = random.integer(0, static_cast<int>(m.initial().size()));
  m.initial()[static_cast<std::size_t>(data)].point_value({random.uniform(0, 2)}, u);
  for (double& value : u) value = random.one_in(5) ? 0.0 : std::abs(value) * random.magnitude(-4, 4);
  return u;
}

struct tally {
  long values = 0, zeros = 0, negative = 0, refused = 0;
};

/// Counts negative values after backward Euler steps λ = 1e-12 … 1e12. States without equilibrium are
/// counted separately.
void count(const model& m, const std::vector<double>& u, tally& sum) {
  for (int power = -12; power <= 12; ++power) {
    try {
      for (const double v : backward_euler_on_collision(m, u, std::pow(10.0, power))) {
        ++sum.values;
        sum.negative += v < 0.0 || std::isnan(v) ? 1 : 0;
      }
    } catch (const numerical_error&) {
      ++sum.refused;
    }
  }
  sum.zeros += std::count(u.begin(), u.end(), 0.0);
}

claim_result check(const study_control& control) {
  constexpr int samples = 300;
  claim_result result;
  for (const auto& m : nonnegative_models()) {
    control.check();
    random_source random(15);
    tally sum;
    for (int k = 0; k < samples; ++k) count(*m.equation, nonnegative_data(*m.equation, random), sum);
    result.findings.push_back(
        exactly(fmt::format("{}: negative values among {} after a step (input: {} exact zeros)",
                            m.entry->name, sum.values, sum.zeros),
                sum.negative, 0));
    result.findings.push_back(
        exactly(fmt::format("{}: random states without equilibrium", m.entry->name), sum.refused, 0));
  }
  result.remarks = {
      fmt::format("{} random states of every model with positive unknowns (shakhov with tails = "
                  "\"nonnegative\"), each with 25 steps between 1e-12 "
                  "and 1e12, solved by the production stage solve",
                  samples)};
  return result;
}

}  // namespace
}  // namespace C15_claim

extern const claim_entry claim_C15;
const claim_entry claim_C15 = {
    .id = "C15",
    .section = "Models, Property 2",
    .statement = "backward Euler on the collision keeps positivity for every step",
    .how =
        "random nonnegative states, steps from 1e-12 to 1e12, no value below zero in "
        "floating point, exact zeros in the input",
    .check = C15_claim::check};

}  // namespace apsis::paper
