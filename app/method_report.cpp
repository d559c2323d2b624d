#include "method_report.hpp"

#include <apsis/core/word_wrap.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/integrate/step_estimate.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/precision.hpp>
#include <apsis/method/steady_states.hpp>
#include <apsis/run/cfl_limit.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

// Returns the certificate of a method: the stored one of a named method, a new one of a method file.
certificate certificate_of(const method& m) {
  const family_entry* family = try_find_family(m.name);
  const bool named = family == nullptr ? is_method_name(m.name) : missing_member(*family, m.name).empty();
  return named && &find_method(m.name) == &m ? find_certificate(m.name) : certify(m);
}

/// Returns the embedded solution and its cost per step; null without an embedded solution.
json embedded_json(const method& m, const certificate& c) {
  if (!c.embedded) return nullptr;
  const schedule steps(m.with_embedded_row().coefficients<double>(), true);
  return {{"order", c.embedded->order},
          {"convex", m.embedded->convex},
          {"order_residual", c.embedded->order_residual.convert_to<double>()},
          {"estimate", c.embedded->estimate.convert_to<double>()},
          {"alignment", c.embedded->alignment.convert_to<double>()},
          {"weight", c.embedded->weight},
          {"relaxes", c.embedded->relaxes},
          {"last", c.embedded->last ? json(c.embedded->last->convert_to<double>()) : json(nullptr)},
          {"explicit_evaluations", c.embedded->explicit_evaluations},
          {"implicit_solves", c.embedded->implicit_solves},
          {"buffers", steps.buffers()}};
}

/// Returns the error estimate of a method. For a method file the weight is that of the certificate.
step_estimate estimate_of(const method& m, const certificate& c) {
  step_estimate how = apsis::estimate_of(m);
  if (!how.doubles && c.embedded) how.weight = c.embedded->weight;
  return how;
}

json estimate_json(const method& m, const certificate& c) {
  const step_estimate how = estimate_of(m, c);
  return {{"by", how.doubles ? "step doubling" : "embedded solution"},
          {"order", how.order},
          {"weight", how.weight}};
}

/// Describes how the error of a step is estimated, with the cost.
std::string estimate_text(const method& m, const certificate& c) {
  const step_estimate how = estimate_of(m, c);
  if (!how.doubles)
    return fmt::format("embedded solution: weight {:.3g} times the difference of order {}", how.weight,
                       how.order + 1);
  return fmt::format(
      "step doubling: weight {:.3g} times the difference of order {} between one step and two "
      "halves, at three times the cost of a step",
      how.weight, how.order + 1);
}

std::string embedded_text(const json& e) {
  const double weight = e["weight"].get<double>();
  return fmt::format("order {}, estimate {:.4g} (2-norm of its residuals of order {}), alignment {:.3g}{}{}",
                     e["order"].get<int>(), e["estimate"].get<double>(), e["order"].get<int>() + 1,
                     e["alignment"].get<double>(), weight > 1.0 ? fmt::format(", weight {:.3g}", weight) : "",
                     e["convex"].get<bool>() ? "" : ", not convex");
}

std::string embedded_cost_text(const json& e) {
  return fmt::format("{} transport evaluations and {} implicit solves more, {} buffers in all{}",
                     e["explicit_evaluations"].get<int>(), e["implicit_solves"].get<int>(),
                     e["buffers"].get<int>(), e["relaxes"].get<bool>() ? "; relaxed" : "");
}

std::string embedded_term_text(const json& e) {
  return fmt::format("where epsilon << dt, its deviation from equilibrium is {:.4g} times the exact one",
                     e["last"].get<double>());
}

/// Returns the terms of size ε; null if the method has stages that the analysis does not cover. An infinite
/// term is null.
json regime_json(const certificate& c) {
  if (!c.regime.applies) return nullptr;
  const auto& terms = c.regime;
  const auto number = [](const mp_real& x) {
    return isfinite(x) ? json(x.convert_to<double>()) : json(nullptr);
  };
  return {{"flux", number(terms.flux)},
          {"last", number(terms.last)},
          {"layer", number(terms.layer)},
          {"keeps", c.remaining_terms()},
          {"next",
           {{"flux_place", number(terms.flux_place)},
            {"flux_slope", number(terms.flux_slope)},
            {"flux_curvature", number(terms.flux_curvature)},
            {"flux_carried", number(terms.flux_carried)},
            {"last_slope", number(terms.last_slope)},
            {"last_curvature", number(terms.last_curvature)},
            {"layer_place", number(terms.layer_place)},
            {"layer_carried", number(terms.layer_carried)}}},
          {"band", {{"error", c.band.error}, {"at", c.band.at}}}};
}

