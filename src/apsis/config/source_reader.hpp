#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/source_rate.hpp>

#include <optional>

namespace apsis {

/// Reads the keys "source.…" of a case, formulas of the variables of the model's preferred form of data. A
/// gas may instead have f, or g and h, as functions of the velocity. Formulas of a law may contain its
/// variables. Throws input_error at the place of a key that is unknown or whose value is no formula.
void read_source_values(const case_text& text, const model& equation, case_config& config);

/// Returns the source of the table [source]; nothing without one. For a Maxwellian it is `rho` times the
/// Maxwellian of density 1, so that the rate may vanish. A law has a source for each of its variables, 0 for
/// those without a formula. `equation` must outlive the source of a law. Throws input_error at the place of a
/// formula with an error, or if variables are missing that the model needs.
std::optional<source_rate> make_source(const case_config& config, const model& equation);

}  // namespace apsis
