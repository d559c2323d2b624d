#pragma once

#include <string>

#include <paper/claim.hpp>

namespace apsis::paper {

/// Adds findings, a table and a picture "<id>-convergence": runs with ε = 0 converge to smooth solutions of
/// the limit systems as written in the paper. They do so with the order of the explicit method while the
/// spatial error is smaller.
void add_limit_convergence(const std::string& id, const study_control& control, claim_result& result);

/// Adds findings and a picture "<id>-riemann": the two Riemann problems of the Broadwell model with ε = 0 and
/// the exact solution of the limit.
void add_riemann_problems(const std::string& id, const study_control& control, claim_result& result);

}  // namespace apsis::paper
