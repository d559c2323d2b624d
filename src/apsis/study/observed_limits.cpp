#include <apsis/study/observed_limits.hpp>

#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/extremes.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/study/case_problem.hpp>
#include <apsis/study/model_properties.hpp>
#include <apsis/verify/adversaries.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

using row = std::vector<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// One line of the result: a search that may depend on ε.
struct experiment {
  std::string problem, property;
  std::vector<double> epsilons;  ///< ε of the search, whose worst counts; one infinity without ε
  std::function<step_limit(double epsilon, double promised)> search;
};

observed_limit worst_of(const experiment& e, double promised, const study_control& control) {
  observed_limit out{e.problem, e.property, promised, {}, ""};
  bool first = true;
  for (const double epsilon : e.epsilons) {
    control.check();
    const step_limit found = e.search(epsilon, promised);
    if (!first && !(found.kept < out.limit.kept)) continue;
    out.limit = found;
    if (e.epsilons.size() > 1)
      out.worst = std::isinf(epsilon) ? "without collisions" : fmt::format("epsilon = {:g}", epsilon);
    first = false;
  }
  return out;
}

experiment advection(const method& m, std::string name, const kept_property<row>& property) {
  return {"upwind advection", std::move(name), {infinity}, [&m, property](double, double promised) {
            ring_advection problem;
            const auto rows = adversarial_rows(24, 20);
            return largest_step(m, problem, std::span<const row>(rows), property,
                                {.steps = 3, .promised = promised});
          }};
}

experiment words(const method& m, const std::vector<double>& epsilons) {
  return {"operators that change from stage to stage", "positivity of all stages", epsilons,
          [&m](double epsilon, double promised) {
            const int letters = static_cast<int>(m.stages());
            constexpr int memory = 2;
            auto problem = word_problem(letters, memory, epsilon);
            const std::vector<row> data{word_data(letters, memory)};
            return largest_step(m, problem, std::span<const row>(data),
                                stays_inside<row>("positivity", negative_part(1), 1e-13),
                                {.stages = true, .promised = promised});
          }};
}

/// Returns a search for the largest growth of several random functionals.
experiment permutations(const method& m, const std::vector<double>& epsilons) {
  return {"permutations that change from stage to stage", "random symmetric convex functionals", epsilons,
          [&m](double epsilon, double promised) {
            constexpr int cells = 40;
            random_source random(5);
            std::vector<kept_property<row>> all;
            for (int k = 0; k < 8; ++k)
              all.push_back(does_not_grow<row>("convex", random_symmetric_functional(random, 1)));
            const kept_property<row> each{"convex", [&all](const row& before, const row& after) {
                                            double most = -infinity;
                                            for (const auto& one : all)
                                              most = maximum(most, one.excess(before, after));
                                            return most;
                                          }};
            auto problem = permutation_problem(cells, epsilon, 11);
            const auto rows = permutation_data(cells, 10);
            return largest_step(m, problem, std::span<const row>(rows), each,
                                {.stages = true, .promised = promised});
          }};
}

/// Returns the method that sets up a small case, which must be of the catalogue. Any method of the same kind
/// sets up the same operators.
std::string stand_in(method_kind kind) {
  if (solves_exactly(kind)) return integrator_names(to_string(kind)).front();
  return kind == method_kind::explicit_only ? "ssprk-2-2" : "forward-backward-euler";
}

experiment entropy(const method& m, const std::string& model, const std::vector<double>& epsilons) {
  return {model + ", first-order upwind", "entropy", epsilons, [&m, model](double epsilon, double promised) {
            case_problem problem(
                small_case(model, stand_in(m.kind), epsilon, 12, {"space.reconstruction=upwind1"}));
            const auto data = adversarial_states(problem, 6, 1e-8, false);
            return largest_step(m, *problem.equations, std::span<const field>(data),
                                entropy_decay(problem.setup),
                                {.steps = 3, .rung = 1.25, .accuracy = 1e-3, .promised = promised});
          }};
}

experiment positive_weno(const method& m, const made_model& model, const std::string& form,
                         const std::vector<double>& epsilons) {
  // The published column for averages was measured with these data (docs/strong-stability.md).
  const bool tame = model.entry->has_velocity_grid && form == "finite-volume";
  return {model.entry->name + ", WENO5 with limiter, " + form, "positivity", epsilons,
          [&m, name = model.entry->name, form, tame](double epsilon, double promised) {
            case_problem problem(small_case(name, stand_in(m.kind), epsilon, 12,
                                            {"space.limiter=positivity", discretization_override(form)}));
            const auto data = adversarial_states(problem, 6, tame ? 0.3 : 1e-8, !tame);
            return largest_step(m, *problem.equations, std::span<const field>(data), positivity(),
                                {.steps = 2, .rung = 1.25, .accuracy = 1e-3, .promised = promised});
          }};
}

experiment square_decay_experiment(const method& m) {
  return {
      "u' = -10 u^2, u <= 10", "positivity of all stages", {infinity}, [&m](double, double promised) {
        newton_problem problem(no_transport{}, [](const auto& u, auto& out) { out[0] = -10 * u[0] * u[0]; });
        const std::vector<row> data{{10.0}, {1.0}, {1e-3}};
        // u + τG ≥ 0 for τ ≤ 1/100.
        return largest_step(
            m, problem, std::span<const row>(data), stays_inside<row>("positivity", negative_part()),
            {.steps = 5, .stages = true, .highest = 1e10, .rung = 1.5, .promised = promised, .unit = 0.01});
      }};
}

std::vector<experiment> experiments_for(const method& m) {
  if (m.kind == method_kind::implicit_only) return {square_decay_experiment(m)};
  const bool is_explicit = m.kind == method_kind::explicit_only;
  const std::vector<double> staged =
      is_explicit ? std::vector{infinity} : std::vector{infinity, 1.0, 1e-2, 1e-4};
  std::vector<double> stiff = {1e-12, 1e-6, 1e-3, 0.1, 1.0, 1e3, 1e12};
  if (!is_explicit) stiff.insert(stiff.begin(), 0.0);
  std::vector<experiment> all{
      advection(m, "total variation", does_not_grow<row>("total variation", total_variation)),
      advection(m, "maximum norm", does_not_grow<row>("maximum norm", maximum_norm)),
      advection(m, "positivity", stays_inside<row>("positivity", negative_part(), 1e-13)), words(m, staged),
      permutations(m, staged)};
  for (const auto& model : all_models()) {
    if (!has_space(*model.entry)) continue;
    if (solves_exactly(m.kind) && !model.equation->has_exact_collision()) continue;
    if (collisions_decrease_entropy(*model.equation)) all.push_back(entropy(m, model.entry->name, stiff));
    if (model.equation->collisions_keep_sign())
      for (const char* form : {"finite-volume", "finite-difference"})
        all.push_back(positive_weno(m, model, form, stiff));
  }
  return all;
}

}  // namespace

std::vector<observed_limit> observe_limits(const method& m, const study_control& control) {
  const double promised = promised_coefficient(certify(m));
  std::vector<observed_limit> out;
  const auto all = experiments_for(m);
  for (const auto& e : all) {
    control.report(static_cast<double>(out.size()) / static_cast<double>(all.size()),
                   e.problem + ": " + e.property);
    out.push_back(worst_of(e, promised, control));
  }
  return out;
}

}  // namespace apsis
