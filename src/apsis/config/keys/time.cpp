#include <apsis/config/internal/key_table.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/method/method_file.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/method/time_integrator.hpp>

namespace apsis {
namespace {

/// Returns "auto" and the names of all methods.
std::vector<std::string> method_choices(const case_config&) {
  std::vector<std::string> names = integrator_names();
  names.emplace_back(automatic_method);
  return names;
}

/// Judges a member of a family, or a method file, for case_key::also. An invalid file throws
/// with its own place.
std::optional<std::string> check_method_outside_catalogue(const std::string& name) {
  if (is_method_file(name)) {
    static_cast<void>(find_integrator(name));
    return "";
  }
  const family_entry* family = try_find_family(name);
  if (family == nullptr) return std::nullopt;
  return missing_member(*family, name);
}

std::vector<case_key> time_keys() {
  return {
      key("time.method", [](auto& c) -> auto& { return c.time.method; },
          {.choices = method_choices,
           .doc = "The time integrator. auto: chosen by the kind of problem, the tolerance, bounds to "
                  "preserve and C dt/epsilon (apsis list choices); the first line of the log states it. "
                  "Otherwise its name in the catalogue, a multistep method for equal steps (apsis list "
                  "multistep), a member of a family (apsis list families) such as md-imex-chain-7-2, or "
                  "a method file of yours (FILE.toml, relative to where the program runs).",
           .also = check_method_outside_catalogue}),
      key("time.end", [](auto& c) -> auto& { return c.time.end; },
          {.required = true,
           .optional = [](const case_config& c) { return c.steady_state.tolerance.has_value(); },
           .dimension = dimensions::time,
           .lowest = 0.0,
           .doc = "Final time; the start is t = 0."}),
      key("time.dt", [](auto& c) -> auto& { return c.time.dt; },
          {.dimension = dimensions::time,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Step size. Exactly one of dt, cfl and safety is given."}),
      key("time.cfl", [](auto& c) -> auto& { return c.time.cfl; },
          {.scope = key_scope::space,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Step size as dt = cfl * dx / v_max, in several dimensions cfl / sum_k (v_max,k / "
                  "dx_k). Exactly "
                  "one of dt, cfl and safety is given."}),
      key("time.safety", [](auto& c) -> auto& { return c.time.safety; },
          {.scope = key_scope::space,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Step size as dt = safety * r * dt_FE with the SSP coefficient r of the method and the "
                  "forward Euler step dt_FE of the transport; positivity is guaranteed up to 1. r dt_FE is "
                  "at most the linear stability limit of the method with the reconstruction "
                  "(apsis check). Exactly one of dt, cfl and safety is given."}),
      key("time.startup", [](auto& c) -> auto& { return c.time.startup; },
          {.doc = "graded: the first step is split into steps that double, starting with a quarter of "
                  "the smallest epsilon/C, so that the initial layer of data out of equilibrium is "
                  "resolved; for methods whose layer is not 1 (apsis check). About log2(4 C dt/epsilon) "
                  "more steps, none for epsilon = 0."}),
      key("time.startup_growth", [](auto& c) -> auto& { return c.time.startup_growth; },
          {.lowest = 2,
           .highest = largest_growth,
           .doc = "Ratio g of the times of a graded start, whose first step is at most g/8 of the "
                  "smallest epsilon/C and each further one g - 1 times the time before it. 4 or 8 takes "
                  "half or a third of the steps with 10 to 100 times the error of the layer, which is "
                  "small for methods of order 5 and more."}),
      key("time.tolerance", [](auto& c) -> auto& { return c.time.tolerance; },
          {.lowest = 0.0,
           .lowest_excluded = true,
           .doc = "Tolerance on the estimated error of each step, which is the 2-norm of the difference "
                  "to the method's embedded solution relative to that of the state; errors off "
                  "equilibrium, which relax, count less in steps shorter than the tolerance asks for "
                  "(docs/methods.md). dt, cfl or safety then limits the step; startup = graded starts in "
                  "the initial layer. Methods without an embedded solution (apsis list methods) compare "
                  "two steps "
                  "of half the length with one instead, and continue with the two."}),
      key("time.controller", [](auto& c) -> auto& { return c.time.controller; },
          {.choices = [](const case_config&) { return step_law_names(); },
           .doc = "With a tolerance: the law by which the next step follows from the errors of the last ones "
                  "(apsis list controllers)."}),
      key("time.steady", [](auto& c) -> auto& { return c.time.steady; },
          {.dimension = dimensions::none / dimensions::time,
           .lowest = 0.0,
           .lowest_excluded = true,
           .doc =
               "The run ends as soon as the state is steady: its change per unit of time, relative to "
               "its 2-norm, is at most this; time.end is then the latest end. The distance from the steady "
               "state is this rate times the time in which it decays, which the summary estimates."})};
}

}  // namespace

extern const key_table_entry key_table_time;
const key_table_entry key_table_time = {.place = 80, .keys = time_keys};

}  // namespace apsis
