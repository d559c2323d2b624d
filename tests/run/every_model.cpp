// Promises of every model of the registry, checked in one production step from random states. The test
// includes new models automatically.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/run/monitor.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/property.hpp>

namespace every_model_test {

using namespace apsis;

namespace {

/// Returns a small case for a registered model. `dt` is a line of [time].
case_config case_of(const model_entry& entry, const std::string& method, const std::string& dt,
                    const std::vector<std::string>& overrides) {
  std::string text = "[model]\nname = \"" + entry.name + "\"\n";
  if (has_space(entry)) text += "[space]\ncells = 12\ndomain = [0.0, 2.0]\n";
  if (entry.has_velocity_grid) text += "[velocity]\nmax = 9.0\npoints = 36\n";
  text += "[time]\nmethod = \"" + method + "\"\nend = 1.0\n" + dt + "\n";
  return parse_case(text, "case of model " + entry.name, overrides);
}

bool is_positive(const model_entry& entry) {
  return make_model(case_of(entry, "imdrk-1-2", "dt = 0.1", {}))->positive();
}

/// Puts rows of the initial data in random order. Multiplies every value by a random number up to 1.7, and
/// some by 0. Makes values nonnegative where the model requires it. No row vanishes.
void disturb(field& u, bool positive, bool with_zeros) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::uniform_real_distribution<> factor(0.3, 1.7);
  const field before = u;
  for (int i = 0; i < u.cells(); ++i) {
    const double* from = before.row(std::uniform_int_distribution<int>(0, u.cells() - 1)(random));
    for (int k = 0; k < u.components(); ++k) {
      const bool zero = with_zeros && k != u.components() / 2 && random() % 4 == 0;
      const double value = zero ? 0.0 : from[k] * factor(random);
      u.row(i)[k] = positive ? std::abs(value) : value;
    }
  }
}

struct one_step {
  step_record before, after;
};

/// Takes one step from a random state. Its length is r Δt_FE if the model is positive, else Δx/(2v) or 1/16.
one_step step_of(const model_entry& entry, const case_config& c, bool with_zeros, bool uniform = false) {
  const run_setup setup(c);
  budgeted_state now{setup.initial_state(), {}};
  field& u = now.unknowns;
  disturb(u, setup.equation->positive(), with_zeros);
  for (int i = 1; uniform && i < u.cells(); ++i) std::copy_n(u.row(0), u.components(), u.row(i));
  const auto problem = setup.make_problem();
  budgeted_problem budgeted(*problem);
  stepper<budgeted_problem> integrator(setup.integrator().starter(), budgeted);
  monitor watch(setup);
  one_step result;
  result.before = watch.start(u);
  double dt = 1.0 / 16.0;
  if (has_space(entry))
    dt = c.time.safety ? *c.time.safety * setup.step_coefficient() * problem->forward_euler_step(0.0, u)
                       : *c.time.cfl * setup.cfl_length();
  integrator.step(0.0, dt, now);
  result.after = watch.check(now, dt, result.before);
  return result;
}

std::string step_key_for(const model_entry& entry) {
  if (!has_space(entry)) return "dt = 0.0625";
  return is_positive(entry) ? "safety = 1.0" : "cfl = 0.5";
}

/// Returns an IMEX method if there is transport, else an implicit one.
std::string random_method(const model_entry& entry) {
  const auto m = make_model(case_of(entry, "imdrk-1-2", "dt = 0.1", {}));
  if (m->space_dimensions() == 0 && !m->has_source())
    return *rc::gen::element<std::string>("imdrk-1-2", "imdrk-2-3", "imdrk-5-4");
  return *rc::gen::element<std::string>("md-imex-3-2", "md-imex-6-3");
}

/// Returns true if the parameters are valid together and give few enough velocities for a test.
bool accepts(const model_entry& entry, const std::vector<std::string>& overrides) {
  try {
    return make_model(case_of(entry, "imdrk-1-2", "dt = 0.1", overrides))->components() < 10'000;
  } catch (const input_error&) {
    return false;
  }
}

std::vector<std::string> random_overrides(const model_entry& entry, bool positive) {
  std::vector<std::string> overrides;
  // Without a closed form, Newton's method needs a moderate Q/epsilon.
  if (prototype(entry).has_relaxation_time())
    overrides.push_back("model.epsilon=" + *rc::gen::element<std::string>("0", "1e-12", "1e-4", "1", "1e6"));
  else
    overrides.push_back("model.epsilon=" + *rc::gen::element<std::string>("1e-3", "1", "1e6"));
  // More velocity dimensions give the same model, with momenta that are zero up to rounding. Others add
  // degrees of freedom.
  for (auto drawn = overrides; overrides == drawn || !accepts(entry, overrides);) {
    overrides = drawn;
    for (const auto& p : entry.parameters)
      if (p.integer)
        overrides.push_back(fmt::format("model.{}={}", p.name, p.value + *rc::gen::element(0, 0, 0, 1, 3)));
    if (overrides == drawn) break;  // the model has no such parameters
  }
  if (!has_space(entry)) return overrides;
  const bool averages = *rc::gen::arbitrary<bool>();
  overrides.emplace_back(averages ? "space.formulation=finite-volume"
                                  : "space.formulation=finite-difference");
  if (averages && *rc::gen::arbitrary<bool>()) overrides.emplace_back("space.collisions=centres");
  if (positive) overrides.emplace_back("space.limiter=positivity");
  return overrides;
}

}  // namespace

