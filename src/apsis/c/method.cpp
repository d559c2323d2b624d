#include "internal/guarded.hpp"
#include "internal/method_handle.hpp"

#include <apsis/apsis.h>
#include <apsis/core/suggest.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/precision.hpp>
#include <apsis/method/tableau.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::c {
namespace {

const std::vector<std::string>& catalogue() {
  static const std::vector<std::string> names = integrator_names();
  return names;
}

/// Returns the method of a file or family. Throws input_error for a formula.
const method& file_of(const apsis_method& m) {
  if (m.integrator->file() == nullptr)
    throw input_error("'" + m.integrator->name +
                      "' has no coefficients of stages (it is a formula); see apsis_method_certificate()");
  return *m.integrator->file();
}

/// Like file_of(), but throws input_error for a method of several steps, which has no `what`.
const method& one_step_of(const apsis_method& m, const char* what) {
  const method& file = file_of(m);
  if (file.steps > 1)
    throw input_error(fmt::format("'{}' has no {} (it takes {} steps); choose the Shu-Osher form", file.name,
                                  what, file.steps));
  return file;
}

void write(const matrix<double>& m, double* values) {
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.rows(); ++j) *values++ = j <= i ? m(i, j) : 0.0;
}

void write(const matrix<mp_real>& m, double* values) {
  for (std::size_t i = 0; i < m.rows(); ++i)
    for (std::size_t j = 0; j < m.rows(); ++j) *values++ = j <= i ? m(i, j).convert_to<double>() : 0.0;
}

int write_coefficients(const apsis_method& m, int which, double* values) {
  if (which >= APSIS_BUTCHER_A_HAT && which <= APSIS_BUTCHER_A_DOT) {
    const auto form = to_butcher(one_step_of(m, "Butcher form").coefficients<mp_real>());
    write(which == APSIS_BUTCHER_A_HAT ? form.A_hat : which == APSIS_BUTCHER_A ? form.A : form.A_dot, values);
    return APSIS_OK;
  }
  const auto form = file_of(m).coefficients<double>();
  switch (which) {
    case APSIS_SHU_OSHER_P:
      write(form.P, values);
      return APSIS_OK;
    case APSIS_SHU_OSHER_W:
      write(form.W, values);
      return APSIS_OK;
    case APSIS_SHU_OSHER_D:
      write(form.D, values);
      return APSIS_OK;
    case APSIS_SHU_OSHER_DDOT:
      std::copy(form.ddot.begin(), form.ddot.end(), values);
      return APSIS_OK;
    case APSIS_SHU_OSHER_R:
      *values = form.r;
      return APSIS_OK;
    default:
      throw input_error(
          fmt::format("unknown coefficients {} (apsis_coefficients has no such number); valid: {} to {}",
                      which, static_cast<int>(APSIS_SHU_OSHER_P), static_cast<int>(APSIS_BUTCHER_A_DOT)));
  }
}

double fact_of(const apsis_method& m, const std::string& key) {
  std::vector<std::string> keys;
  for (const auto& one : m.facts()) {
    keys.push_back(one.key);
    if (one.key != key) continue;
    if (const bool* flag = std::get_if<bool>(&one.is)) return *flag ? 1.0 : 0.0;
    if (const int* number = std::get_if<int>(&one.is)) return *number;
    if (const double* number = std::get_if<double>(&one.is)) return *number;
    throw input_error("the certificate has no number '" + key +
                      "' (its value is a text); see apsis_method_certificate()");
  }
  throw input_error("the certificate of '" + m.integrator->name + "' has no key '" + key.substr(0, 60) +
                    "' (it is not computed for this method); " + suggest(key, keys));
}

}  // namespace
}  // namespace apsis::c

using namespace apsis::c;

size_t apsis_catalogue_size(void) {
  size_t size = 0;
  guarded([&size] {
    size = catalogue().size();
    return APSIS_OK;
  });
  return size;
}

const char* apsis_catalogue_name(size_t index) {
  const char* name = nullptr;
  guarded([&name, index] {
    if (index < catalogue().size()) name = catalogue()[index].c_str();
    return APSIS_OK;
  });
  return name;
}

int apsis_find_method(const char* name, apsis_method** method) {
  return guarded([=] {
    require(method, "the place of the method") = nullptr;
    const std::string text = &require(name, "the name of the method");
    *method = new apsis_method{.integrator = &apsis::find_integrator(text), .requested = text};
    return APSIS_OK;
  });
}

void apsis_free_method(apsis_method* method) {
  delete method;
}

const char* apsis_method_name(const apsis_method* method) {
  return method == nullptr ? "" : method->integrator->name.c_str();
}

const char* apsis_method_title(const apsis_method* method) {
  return method == nullptr ? "" : method->integrator->title.c_str();
}

const char* apsis_method_kind(const apsis_method* method) {
  return method == nullptr ? "" : method->integrator->kind.c_str();
}

int apsis_method_order(const apsis_method* method) {
  return method == nullptr ? 0 : method->integrator->order;
}

int apsis_method_steps(const apsis_method* method) {
  return method == nullptr ? 0 : method->integrator->steps;
}

size_t apsis_method_stages(const apsis_method* method) {
  return method == nullptr ? 0 : method->integrator->stages;
}

double apsis_method_ssp_coefficient(const apsis_method* method) {
  return method == nullptr ? 0.0 : method->integrator->ssp_coefficient;
}

int apsis_method_needs(const apsis_method* method) {
  if (method == nullptr) return 0;
  const auto& needs = method->integrator->needs;
  return (needs.explicit_collision ? APSIS_NEEDS_RATE : 0) | (needs.exact_collision ? APSIS_NEEDS_FLOW : 0) |
         (needs.equal_steps ? APSIS_NEEDS_EQUAL_STEPS : 0);
}

int apsis_method_coefficients(const apsis_method* method, int which, double* values) {
  return guarded([=] {
    return write_coefficients(require(method, "the method"), which,
                              &require(values, "the place of coefficients"));
  });
}

int apsis_method_file(const apsis_method* method, const char** text) {
  return guarded([=] {
    const auto& m = require(method, "the method");
    require(text, "the place of the text") = m.file_text(one_step_of(m, "file to be written")).c_str();
    return APSIS_OK;
  });
}

int apsis_method_certificate(const apsis_method* method, const char** text) {
  return guarded([=] {
    require(text, "the place of the text") = require(method, "the method").certificate_text().c_str();
    return APSIS_OK;
  });
}

int apsis_method_fact(const apsis_method* method, const char* key, double* value) {
  return guarded([=] {
    require(value, "the place of the value") =
        fact_of(require(method, "the method"), &require(key, "the key of the certificate"));
    return APSIS_OK;
  });
}
