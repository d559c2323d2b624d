#pragma once

#include <apsis/core/matrix.hpp>
#include <apsis/method/method.hpp>

#include <cstddef>
#include <optional>
#include <string>

namespace apsis {

/// Converts a Butcher form with exact coefficients to a Shu–Osher form. Its s rows end with u^{n+1}. The
/// result is the first of these forms that exists:
/// - the convex form of the paper's class or, for explicit methods, the canonical form (P = 0);
/// - R = I, in which u_i is u^n plus its increments: D = A, W = Â = −P and r = 1;
/// - R = ḊȦ⁻¹ with Ḋ = diag Ȧ, for methods in which Q̇ of a stage enters later stages. Each such Q̇(u_j) is
///   expressed by u_j, earlier stages and their Q, so that D has entries below the diagonal.
/// None exists if there is no convex form and Q̇ of a stage enters a later one but not the stage itself. The
/// function then returns nothing and sets `reason` to the entry that rules out the convex form.
std::optional<shu_osher_form<std::string>> exact_shu_osher(const butcher_form<std::string>& b,
                                                           method_kind kind, std::string& reason);

/// Returns the s × s matrix of coefficients "0".
matrix<std::string> zero_coefficients(std::size_t s);

}  // namespace apsis
