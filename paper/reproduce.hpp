#pragma once

#include <nlohmann/json_fwd.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {

/// Checks one claim: id, section, statement, how, holds, findings, tables, pictures, remarks, error (""
/// unless the check itself could not be carried out; then the claim does not hold), wall_s. Throws
/// study_interrupted.
nlohmann::ordered_json check_claim(const claim_entry& claim, const study_control& control);

}  // namespace apsis::paper