/// Describes the three terms of size ε relative to the exact ones, so that 1 is exact.
std::string regime_text(const certificate& c) {
  if (!c.regime.applies) return "not covered (a stage is neither relaxed nor u^n)";
  return fmt::format(
      "viscosity {:.4g} (N2), deviation from equilibrium {:.4g} (N1), initial layer {:.4g} (N3)",
      c.regime.flux.convert_to<double>(), c.regime.last.convert_to<double>(),
      c.regime.layer.convert_to<double>());
}

/// Describes the consequence of these terms for the error as dt is refined.
std::string verdict_text(const certificate& c) {
  const std::string parts = "in parts of the exact terms of size epsilon, so 1 is right: ";
  if (!c.keeps_slow_terms) return parts + "the error stalls at a multiple of epsilon";
  return parts + (c.keeps_layer ? "no error of size epsilon is left"
                                : "no error of size epsilon is left if the data start near equilibrium");
}

/// Returns α with two decimals, rounded down so that it does not exceed the proved angle.
std::string angle_text(double angle) {
  return fmt::format("A({:.2f} degrees)", std::floor(angle * 100.0 + 1e-6) / 100.0);
}

/// Returns r/n_F, the step that positivity allows per transport evaluation; null without such a limit.
json figure_of_merit(const certificate& c) {
  if (!c.bounded || c.explicit_evaluations == 0) return nullptr;
  return c.ssp_coefficient.convert_to<double>() / c.explicit_evaluations;
}

std::string ssp_text(const certificate& c) {
  if (!c.bounded) return "no bound";
  return fmt::format("{:.15g}{}", c.ssp_coefficient.convert_to<double>(),
                     c.unconditional || c.ssp_coefficient == 0 ? "" : " (bounded by Q too)");
}

}  // namespace

json cfl_json(const std::vector<std::pair<std::string, double>>& limits) {
  json all = json::object();
  for (const auto& [scheme, limit] : limits) all[scheme] = std::isfinite(limit) ? json(limit) : json(nullptr);
  return all;
}

double defect_of_steady_states(const method& m) {
  const double defect = steady_state_defect(to_butcher(m.coefficients<mp_real>())).convert_to<double>();
  return defect < 1e-30 ? 0.0 : defect;  // coefficients have 40 digits
}

std::string steady_text(const method& m) {
  const double defect = defect_of_steady_states(m);
  if (defect == 0.0) return "those of the equation, for any dt";
  return fmt::format("depend on dt/epsilon (sums of the coefficients of a stage differ by up to {:.3g})",
                     defect);
}

json check_json(const method& m) {
  const certificate c = certificate_of(m);
  const schedule steps(m.coefficients<double>());
  json out = {
      {"name", m.name},
      {"title", m.title},
      {"origin", m.origin},
      {"purpose", m.purpose},
      {"kind", to_string(m.kind)},
      {"order", c.order},
      {"order_residual", c.order_residual.convert_to<double>()},
      {"error_constant", c.error_constant.convert_to<double>()},
      {"ssp_coefficient", c.bounded ? json(c.ssp_coefficient.convert_to<double>()) : json(nullptr)},
      {"unconditional", c.unconditional},
      {"explicit_radius",
       m.kind == method_kind::implicit_only ? json(nullptr) : json(c.explicit_radius.convert_to<double>())},
      {"limiting_entry", c.limiting_entry},
      {"ap", c.ap},
      {"ap_data", c.ap_data},
      {"type", c.type},
      {"gsa", c.gsa},
      {"stages", m.stages()},
      {"explicit_evaluations", c.explicit_evaluations},
      {"implicit_solves", c.implicit_solves},
      {"r_per_evaluation", figure_of_merit(c)},
      {"buffers", steps.buffers()},
      {"embedded", embedded_json(m, c)},
      {"estimate", estimate_json(m, c)},
      {"claims_hold", c.claims_hold},
      {"failures", c.failures}};
  if (m.kind == method_kind::imex) {
    out["intermediate_regime"] = regime_json(c);
    out["steady_state_defect"] = defect_of_steady_states(m);
  }
  if (m.kind != method_kind::implicit_only) out["cfl_limits"] = cfl_json(cfl_limits(amplification(m)));
  if (has_derivatives(m.kind))
    out["stability"] = {{"angle_degrees", c.stability.angle},
                        {"l_stable", c.stability.l_stable},
                        {"largest_on_negative_axis", c.stability.largest_on_negative_axis},
                        {"smallest_on_negative_axis", c.stability.smallest_on_negative_axis},
                        {"at_infinity", c.stability.at_infinity},
                        {"imaginary_poles", c.stability.imaginary_poles}};
  return out;
}

