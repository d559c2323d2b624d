#pragma once

#include <string>
#include <vector>

#include <paper/claim.hpp>

namespace apsis::paper {

/// Returns every claim, sorted by file name (generated).
std::vector<const claim_entry*> claim_entries();

/// Returns the claims with these ids, in the order of the registry; all claims for an empty list. Upper and
/// lower case are equivalent. Throws input_error with the nearest id.
std::vector<const claim_entry*> find_claims(const std::vector<std::string>& ids);

}  // namespace apsis::paper
