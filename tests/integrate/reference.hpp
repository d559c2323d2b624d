#pragma once

#include <array>
#include <functional>

/// Two solvers for the ODE model of the paper that share no code with the library and none with each other.
namespace reference {

using pair = std::array<long double, 2>;

/// Radau IIA, order 5, in long double, with the step chosen by comparing one step with two halves. The local
/// error per step stays below 1e-17; the steps of the initial layer follow its width by themselves.
pair radau(long double epsilon, long double t_end);

/// CVODE at its tightest tolerances, double precision. The stiff method (BDF) for ε ≤ 0.1, Adams above.
pair cvode(double epsilon, double t_end);

/// The solution of the limit ε = 0 from u1(0) = 2: u1' = sin u1 gives tan(u1/2) = tan(1) e^t, u2 = sin u1.
pair limit(long double t_end);

}  // namespace reference
