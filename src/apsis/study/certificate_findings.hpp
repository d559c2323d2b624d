#pragma once

#include <apsis/method/certificate.hpp>
#include <apsis/study/claim.hpp>

#include <string>
#include <vector>

namespace apsis {

/// What every method of the paper must show: its order from the generated conditions, with small residuals.
std::vector<finding> certificate_findings(const std::string& method, int order);

}  // namespace apsis
