#include <apsis/core/extremes.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/study/model_properties.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C14_claim {
namespace {

/// Returns one of the model's initial data at a random position, disturbed by up to 90 % in every component.
/// It is nonnegative if negative components are unphysical, although some published data are negative.
std::vector<double> disturbed_data(const model& m, random_source& random) {
  std::vector<double> u(static_cast<std::size_t>(m.components()));
  const int data = random.integer(0, static_cast<int>(m.initial().size()));
  m.initial()[static_cast<std::size_t>(data)].point_value({random.uniform(0, 2)}, u);
  for (double& value : u) value *= random.uniform(0.1, 1.9);
  if (m.positive())
    for (double& value : u) value = std::abs(value);
  return u;
}

claim_result check(const study_control& control) {
  constexpr int samples = 500;
  claim_result result;
  for (const auto& m : all_models()) {
    if (m.relaxation == nullptr) continue;
    control.check();
    random_source random(14);
    relaxation_defects worst{0.0, 0.0, 0.0};
    for (int k = 0; k < samples; ++k) {
      const auto one = defects_of(*m.relaxation, disturbed_data(*m.equation, random));
      worst = {maximum(worst.conservation, one.conservation), maximum(worst.equilibrium, one.equilibrium),
               maximum(worst.derivative, one.derivative)};
    }
    const auto add = [&](const char* what, double value, double bound) {
      result.findings.push_back(at_most(fmt::format("{}: {}", m.entry->name, what), value, bound));
    };
    // The bounds allow for the rounding of sums of up to a hundred terms. Differences divide it by their step
    // of 1e-2.
    add("conservation, |R Q| / (1 + |R u|)", worst.conservation, 1e-13);
    add("equilibrium, |Q(E)| / |E| and |R E - w| / (1 + |w|)", worst.equilibrium, 1e-13);
    add("dissipation, |Q'Q + C Q| / ((1 + C)(1 + |u| + |Q|))", worst.derivative, 1e-11);
  }
  result.remarks = {
      fmt::format("largest of {} random states of every relaxation model of the registry: its initial data "
                  "at random positions, every component multiplied by a random number between 0.1 and 1.9",
                  samples)};
  return result;
}

}  // namespace
}  // namespace C14_claim

extern const claim_entry claim_C14;
const claim_entry claim_C14 = {
    .id = "C14",
    .section = "Models, Properties 3-5",
    .statement =
        "R Q = 0, Q(E) = 0 and Q'(u) Q(u) = -C Q(u) for the ODE model, the relaxation system, Broadwell and "
        "BGK",
    .how = "random states of every relaxation model; the derivative by differences",
    .check = C14_claim::check};

}  // namespace apsis::paper
