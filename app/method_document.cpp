#include "method_document.hpp"
#include "method_report.hpp"

#include <apsis/method/export.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

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
  if (!solves_exactly(m.kind)) {
    out["A"] = rows(butcher.A);
    out["A_dot"] = rows(butcher.A_dot);
  }
  out["exact"] = exact;
  out["claims"] = {{"order", m.claims.order}};
  if (m.claims.ssp_coefficient) out["claims"]["ssp_coefficient"] = *m.claims.ssp_coefficient;
  if (m.claims.type) out["claims"]["type"] = *m.claims.type;
  if (m.claims.explicit_radius) out["claims"]["explicit_radius"] = *m.claims.explicit_radius;
  if (m.claims.l_stable) out["claims"]["l_stable"] = *m.claims.l_stable;
  if (m.claims.intermediate) out["claims"]["intermediate"] = *m.claims.intermediate;
  if (m.embedded)
    out["embedded"] = {{"order", m.embedded->order},   {"convex", m.embedded->convex},
                       {"origin", m.embedded->origin}, {"P", m.embedded->P},
                       {"W", m.embedded->W},           {"d", m.embedded->d},
                       {"ddot", m.embedded->ddot}};
  return out;
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
  if (solves_exactly(m.kind)) return out + "\nButcher form of T\n" + matrix_text("A_hat", butcher.A_hat);
  out += "\nButcher form\n" + matrix_text("A_hat", butcher.A_hat) + matrix_text("A", butcher.A);
  return out + matrix_text("A_dot", butcher.A_dot);
}

}  // namespace

std::string method_document(const method& m, const std::string& format) {
  if (format == "json") return document_json(m).dump(2) + "\n";
  if (format == "latex") return to_latex(m);
  if (format == "toml") return to_toml(m);
  return document_text(m);
}

}  // namespace apsis::app
