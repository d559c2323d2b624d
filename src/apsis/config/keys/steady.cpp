#include <apsis/config/internal/key_table.hpp>

#include <utility>

namespace apsis {
namespace {

/// Returns the key for cases with a table [steady].
case_key if_steady(case_key of) {
  return only_if([](const case_config& c) { return c.steady_state.tolerance.has_value(); }, std::move(of));
}

std::vector<case_key> steady_keys() {
  return {
      if_steady(key(
          "steady.tolerance", [](auto& c) -> auto& { return c.steady_state.tolerance; },
          {.scope = key_scope::space,
           .lowest = 1e-14,
           .highest = 1e-2,
           .doc = "The run finds the steady state by iterations in place of steps in time, up to this "
                  "residual relative to that of the initial data, and this relative change of the moments. "
                  "Initial data give the start and the mass between walls. The table [time] is not used: t "
                  "counts iterations."})),
      if_steady(key("steady.iterations", [](auto& c) -> auto& { return c.steady_state.iterations; },
                    {.scope = key_scope::space,
                     .lowest = 1,
                     .highest = 1'000'000,
                     .doc = "Most iterations; a run that needs more ends with exit code 3."})),
      if_steady(key(
          "steady.images", [](auto& c) -> auto& { return c.steady_state.images; },
          {.scope = key_scope::space,
           .lowest = 0,
           .highest = 20,
           .doc = "Earlier iterates from which each one is mixed (Anderson), one copy of the state each and "
                  "one more; 0: none."}))};
}

}  // namespace

extern const key_table_entry key_table_steady;
const key_table_entry key_table_steady = {.place = 70, .keys = steady_keys};

}  // namespace apsis
