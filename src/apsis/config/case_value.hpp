#pragma once

#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_text.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns the value in the type of its key, checked against its range and its choices. `so_far`
/// has the keys read before, since choices of initial data depend on the model. Throws input_error
/// at the place of the key.
case_value to_value(const case_key& key, const raw_value& raw, const case_config& so_far);

/// Returns the value of a string option: a predefined name or a formula, which may use `constants`. Throws
/// input_error at the place of the key, or within the formula.
std::string to_text(const model_option& text, const raw_value& raw, const formula_constants& constants);

/// Value of an automatic parameter that leaves the choice to the model.
inline constexpr const char* automatic_word = "auto";

/// Returns the value of a list of texts: names, or formulas in `variables`, which may use `constants`. Throws
/// input_error at the place of the key, or within a formula.
std::vector<std::string> to_list(const model_list& list, const raw_value& raw,
                                 const std::vector<std::string>& variables,
                                 const formula_constants& constants);

/// Returns the suggestion with an example value of a type: "write for example 100".
std::string type_advice(key_type type);

/// Returns a finite number. `needed` describes the expected value ("a number"). Throws input_error.
double finite_number(const raw_value& raw, const std::string& path, const std::string& needed);

/// Returns the formulas of the components of a variable: a number or a text, or a list of them. Throws
/// input_error at the place of the key.
std::vector<std::string> formula_texts(const raw_value& raw, const std::string& path);

/// Returns numbers, or formulas of the constants: one, or a list of them. Throws input_error at the place of
/// the key, or within a formula.
std::vector<double> constant_numbers(const raw_value& raw, const std::string& path,
                                     const formula_constants& constants);

/// Throws input_error at the place of the key: "'path' is `raw.what` (why); advice".
[[noreturn]] void refuse(const raw_value& raw, const std::string& path, const std::string& why,
                         const std::string& advice);

}  // namespace apsis
