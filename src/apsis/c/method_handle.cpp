#include "internal/method_handle.hpp"

#include <apsis/integrate/step_estimate.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/method_file.hpp>

#include <type_traits>
#include <variant>

#include <fmt/format.h>

namespace apsis::c {
namespace {

using fact = integrator_certificate::fact;

/// Returns the certificate of a method of one step, with the keys of `apsis check --json`.
std::vector<fact> facts_of(const method& m, const certificate& c) {
  const auto number = [](const mp_real& x) { return x.convert_to<double>(); };
  std::vector<fact> out = {{"kind", to_string(m.kind)},
                           {"order", c.order},
                           {"order_residual", number(c.order_residual)},
                           {"error_constant", number(c.error_constant)},
                           {"unconditional", c.unconditional},
                           {"limiting_entry", c.limiting_entry},
                           {"type", c.type},
                           {"gsa", c.gsa},
                           {"ap", c.ap},
                           {"ap_data", c.ap_data},
                           {"explicit_evaluations", c.explicit_evaluations},
                           {"implicit_solves", c.implicit_solves},
                           {"claims_hold", c.claims_hold},
                           {"estimate.order", estimate_of(m).order},
                           {"estimate.weight", estimate_of(m).weight}};
  if (c.bounded) out.push_back({"ssp_coefficient", number(c.ssp_coefficient)});
  if (m.kind != method_kind::implicit_only) out.push_back({"explicit_radius", number(c.explicit_radius)});
  if (has_derivatives(m.kind)) {
    out.push_back({"stability.l_stable", c.stability.l_stable});
    out.push_back({"stability.angle_degrees", c.stability.angle});
    out.push_back({"stability.at_infinity", c.stability.at_infinity});
  }
  if (m.kind == method_kind::imex) out.push_back({"remaining_terms", c.remaining_terms()});
  return out;
}

std::string text_of(const integrator_certificate::value& is) {
  return std::visit(
      [](const auto& one) -> std::string {
        using type = std::remove_cvref_t<decltype(one)>;
        if constexpr (std::is_same_v<type, std::monostate>)
          return "";
        else
          return fmt::format("{}", one);
      },
      is);
}

}  // namespace
}  // namespace apsis::c

const std::vector<apsis_method::fact>& apsis_method::facts() const {
  std::call_once(facts_made, [this] {
    const auto* one = integrator->one_step();
    // A file may have changed since it was read.
    known_facts = one == nullptr ? integrator->certify().facts
                  : apsis::is_method_file(requested)
                      ? apsis::c::facts_of(*one, apsis::certify(*one))
                      : apsis::c::facts_of(*one, apsis::find_certificate(requested));
    std::erase_if(known_facts, [](const fact& f) { return std::holds_alternative<std::monostate>(f.is); });
  });
  return known_facts;
}

const std::string& apsis_method::certificate_text() const {
  std::call_once(certificate_made, [this] {
    std::string text;
    for (const fact& one : facts()) text += fmt::format("{} = {}\n", one.key, apsis::c::text_of(one.is));
    known_certificate = text;
  });
  return known_certificate;
}

const std::string& apsis_method::file_text(const apsis::method& file) const {
  std::call_once(file_made, [this, &file] { known_file = apsis::to_toml(file); });
  return known_file;
}
