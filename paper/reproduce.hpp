#pragma once

#include <nlohmann/json_fwd.hpp>
#include <paper/claim.hpp>

namespace apsis::paper {

/// Checks one claim. Returns id, section, statement, how, holds, error, findings, tables, pictures, remarks
/// and wall_s. If the check itself fails, `error` has its message, and the claim does not hold; otherwise
/// `error` is "". Throws study_interrupted.
nlohmann::ordered_json check_claim(const claim_entry& claim, const study_control& control);

}  // namespace apsis::paper
