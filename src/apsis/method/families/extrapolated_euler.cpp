// Extrapolation of implicit–explicit Euler steps in the length of the substep. Methods with positivity are
// compared with this family. It is the cheapest choice for small errors where signs do not matter. (Deuflhard
// 1985; for IMEX: Constantinescu & Sandu, SIAM J. Sci. Comput. 31 (2010) 4452.)
#include <apsis/method/family_parts.hpp>
#include <apsis/method/family_registry.hpp>

#include <vector>

namespace apsis {
namespace extrapolated_euler_family {
namespace {

/// Returns Π_{m≠n} n/(n − m), m = 1 … columns: the weight of the result of n substeps, for which the error
/// terms of order 1 … columns − 1 in 1/n cancel.
std::string weight(long n, long columns) {
  long numerator = 1, denominator = 1;
  for (long m = 1; m <= columns; ++m)
    if (m != n) {
      numerator *= n;
      denominator *= n - m;
    }
  return denominator < 0 ? fraction(-numerator, -denominator) : fraction(numerator, denominator);
}

/// Row 1 is u^n. The substeps of n = 1 … S follow in convex form with r = 1: u_k = u_{k−1} + (Δt/n)
/// T(u_{k−1}) + (Δt/n) Q(u_k). The last row is Σ_n weight(n) u_n, where u_n is the last of the n substeps.
method make(std::size_t columns) {
  const auto order = static_cast<long>(columns);
  const std::size_t rows = 2 + columns * (columns + 1) / 2, last = rows - 1;
  method m;
  m.title = "extrapolated implicit-explicit Euler steps, 1 to " + std::to_string(order) + " substeps";
  m.citation =
      "Constantinescu, Sandu: Extrapolated implicit-explicit time stepping, SIAM J. Sci. Comput. 31 (2010) "
      "4452-4477";
  m.origin = "Closed form: the polynomial of degree S - 1 in 1/n through the results of n substeps, at 0.";
  m.purpose = "small errors without positivity";
  m.kind = method_kind::imex;
  m.claims.order = static_cast<int>(order);
  m.claims.ssp_coefficient = "0";
  m.claims.type = "ARS";
  m.exact = empty_form(rows, "1");
  m.embedded = embedded_row{.order = static_cast<int>(order) - 1,
                            .origin = "the same without the last column",
                            .convex = false,
                            .P = std::vector<std::string>(rows, "0"),
                            .W = std::vector<std::string>(rows, "0")};
  std::size_t row = 1;
  for (long n = 1; n <= order; ++n) {
    for (long k = 1; k <= n; ++k, ++row) {
      const std::size_t before = k == 1 ? 0 : row - 1;
      m.exact.W(row, before) = fraction(1, n);
      m.exact.P(row, before) = fraction(n - 1, n);
      m.exact.D(row, row) = fraction(1, n);
    }
    m.exact.P(last, row - 1) = weight(n, order);
    if (n < order) m.embedded->P[row - 1] = weight(n, order - 1);
  }
  return m;
}

}  // namespace
}  // namespace extrapolated_euler_family

extern const family_entry family_extrapolated_euler;
const family_entry family_extrapolated_euler = {
    .pattern = "extrapolated-euler-S",
    .description = "order S from 1 to S substeps, f of any sign (docs/methods.md)",
    .lowest = 2,
    .highest = 8,
    .make = extrapolated_euler_family::make};

}  // namespace apsis
