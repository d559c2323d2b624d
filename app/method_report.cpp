#include "method_report.hpp"

#include <apsis/core/word_wrap.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/intermediate_regime.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

// Methods that have a name are certified once; a file of the user is certified where it is asked about.
certificate certificate_of(const method& m) {
  const family_entry* family = find_family(m.name);
  const bool named = family == nullptr ? is_method_name(m.name) : missing_member(*family, m.name).empty();
  return named && &find_method(m.name) == &m ? find_certificate(m.name) : certify(m);
}

json rows(const matrix<double>& a) {
  json out = json::array();
  for (std::size_t i = 0; i < a.rows(); ++i) {
    json row = json::array();
    for (std::size_t j = 0; j < a.cols(); ++j) row.push_back(a(i, j));
    out.push_back(row);
  }
  return out;
}

json rows(const matrix<std::string>& a) {
  json out = json::array();
  for (std::size_t i = 0; i < a.rows(); ++i) {
    json row = json::array();
    for (std::size_t j = 0; j < a.cols(); ++j) row.push_back(a(i, j).empty() ? "0" : a(i, j));
    out.push_back(row);
  }
  return out;
}

template <class Real>
bool is_diagonal(const matrix<Real>& a) {
  for (std::size_t i = 0; i < a.rows(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (a(i, j) != Real(0)) return false;
  return true;
}

json diagonal(const json& matrix_rows) {
  json out = json::array();
  for (std::size_t i = 0; i < matrix_rows.size(); ++i) out.push_back(matrix_rows[i][i]);
  return out;
}

json document_json(const method& m) {
  const auto form = m.coefficients<double>();
  const auto butcher = to_butcher(form);
  const json d_rows = rows(form.D), exact_d_rows = rows(m.exact.D);
  const bool diagonal_d = is_diagonal(form.D);
  // Methods outside the paper's class have a full lower triangular D; d is then its diagonal.
  json out = {{"name", m.name},       {"title", m.title},     {"citation", m.citation},
              {"origin", m.origin},   {"purpose", m.purpose}, {"kind", to_string(m.kind)},
              {"stages", m.stages()}, {"P", rows(form.P)},    {"W", rows(form.W)},
              {"d", diagonal(d_rows)}};
  json exact = {{"P", rows(m.exact.P)}, {"W", rows(m.exact.W)}, {"d", diagonal(exact_d_rows)}};
  if (!diagonal_d) {
    out["D"] = d_rows;
    exact["D"] = exact_d_rows;
  }
  out["ddot"] = form.ddot;
  out["r"] = form.r;
  exact["ddot"] = m.exact.ddot;
  exact["r"] = m.exact.r;
  out["A_hat"] = rows(butcher.A_hat);
  out["A"] = rows(butcher.A);
  out["A_dot"] = rows(butcher.A_dot);
  out["exact"] = exact;
  out["claims"] = {{"order", m.claims.order}};
  if (m.claims.ssp_coefficient) out["claims"]["ssp_coefficient"] = *m.claims.ssp_coefficient;
  if (m.claims.type) out["claims"]["type"] = *m.claims.type;
  if (m.claims.explicit_radius) out["claims"]["explicit_radius"] = *m.claims.explicit_radius;
  if (m.claims.l_stable) out["claims"]["l_stable"] = *m.claims.l_stable;
  if (m.claims.intermediate) out["claims"]["intermediate"] = *m.claims.intermediate;
  if (m.embedded)
    out["embedded"] = {{"order", m.embedded->order}, {"origin", m.embedded->origin},
                       {"P", m.embedded->P},         {"W", m.embedded->W},
                       {"d", m.embedded->d},         {"ddot", m.embedded->ddot}};
  return out;
}

/// What the embedded solution is and what it adds to a step; null without one.
json embedded_json(const method& m, const certificate& c) {
  if (!c.embedded) return nullptr;
  const schedule steps(m.with_embedded_row().coefficients<double>(), true);
  return {{"order", c.embedded->order},
          {"order_residual", c.embedded->order_residual.convert_to<double>()},
          {"estimate", c.embedded->estimate.convert_to<double>()},
          {"alignment", c.embedded->alignment.convert_to<double>()},
          {"relaxes", c.embedded->relaxes},
          {"last", c.embedded->last ? json(c.embedded->last->convert_to<double>()) : json(nullptr)},
          {"explicit_evaluations", c.embedded->explicit_evaluations},
          {"implicit_solves", c.embedded->implicit_solves},
          {"buffers", steps.buffers()}};
}

std::string embedded_text(const json& e) {
  return fmt::format("order {}, estimate {:.4g} (2-norm of its residuals of order {}), alignment {:.3g}",
                     e["order"].get<int>(), e["estimate"].get<double>(), e["order"].get<int>() + 1,
                     e["alignment"].get<double>());
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

/// null where the method has stages that the analysis does not cover, or the term is infinite.
json regime_json(const certificate& c) {
  if (!c.regime.applies) return nullptr;
  const auto& terms = c.regime;
  const auto number = [](const mp_real& x) {
    return isfinite(x) ? json(x.convert_to<double>()) : json(nullptr);
  };
  return {{"flux", number(terms.flux)},
          {"last", number(terms.last)},
          {"layer", number(terms.layer)},
          {"keeps", c.keeps()},
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

/// The three terms of size ε in parts of the exact ones, so that 1 is right.
std::string regime_text(const certificate& c) {
  if (!c.regime.applies) return "not covered (a stage is neither relaxed nor u^n)";
  return fmt::format(
      "viscosity {:.4g} (N2), deviation from equilibrium {:.4g} (N1), initial layer {:.4g} (N3)",
      c.regime.flux.convert_to<double>(), c.regime.last.convert_to<double>(),
      c.regime.layer.convert_to<double>());
}

/// What these terms mean for the error as dt is refined.
std::string verdict_text(const certificate& c) {
  const std::string parts = "in parts of the exact terms of size epsilon, so 1 is right: ";
  if (!c.keeps_slow_terms) return parts + "the error stalls at a multiple of epsilon";
  return parts + (c.keeps_layer ? "no error of size epsilon is left"
                                : "no error of size epsilon is left if the data start near equilibrium");
}

/// α with two decimals, rounded down: no more than was proved.
std::string angle_text(double angle) {
  return fmt::format("A({:.2f} degrees)", std::floor(angle * 100.0 + 1e-6) / 100.0);
}

/// r/n_F: what a transport evaluation is worth where positivity limits the step; null without such a limit.
json figure_of_merit(const certificate& c) {
  if (!c.bounded || c.explicit_evaluations == 0) return nullptr;
  return c.ssp_coefficient.convert_to<double>() / c.explicit_evaluations;
}

std::string ssp_text(const certificate& c) {
  if (!c.bounded) return "no bound";
  return fmt::format("{:.15g}{}", c.ssp_coefficient.convert_to<double>(),
                     c.unconditional || c.ssp_coefficient == 0 ? "" : " (bounded by Q too)");
}

std::string matrix_text(const std::string& name, const matrix<double>& a) {
  std::string out = name + "\n";
  for (std::size_t i = 0; i < a.rows(); ++i) {
    out += "   ";
    for (std::size_t j = 0; j <= i; ++j)
      out += a(i, j) == 0.0 ? fmt::format(" {:>20}", 0) : fmt::format(" {:>20.15g}", a(i, j));
    out += "\n";
  }
  return out;
}

std::string document_text(const method& m) {
  const auto form = m.coefficients<double>();
  const auto butcher = to_butcher(form);
  std::string out = check_text(m) + "\n";
  out += fmt::format("Shu-Osher form, r = {:.15g}\n", form.r);
  out += matrix_text("P", form.P) + matrix_text("W", form.W) + matrix_text("D", form.D) + "ddot\n   ";
  for (const double x : form.ddot) out += fmt::format(" {:>20.15g}", x);
  out += "\nButcher form\n" + matrix_text("A_hat", butcher.A_hat) + matrix_text("A", butcher.A);
  return out + matrix_text("A_dot", butcher.A_dot);
}

}  // namespace

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
      {"claims_hold", c.claims_hold},
      {"failures", c.failures}};
  if (m.kind == method_kind::imex) out["intermediate_regime"] = regime_json(c);
  if (m.kind != method_kind::explicit_only)
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
  line("error constant", fmt::format("{:.4g} (2-norm of the residuals of order {})",
                                     c.error_constant.convert_to<double>(), c.order + 1));
  line("SSP coefficient", ssp_text(c));
  if (!c.limiting_entry.empty()) line("limited by", c.limiting_entry);
  if (m.kind == method_kind::imex)
    line("explicit part",
         fmt::format("SSP coefficient {:.15g} by itself", c.explicit_radius.convert_to<double>()));
  line("type", fmt::format("{}{}", c.type, c.gsa ? ", globally stiffly accurate" : ""));
  line("asymptotic preserving", c.ap_data.empty() ? "none" : c.ap_data);
  if (m.kind == method_kind::imex) {
    line("where epsilon << dt", regime_text(c));
    if (c.regime.applies) line("", verdict_text(c));
    line("where epsilon ~ dt",
         fmt::format("error of the viscous flux up to {:.2g} dt, largest at epsilon/C = dt/{:.2g}",
                     c.band.error, c.band.at));
  }
  line("cost of a step", fmt::format("{} transport evaluations, {} implicit solves, {} buffers",
                                     c.explicit_evaluations, c.implicit_solves, steps.buffers()));
  if (c.embedded) {
    const json e = embedded_json(m, c);
    line("embedded solution", embedded_text(e));
    line("", embedded_cost_text(e));
    if (!e["last"].is_null()) line("", embedded_term_text(e));
  }
  if (m.kind != method_kind::explicit_only)
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

namespace {

/// "any", "cons.", "any m", … of "any data", "consistent data", "any data (moments only)", …
std::string short_data(const std::string& data) {
  if (data.empty() || data == "none") return "-";
  const std::string first = data.starts_with("any") ? "any" : "cons.";
  return data.ends_with("(moments only)") ? first + " m" : first;
}

/// A number of the table, "-" where there is none.
std::string entry(const json& number, const std::string& none = "-") {
  return number.is_null() ? none : fmt::format("{:.4g}", number.get<double>());
}

}  // namespace

std::string method_table(const json& all) {
  const auto row = [](const auto&... cells) {
    std::string line =
        fmt::format("{:<23}{:>3}{:>4}{:>5}{:>8}{:>10}{:>7}{:>9}{:>8}{:>4}  {:<9}{:<6}{}", cells...);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
  };
  std::string out;
  for (const auto kind : {method_kind::imex, method_kind::implicit_only, method_kind::explicit_only}) {
    out += fmt::format("{}{} methods\n", out.empty() ? "" : "\n", to_string(kind));
    out += row("name", "p", "s", "n_F", "solves", "r", "r/n_F", "error", "buffers", "emb", "AP", "eps",
               "recommended for");
    for (const auto& c : all) {
      if (c["kind"] != to_string(kind)) continue;
      const bool has_terms = c.contains("intermediate_regime") && !c["intermediate_regime"].is_null();
      out += row(c["name"].get<std::string>(), c["order"].get<int>(), c["stages"].get<int>(),
                 c["explicit_evaluations"].get<int>(), c["implicit_solves"].get<int>(),
                 entry(c["ssp_coefficient"], "unbounded"), entry(c["r_per_evaluation"]),
                 entry(c["error_constant"]), c["buffers"].get<int>(),
                 c["embedded"].is_null() ? "-" : std::to_string(c["embedded"]["order"].get<int>()),
                 short_data(c["ap_data"].get<std::string>()),
                 has_terms ? c["intermediate_regime"]["keeps"].get<std::string>() : std::string("-"),
                 c["purpose"].get<std::string>());
    }
  }
  return out + R"(
p order, s stages, n_F transport evaluations, solves of Q, r SSP coefficient, error: 2-norm of the residuals of
order p + 1, buffers of the size of a state, emb: order of the embedded solution, from which the error of a step is
estimated (time.tolerance), AP: the initial data for which the limit epsilon -> 0 is right (cons.:
consistent data only, m: in the moments only), eps: which terms of size epsilon are right for epsilon << dt
(slow: for data near equilibrium).
)";
}

std::string method_document(const method& m, const std::string& format) {
  if (format == "json") return document_json(m).dump(2) + "\n";
  if (format == "latex") return to_latex(m);
  if (format == "toml") return to_toml(m);
  return document_text(m);
}

}  // namespace apsis::app
