#include <apsis/core/extremes.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/square_decay.hpp>

namespace apsis::paper {
namespace C12_claim {
namespace {

constexpr int finest = 64;
constexpr double end = 2.0;

struct pair_of_methods {
  const char *title, *dirk, *ssp;
};
constexpr pair_of_methods pairs[] = {{"second order", "dirk-2-2", "imdrk-1-2"},
                                     {"third order", "dirk-4-3", "imdrk-2-3"}};

/// Draws a run. Its curve ends in a marker if a stage equation has no root.
void draw(const decay_run& run, const std::string& label, curve_style style, int colour, panel& into) {
  if (run.u.size() > 1) into.curves.push_back({label, run.t, run.u, style, colour});
  if (!run.solvable)
    into.curves.push_back(
        {label + ": no root", {run.t.back()}, {run.u.back()}, curve_style::markers, colour});
}

panel draw_pair(const pair_of_methods& methods, claim_result& result) {
  panel p{methods.title, "t (dimensionless)", "u (dimensionless)", false, true, {}, {}};
  int right = 0, wrong = 0, total = 0, colour = 0;
  double distance = 0.0;
  for (int n = 4; n <= finest; n *= 2, ++total, ++colour) {
    const int steps = static_cast<int>(end) * n;
    const auto ssp = square_decay(methods.ssp, 1.0 / n, steps);
    const auto dirk = square_decay(methods.dirk, 1.0 / n, steps);
    right += ssp.qualitatively_right() ? 1 : 0;
    wrong += dirk.qualitatively_right() ? 0 : 1;
    distance = maximum(distance, std::abs(ssp.u.back() / square_decay_exact(end) - 1.0));
    draw(ssp, fmt::format("{}, Δt = 1/{}", methods.ssp, n), curve_style::line, colour, p);
    draw(dirk, fmt::format("{}, Δt = 1/{}", methods.dirk, n), curve_style::dashed, colour, p);
  }
  curve exact{"exact", {}, {}, curve_style::dash_dot, -2};
  for (int k = 0; k <= 400; ++k) {
    exact.x.push_back(end * k / 400.0);
    exact.y.push_back(square_decay_exact(exact.x.back()));
  }
  p.curves.push_back(std::move(exact));
  const std::string steps = fmt::format("of {} steps 1/4 … 1/{}", total, finest);
  result.findings.push_back(
      exactly(fmt::format("{}: positive and decreasing for how many {}", methods.ssp, steps), right, total));
  // Only for the step 1/64 < 1/50 is the second-order DIRK method harmless.
  const int harmless = std::string(methods.dirk) == "dirk-2-2" ? 1 : 0;
  result.findings.push_back(
      exactly(fmt::format("{}: not so for how many {}", methods.dirk, steps), wrong, total - harmless));
  result.findings.push_back(
      at_most(fmt::format("{}: largest relative error at t = 2", methods.ssp), distance, 0.3));
  return p;
}

claim_result check(const study_control&) {
  claim_result result;
  picture decay{"C12-decay",
                "u' = −10u², u(0) = 10",
                "Solid: unconditionally SSP implicit two-derivative methods; dashed: DIRK methods of the "
                "same order; dash-dotted: the exact solution 1/(10t + 0.1). The SSP methods are positive and "
                "decreasing for every step, the DIRK methods are not. A marker at the start is a run that "
                "could not begin because its stage equation has no real root.",
                {}};
  for (const auto& methods : pairs) decay.panels.push_back(draw_pair(methods, result));
  result.pictures.push_back(std::move(decay));
  result.remarks = {
      "For dt >= 1/32 the first implicit stage of the DIRK methods, a quadratic equation for u, has no real "
      "root (dirk-2-2, dt = 1/4: 1.25 v^2 + v + 115 = 0); their curves end at the last solvable step."};
  return result;
}

}  // namespace
}  // namespace C12_claim

extern const claim_entry claim_C12;
const claim_entry claim_C12 = {
    .id = "C12",
    .section = "Numerical results, figure of u' = -10 u^2",
    .statement = "the SSP methods are qualitatively right for all steps tested, the DIRK methods are not",
    .how = "both panels of the figure; positivity of every stage and decay in every step",
    .check = C12_claim::check};

}  // namespace apsis::paper
