#pragma once

#include <apsis/method/method.hpp>

#include <optional>
#include <string>

namespace apsis {

/// The Shu–Osher form of a method given by the exact coefficients of its Butcher form (s rows, the last one
/// is u^{n+1}): the convex form of the paper's class, or of an explicit method the canonical one (P = 0),
/// where there is one; else R = I, that is D = A, W = Â = −P with r = 1, in which u_i is u^n and its
/// increments. If neither exists, because Q̇ of one stage enters another, nothing, and in `reason` the entry
/// that forbids the convex form.
std::optional<shu_osher_form<std::string>> exact_shu_osher(const butcher_form<std::string>& b,
                                                           method_kind kind, std::string& reason);

}  // namespace apsis