TEST(every_model, conserves_its_invariants_through_a_step) {
  int asked = 0;
  for (const auto* entry : model_entries()) {
    const bool positive = is_positive(*entry);
    if (make_model(case_of(*entry, "imdrk-1-2", "dt = 0.1", {}))->invariants().empty()) continue;
    ++asked;
    check_property(entry->name, [&] {
      const auto c =
          case_of(*entry, random_method(*entry), step_key_for(*entry), random_overrides(*entry, positive));
      const one_step step = step_of(*entry, c, false);
      RC_ASSERT(step.after.conservation_defect.size() == make_model(c)->invariants().size());
      // Twelve cells, six stages and sums over 36 velocities give a few dozen rounding errors of 1e-16. If a
      // sum has terms of both signs, they are larger than the sum.
      const double most = make_model(c)->why_signed().empty() ? 2e-14 : 2e-13;
      for (const double defect : step.after.conservation_defect) RC_ASSERT(defect <= most);
    });
  }
  EXPECT_GE(asked, 3);
}

TEST(every_model, stays_nonnegative_through_a_step_if_it_promises_to) {
  for (const auto* entry : model_entries()) {
    const auto m = make_model(case_of(*entry, "imdrk-1-2", "dt = 0.1", {}));
    if (!m->positive() || !m->collisions_keep_sign()) continue;
    check_property(entry->name, [&] {
      const auto c =
          case_of(*entry, random_method(*entry), step_key_for(*entry), random_overrides(*entry, true));
      const one_step step = step_of(*entry, c, true);
      RC_ASSERT(step.before.negative_values == 0);
      RC_ASSERT(step.after.negative_values == 0);
    });
  }
}

TEST(every_model, loses_entropy_in_a_step_of_first_order_upwind) {
  int asked = 0;
  for (const auto* entry : model_entries()) {
    const auto m = make_model(case_of(*entry, "imdrk-1-2", "dt = 0.1", {}));
    if (!apsis::collisions_decrease_entropy(*m) || !has_space(*entry)) continue;
    ++asked;
    check_property(entry->name, [&] {
      auto overrides = random_overrides(*entry, true);
      overrides.emplace_back("space.reconstruction=upwind1");
      // Mixing by transport would hide a small growth in collisions. Half of the states
      // are therefore uniform.
      const bool uniform = *rc::gen::arbitrary<bool>();
      const auto c = case_of(*entry, random_method(*entry), step_key_for(*entry), overrides);
      const one_step step = step_of(*entry, c, true, uniform);
      // The entropy is a nonlinear sum over twelve rows. Random rows are far from equilibrium, so it usually
      // decreases by percents.
      RC_ASSERT(step.after.entropy_change <= 1e-14 * (1.0 + std::abs(step.before.entropy)));
    });
  }
  EXPECT_GE(asked, 2);
}

TEST(every_model, reads_its_resolved_case_back_with_any_parameters) {
  for (const auto* entry : model_entries()) {
    check_property(entry->name, [&] {
      case_config c = case_of(*entry, "imdrk-1-2", "dt = 0.1", {});
      for (const auto& p : entry->parameters) {
        const double part = 1e-6 * *rc::gen::inRange(0, 1000001);
        // A resolved case has the actual number of dimensions instead of 0.
        const double lowest = p.of_space ? std::max(p.lowest, 1.0) : p.lowest;
        const double value = std::max(lowest, std::min(p.highest, lowest * (1.0 - part) + p.highest * part));
        c.model.parameters[p.name] = p.integer ? std::floor(value) : value;
      }
      for (const auto& t : entry->options) {
        auto choices = t.choices;
        if (!t.variable.empty()) choices.push_back(t.variable + "/3 < 1 ? -2 : \t" + t.variable + "^2");
        c.model.options[t.name] = *rc::gen::elementOf(choices);
      }
      c.model.initial = *rc::gen::elementOf(initial_names(*entry));
      try {
        make_model(c);
      } catch (const input_error&) {
        RC_DISCARD("parameters that are not valid together");
      }
      const case_config again = parse_case(to_toml(c), "again");
      RC_ASSERT(again.model.parameters == c.model.parameters);
      RC_ASSERT(again.model.options == c.model.options);
      RC_ASSERT(again.model.initial == c.model.initial);
      RC_ASSERT(to_toml(again) == to_toml(c));
    });
  }
}

}  // namespace every_model_test
