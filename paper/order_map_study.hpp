#pragma once

#include <string>

#include <paper/claim.hpp>

namespace apsis::paper {

/// Adds the maps of the observed order of all relaxation models: one picture each, and findings about the
/// paper's methods.
void add_order_maps(const std::string& id, const study_control& control, claim_result& result);

}  // namespace apsis::paper