std::string check_text(const method& m) {
  const certificate c = certificate_of(m);
  const schedule steps(m.coefficients<double>());
  std::string out = fmt::format("{}: {}\n", m.name, m.title);
  const auto line = [&out](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<24}{}\n", name, value);
  };
  line("order", fmt::format("{} ({} conditions, largest residual {:.1e})", c.order, c.conditions,
                            c.order_residual.convert_to<double>()));
  const double constant = c.error_constant.convert_to<double>();
  line("error constant",
       std::isnan(constant)
           ? fmt::format("not computed (conditions are known up to order {})", c.order)
           : fmt::format("{:.4g} (2-norm of the residuals of order {})", constant, c.order + 1));
  line("SSP coefficient", ssp_text(c));
  if (!c.limiting_entry.empty()) line("limited by", c.limiting_entry);
  if (m.kind == method_kind::imex || solves_exactly(m.kind))
    line("explicit part",
         fmt::format("SSP coefficient {:.15g} by itself", c.explicit_radius.convert_to<double>()));
  if (m.kind != method_kind::implicit_only)
    line("linear stability", "CFL number " + cfl_text(cfl_limits(amplification(m))));
  line("type", fmt::format("{}{}", c.type, c.gsa ? ", globally stiffly accurate" : ""));
  line("asymptotic preserving", c.ap_data.empty() ? "none" : c.ap_data);
  if (m.kind == method_kind::imex) {
    line("where epsilon << dt", regime_text(c));
    if (c.regime.applies) line("", verdict_text(c));
    line("where epsilon ~ dt",
         fmt::format("error of the viscous flux up to {:.2g} dt, largest at epsilon/C = dt/{:.2g}",
                     c.band.error, c.band.at));
    line("steady states", steady_text(m));
  }
  if (solves_exactly(m.kind) && c.ap)
    line("where epsilon << dt", "terms of size epsilon vanish: exact collisions end in equilibrium");
  line("cost of a step",
       fmt::format("{} transport evaluations, {} {}, {} buffers", c.explicit_evaluations, c.implicit_solves,
                   solves_exactly(m.kind) ? "exact collisions" : "implicit solves", steps.buffers()));
  if (c.embedded) {
    const json e = embedded_json(m, c);
    line("embedded solution", embedded_text(e));
    line("", embedded_cost_text(e));
    if (!e["last"].is_null()) line("", embedded_term_text(e));
  }
  line("estimated error", estimate_text(m, c));
  if (has_derivatives(m.kind))
    line("implicit part", fmt::format("{}, |R| on the negative axis at most {:.6g}, |R(-infinity)| = {:.3g}",
                                      c.stability.l_stable ? "L-stable" : angle_text(c.stability.angle),
                                      c.stability.largest_on_negative_axis, c.stability.at_infinity));
  const auto paragraph = [&line](std::string name, const std::string& text) {
    if (text.empty()) return;
    for (const auto& one : word_wrap(text, 90)) line(std::exchange(name, ""), one);
  };
  paragraph("recommended for", m.purpose);
  paragraph("origin", m.origin);
  line("claims", c.claims_hold ? "hold" : "DO NOT HOLD");
  for (const auto& failure : c.failures) line("", failure);
  return out;
}

std::string first_failure(const method& m) {
  const certificate c = certificate_of(m);
  return c.failures.empty() ? "" : c.failures.front();
}

}  // namespace apsis::app
