#pragma once

/// Library for stiff relaxation and kinetic equations u_t = T(u) + Q(u)/ε, solved by SSP multi-derivative
/// IMEX Runge–Kutta methods.
namespace apsis {

/// Returns the version of the library and the program, such as "1.2.3".
const char* version();

/// Returns the commit of the sources: 40 hexadecimal digits, followed by "-dirty" if version-controlled files
/// had been modified; "unknown" if the sources came without a repository.
const char* commit();

/// Returns the CMake build type: "Release", "Debug", … or "none".
const char* build_type();

}  // namespace apsis
