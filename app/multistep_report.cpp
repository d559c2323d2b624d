#include "method_report.hpp"
#include "multistep_report.hpp"
#include "two_step_report.hpp"

#include <apsis/run/cfl_limit.hpp>
#include <apsis/run/multistep_stepper.hpp>

#include <fmt/format.h>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

json imex_bdf_json(const multistep_method& m) {
  const auto found = find_multistep_orders(imex_bdf_coefficients<mp_real>(m.steps));
  json failures = json::array();
  if (found.order != m.order)
    failures.push_back(fmt::format("the order is {} instead of {}", found.order, m.order));
  return {{"name", m.name},
          {"title", m.title},
          {"kind", "imex"},
          {"steps", m.steps},
          {"starter", m.starter},
          {"order", found.order},
          {"order_residual", found.residual.convert_to<double>()},
          {"error_constant_of_collisions", found.implicit_constant.convert_to<double>()},
          {"error_constant_of_transport", found.explicit_constant.convert_to<double>()},
          {"ssp_coefficient", m.ssp_coefficient},
          {"cfl_limits", cfl_json(cfl_limits(m))},
          {"error_amplification", error_amplification(m.weights)},
          {"explicit_evaluations", 1},
          {"implicit_solves", 1},
          {"buffers", buffers_of(m)},
          {"claims_hold", failures.empty()},
          {"failures", failures}};
}

std::string imex_bdf_text(const multistep_method& m) {
  const json found = imex_bdf_json(m);
  std::string out =
      fmt::format("{}: {}\n", found["name"].get<std::string>(), found["title"].get<std::string>());
  const auto line = [&out](const char* what, const std::string& value) {
    out += fmt::format("  {:<22} {}\n", what, value);
  };
  const auto number = [&found](const char* key) { return found[key].get<double>(); };
  line("steps", fmt::format("{}, of equal length (time.dt or time.cfl); the first ones by '{}'",
                            found["steps"].get<int>(), found["starter"].get<std::string>()));
  line("order", fmt::format("{} (residual {:.1e}), error constants {:.4g} of Q and {:.4g} of T",
                            found["order"].get<int>(), number("order_residual"),
                            number("error_constant_of_collisions"), number("error_constant_of_transport")));
  line("SSP coefficient r", number("ssp_coefficient") > 0.0
                                ? fmt::format("{:g}", number("ssp_coefficient"))
                                : "none: some weights of earlier values are negative");
  line("linear stability", "CFL number " + cfl_text(cfl_limits(m)));
  line("error amplification",
       fmt::format("errors of at most 1 in every step change u by at most {:.3g} in one",
                   number("error_amplification")));
  line("cost per step", "1 transport evaluation, 1 implicit solve");
  if (found["claims_hold"].get<bool>()) return out + "  all claims hold\n";
  return out + fmt::format("  FAILED: {}\n", found["failures"].front().get<std::string>());
}

}  // namespace

json multistep_json(const multistep_method& m) {
  return m.rows ? two_step_json(*m.rows) : imex_bdf_json(m);
}

std::string multistep_text(const multistep_method& m) {
  return m.rows ? two_step_text(*m.rows) : imex_bdf_text(m);
}

}  // namespace apsis::app
