#pragma once

#include <string>

#include <paper/claim.hpp>

namespace apsis::paper {

/// Runs with ε = 0 converge to smooth solutions of the limit systems as written in the paper, with the order
/// of the explicit method while the spatial error is smaller: findings, a table and a
/// picture "<id>-convergence".
void add_limit_convergence(const std::string& id, const study_control& control, claim_result& result);

/// The two Riemann problems of the Broadwell model with ε = 0 and the exact solution of the limit: findings,
/// and a picture "<id>-riemann".
void add_riemann_problems(const std::string& id, const study_control& control, claim_result& result);

}  // namespace apsis::paper
