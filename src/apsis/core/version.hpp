#pragma once

/// Stiff relaxation and kinetic equations u_t = T(u) + Q(u)/ε by SSP multi-derivative IMEX Runge–Kutta
/// methods.
namespace apsis {

/// Version of the library and the program, "1.2.3".
const char* version();

/// How it was built: "Release", "Debug", … or "none".
const char* build_type();

}  // namespace apsis
