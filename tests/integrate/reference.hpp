#pragma once

#include <array>
#include <functional>

/// Two solvers for the ODE model of the paper. They share no code with the library or with each other.
namespace reference {

using pair = std::array<long double, 2>;

/// Integrates with Radau IIA of order 5 in long double. Step control compares one step with two half steps
/// and keeps the local error below 1e-17. The initial layer is thus resolved automatically.
pair radau(long double epsilon, long double t_end);

/// True if CVODE was found. Otherwise its solutions are NaN, and tests that need them are skipped.
#ifdef APSIS_HAVE_CVODE
inline constexpr bool has_cvode = true;
#else
inline constexpr bool has_cvode = false;
#endif

/// Integrates with CVODE at its tightest tolerances in double precision: BDF for ε ≤ 0.1, Adams above.
pair cvode(double epsilon, double t_end);

/// Solves Robertson's problem from (1, 0, 0) by BDF in double precision.
std::array<double, 3> cvode_robertson(double t_end);

/// Returns the solution of the limit ε = 0 from u1(0) = 2: u1' = sin u1 gives tan(u1/2) = tan(1) e^t, and u2
/// = sin u1.
pair limit(long double t_end);

}  // namespace reference
