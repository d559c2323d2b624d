#include <apsis/method/method_choice.hpp>

#include <limits>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Smallest tolerance of a row that applies to every tolerance.
constexpr double any = 0.0;

std::string text_of(const method_request& wanted) {
  std::string out = wanted.tolerance       ? fmt::format("tolerance {:g}", *wanted.tolerance)
                    : wanted.longest_steps ? "longest steps"
                                           : "equal steps";
  out += wanted.space     ? " on a mesh"
         : wanted.general ? " of a system with a general collision"
                          : " of a system without space";
  if (wanted.signs) out += ", bounds preserved";
  if (!wanted.highest_ratio || !wanted.lowest_ratio) return out;
  if (*wanted.lowest_ratio == *wanted.highest_ratio)
    return out + fmt::format(", C dt/epsilon = {:.2g}", *wanted.highest_ratio);
  return out + fmt::format(", C dt/epsilon = {:.2g} to {:.2g}", *wanted.lowest_ratio, *wanted.highest_ratio);
}

bool belongs(const choice_row& row, const method_request& wanted) {
  if (row.problem == "space") return wanted.space;
  if (row.problem == "general") return !wanted.space && wanted.general;
  return row.problem == "any" || !wanted.space;
}

bool applies(const choice_row& row, const method_request& wanted) {
  if (!belongs(row, wanted)) return false;
  if (row.signs && *row.signs != wanted.signs) return false;
  if (row.tolerance_from.has_value() != wanted.tolerance.has_value()) return false;
  if (wanted.tolerance && *wanted.tolerance < *row.tolerance_from) return false;
  if (row.longest_steps && !wanted.longest_steps) return false;
  if (!row.explicit_method) return true;
  return !wanted.graded_start && wanted.highest_ratio && *wanted.highest_ratio <= resolved_ratio;
}

}  // namespace

const std::vector<choice_row>& choice_table() {
  // Equal steps on a mesh are given, not chosen for an error. Only methods with an SSP coefficient compete
  // for them, because it bounds the step. Where the step equals this bound, the cost per unit of time
  // decides.
  static const std::vector<choice_row> rows = {
      {"space", std::nullopt, false, std::nullopt, true, "md-imex-10-3-long",
       "least CPU time per unit of time at the longest steps, with the right terms of size epsilon",
       "flows at the longest steps, least mean"},
      {"any", true, false, std::nullopt, false, "md-imex-8-3-mixed",
       "SSP for every epsilon, with the right terms of size epsilon",
       "mixed-regime contests, best with an SSP coefficient over errors 1e-3 to 1e-5"},
      {"any", true, false, any, false, "md-imex-10-3-mixed",
       "SSP for every epsilon, reaches tolerances that others do not",
       "mixed-regime contests, best with an SSP coefficient and steps by tolerance"},
      {"space", false, false, std::nullopt, false, "md-imex-8-3-mixed",
       "a step limit from the SSP coefficient, with the right terms of size epsilon",
       "mixed-regime contests, best with an SSP coefficient over errors 1e-3 to 1e-5"},
      {"space", false, false, 1e-4, false, "extrapolated-euler-3", "least CPU time for errors of this size",
       "mixed-regime contests, best with steps by tolerance over errors 1e-3 to 1e-4"},
      {"space", false, false, any, false, "extrapolated-euler-4", "least CPU time for errors of this size",
       "mixed-regime contests, best with steps by tolerance over errors 1e-4 and 1e-5"},
      {"general", false, false, any, false, "ark-548-2",
       "least CPU time where Newton's method solves the stages, and most digits",
       "stiff systems of the literature, least mean of methods without second derivatives"},
      {"system", false, true, std::nullopt, false, "dop853",
       "steps resolve epsilon/C, so an explicit method is cheapest",
       "contests of systems of two unknowns with epsilon = 1, most wins"},
      {"system", false, false, std::nullopt, false, "extrapolated-euler-8",
       "least CPU time for stiff systems",
       "contests of systems of two unknowns with epsilon = 1e-2 to 1e-10, most wins"},
      {"system", false, false, 1e-4, false, "extrapolated-euler-4", "least CPU time for errors of this size",
       "contests of systems of two unknowns, steps by tolerance, most wins for errors 1e-3 and 1e-4"},
      {"system", false, false, 1e-6, false, "extrapolated-euler-5", "least CPU time for errors of this size",
       "contests of systems of two unknowns, steps by tolerance, most wins for errors 1e-5 and 1e-6"},
      {"system", false, false, any, false, "extrapolated-euler-8", "least CPU time for errors of this size",
       "contests of systems of two unknowns, steps by tolerance, most wins for errors 1e-7 to 1e-9"},
  };
  return rows;
}

method_choice choose_method(const method_request& wanted) {
  for (const choice_row& row : choice_table())
    if (applies(row, wanted)) return {row.method, fmt::format("{}: {}", text_of(wanted), row.why)};
  return {"md-imex-8-3-mixed", text_of(wanted)};  // not reached: every kind has a row of any tolerance
}

}  // namespace apsis
