#include "method_report.hpp"
#include "two_step_report.hpp"

#include <apsis/method/two_step.hpp>
#include <apsis/run/cfl_limit.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

double number(const mp_real& x) {
  return x.convert_to<double>();
}

}  // namespace

json two_step_json(const method& m) {
  const auto c = certify_two_step(m);
  return {{"name", m.name},
          {"title", m.title},
          {"origin", m.origin},
          {"purpose", m.purpose},
          {"kind", to_string(m.kind)},
          {"steps", m.steps},
          {"order", c.order},
          {"order_residual", number(c.order_residual)},
          {"error_constant", number(c.error_constant)},
          {"ssp_coefficient", number(c.ssp_coefficient)},
          {"cfl_limits", cfl_json(cfl_limits(m))},
          {"second_root", number(c.root)},
          {"type", c.type_a ? "A" : "none"},
          {"stages", m.stages() - 1},
          {"explicit_evaluations", c.explicit_evaluations},
          {"implicit_solves", c.implicit_solves},
          {"buffers", m.stages() + 1},  // rows, among them u^{n−1}, and u^n
          {"r_per_evaluation", number(c.ssp_coefficient) / c.explicit_evaluations},
          {"intermediate_regime",
           {{"keeps", c.keeps_slow_terms ? "slow" : "none"},
            {"band", {{"error", c.band.error}, {"at", c.band.at}}}}},
          {"claims_hold", c.claims_hold()},
          {"failures", c.failures}};
}

std::string two_step_text(const method& m) {
  const auto c = certify_two_step(m);
  std::string out = fmt::format("{}: {}\n", m.name, m.title);
  const auto line = [&out](const char* what, const std::string& value) {
    out += fmt::format("  {:<22} {}\n", what, value);
  };
  line("steps", "2, of equal length (time.dt or time.cfl)");
  line("order", fmt::format("{} ({} conditions, residual {:.1e}), error constant {:.4g}", c.order,
                            c.conditions, number(c.order_residual), number(c.error_constant)));
  line("SSP coefficient r", fmt::format("{:.15g} of the form", number(c.ssp_coefficient)));
  line("linear stability", "CFL number " + cfl_text(cfl_limits(m)));
  line("second root", fmt::format("{:.4g} (zero-stable if below 1 in modulus)", number(c.root)));
  line("type", c.type_a ? "A: asymptotic preserving" : "none");
  line("cost per step", fmt::format("{} transport evaluations, {} implicit solves", c.explicit_evaluations,
                                    c.implicit_solves));
  line("terms of size epsilon",
       c.keeps_slow_terms ? "exact for data near equilibrium (N1, N2)" : "not exact");
  line("where epsilon ~ dt",
       fmt::format("error of the O(epsilon) term at most {:.3g} dt, at epsilon/C = dt/{:.3g}", c.band.error,
                   c.band.at));
  if (c.claims_hold()) return out + "  all claims hold\n";
  return out + fmt::format("  FAILED: {}\n", fmt::join(c.failures, "; "));
}

}  // namespace apsis::app
