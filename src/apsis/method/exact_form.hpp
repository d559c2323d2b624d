#pragma once

#include <apsis/method/method.hpp>

#include <optional>
#include <string>

namespace apsis {

/// Converts a Butcher form with exact coefficients (s rows, the last one u^{n+1}) to a Shu–Osher form: the
/// convex form of the paper's class or, for explicit methods, the canonical form (P = 0), where one exists;
/// otherwise R = I, that is D = A, W = Â = −P with r = 1, in which u_i is u^n plus its increments. If neither
/// exists, because Q̇ of one stage enters another, returns nothing and sets `reason` to the entry that rules
/// out the convex form.
std::optional<shu_osher_form<std::string>> exact_shu_osher(const butcher_form<std::string>& b,
                                                           method_kind kind, std::string& reason);

}  // namespace apsis
