#include "arrays.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/step_estimate.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/family_registry.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/run/cfl_limit.hpp>

#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <pybind11/stl.h>

namespace apsis::python {
namespace {

using texts = std::vector<std::vector<std::string>>;

texts rows_of(const matrix<std::string>& m) {
  texts rows(m.rows());
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.cols(); ++j) rows[i].push_back(m(i, j));
  return rows;
}

py::dict exact_of(const method& m) {
  py::dict all;
  all["P"] = rows_of(m.exact.P);
  all["W"] = rows_of(m.exact.W);
  all["D"] = rows_of(m.exact.D);
  all["ddot"] = m.exact.ddot;
  all["r"] = m.exact.r;
  return all;
}

matrix<mp_real> read_matrix(const texts& rows, const char* name, std::size_t stages) {
  if (rows.size() != stages)
    throw input_error(std::string(name) + " has another number of rows than A; give s × s");
  matrix<mp_real> m(stages, stages);
  for (std::size_t i = 0; i < stages; ++i) {
    if (rows[i].size() != stages)
      throw input_error(std::string(name) + " is not square; give s × s coefficients");
    for (std::size_t j = 0; j < stages; ++j) {
      if (!is_coefficient(rows[i][j]))
        throw input_error(
            "'" + rows[i][j] + "' in " + name +
            " is not a coefficient (it is not a number); give numbers, fractions, or text such as \"1/3\"");
      m(i, j) = coefficient_value(rows[i][j]);
    }
  }
  return m;
}

/// A condition for each tree: name, order, left-hand side, 1/γ.
std::vector<std::tuple<std::string, int, double, double>> conditions(const texts& A_hat, const texts& A,
                                                                     const texts& A_dot, int order) {
  constexpr int most = 8;
  if (order < 1 || order > most) throw input_error("order must lie from 1 to 8; trees grow fivefold with it");
  if (A.empty()) throw input_error("A has no stages; give s × s coefficients");
  const std::size_t s = A.size();
  butcher_form<mp_real> form;
  form.A = read_matrix(A, "A", s);
  form.A_hat = A_hat.empty() ? matrix<mp_real>(s, s) : read_matrix(A_hat, "A_hat", s);
  form.A_dot = A_dot.empty() ? matrix<mp_real>(s, s) : read_matrix(A_dot, "A_dot", s);
  const auto trees = rooted_trees(order, A_hat.empty() ? tree_colours::G_only : tree_colours::both);
  const auto weights = elementary_weights(form, trees);
  std::vector<std::tuple<std::string, int, double, double>> all;
  for (std::size_t k = 0; k < trees.size(); ++k) {
    // The difference in all digits, so that a residual of 1e-40 is seen.
    const mp_real wanted = mp_real(1) / mp_real(trees[k].density);
    all.emplace_back(trees[k].name, trees[k].order, static_cast<double>(weights[k]),
                     static_cast<double>(mp_real(weights[k] - wanted)));
  }
  return all;
}

double number(const mp_real& x) {
  return static_cast<double>(x);
}

/// The fields of apsis.Certificate.
py::dict certificate_of(const method& m) {
  const certificate c = certify(m);
  py::dict all;
  all["name"] = c.name;
  all["kind"] = to_string(c.kind);
  all["order"] = c.order;
  all["conditions"] = c.conditions;
  all["order_residual"] = number(c.order_residual);
  all["error_constant"] = number(c.error_constant);
  all["unconditional"] = c.unconditional;
  all["ssp_coefficient"] = c.bounded ? std::optional(number(c.ssp_coefficient)) : std::nullopt;
  all["explicit_radius"] = number(c.explicit_radius);
  std::map<std::string, std::optional<double>> limits;
  if (m.kind != method_kind::implicit_only)
    for (const auto& [scheme, limit] : cfl_limits(amplification(m)))
      limits[scheme] = std::isfinite(limit) ? std::optional(limit) : std::nullopt;
  all["cfl_limits"] = limits;
  all["limiting_entry"] = c.limiting_entry;
  all["type"] = c.type;
  all["gsa"] = c.gsa;
  all["ap"] = c.ap;
  all["ap_data"] = c.ap_data;
  all["explicit_evaluations"] = c.explicit_evaluations;
  all["implicit_solves"] = c.implicit_solves;
  all["angle"] = c.stability.angle;
  all["l_stable"] = c.stability.l_stable;
  all["keeps"] = c.remaining_terms();
  const step_estimate how = estimate_of(m);
  all["estimate"] = how.doubles ? "step doubling" : "embedded solution of order " + std::to_string(how.order);
  all["claims_hold"] = c.claims_hold;
  all["failures"] = c.failures;
  return all;
}

}  // namespace

void bind_methods(py::module_& m) {
  m.def("choose_method", [](bool space, bool general, bool signs, bool graded,
                            std::optional<double> tolerance, std::optional<double> ratio) {
    const method_choice chosen = choose_method({.space = space,
                                                .general = general,
                                                .signs = signs,
                                                .graded_start = graded,
                                                .tolerance = tolerance,
                                                .lowest_ratio = ratio,
                                                .highest_ratio = ratio});
    return py::make_tuple(chosen.method, chosen.reason);
  });
  py::class_<method>(m, "Method")
      .def_readonly("name", &method::name)
      .def_readonly("title", &method::title)
      .def_readonly("citation", &method::citation)
      .def_readonly("origin", &method::origin)
      .def_readonly("purpose", &method::purpose)
      .def_property_readonly("kind", [](const method& self) { return to_string(self.kind); })
      .def_property_readonly("stages", &method::stages)
      .def_property_readonly("P", [](const method& self) { return to_array(self.coefficients<double>().P); })
      .def_property_readonly("W", [](const method& self) { return to_array(self.coefficients<double>().W); })
      .def_property_readonly("D", [](const method& self) { return to_array(self.coefficients<double>().D); })
      .def_property_readonly("ddot",
                             [](const method& self) { return to_array(self.coefficients<double>().ddot); })
      .def_property_readonly("r", [](const method& self) { return self.coefficients<double>().r; })
      .def_property_readonly(
          "A_hat", [](const method& self) { return to_array(to_butcher(self.coefficients<double>()).A_hat); })
      .def_property_readonly(
          "A", [](const method& self) { return to_array(to_butcher(self.coefficients<double>()).A); })
      .def_property_readonly(
          "A_dot", [](const method& self) { return to_array(to_butcher(self.coefficients<double>()).A_dot); })
      .def_property_readonly("_exact", exact_of)
      .def_property_readonly("_toml", [](const method& self) { return to_toml(self); })
      .def("_certify", certificate_of);
  m.def("find_method", [](const std::string& name) { return find_method(name); });
  m.def("parse_method",
        [](const std::string& text, const std::string& file) { return parse_method(text, file); });
  m.def("method_names", &method_names);
  m.def("conditions", &conditions);
}

}  // namespace apsis::python
