#pragma once

#include <array>
#include <functional>

/// Two solvers for the ODE model of the paper that share no code with the library or with each other.
namespace reference {

using pair = std::array<long double, 2>;

/// Radau IIA, order 5, in long double, with step control by comparing one step with two half steps. The local
/// error per step stays below 1e-17; the initial layer is resolved automatically.
pair radau(long double epsilon, long double t_end);

/// Whether CVODE was found; without it its solutions are NaN, and the tests that need them are skipped.
#ifdef APSIS_HAVE_CVODE
inline constexpr bool has_cvode = true;
#else
inline constexpr bool has_cvode = false;
#endif

/// CVODE at its tightest tolerances, in double precision: BDF for ε ≤ 0.1, Adams above.
pair cvode(double epsilon, double t_end);

/// Robertson's problem from (1, 0, 0), by BDF in double precision.
std::array<double, 3> cvode_robertson(double t_end);

/// The solution of the limit ε = 0 from u1(0) = 2: u1' = sin u1 gives tan(u1/2) = tan(1) e^t, u2 = sin u1.
pair limit(long double t_end);

}  // namespace reference
