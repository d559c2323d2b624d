#pragma once

#include <apsis/method/certificate.hpp>

#include <string>
#include <vector>

#include <paper/claim.hpp>

namespace apsis::paper {

/// Returns the findings for every method of the paper: its order from the generated conditions, with
/// small residuals.
std::vector<finding> certificate_findings(const std::string& method, int order);

/// Returns certificate_findings(), and the sign conditions that make an implicit method SSP for every step.
std::vector<finding> unconditional_findings(const std::string& method, int order);

/// Returns certificate_findings() of an IMEX method that is SSP for steps up to r Δt_FE. In addition r,
/// derived from the Butcher form alone, is within `tolerance` of the value in the paper.
std::vector<finding> coefficient_findings(const std::string& method, int order, double r, double tolerance);

/// Returns the agreement with the Butcher form that the paper prints, for the methods
/// of printed_butcher_form.
finding agrees_with_print(const std::string& method);

}  // namespace apsis::paper
