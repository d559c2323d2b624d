#pragma once

/// Stiff relaxation and kinetic equations u_t = T(u) + Q(u)/ε by SSP multi-derivative IMEX Runge–Kutta
/// methods.
namespace apsis {

/// Version of the library and the program, "1.2.3".
const char* version();

/// The commit that it was built from: 40 hexadecimal digits, with "-dirty" where files under version control
/// had changed; "unknown" where the sources came without a repository.
const char* commit();

/// How it was built: "Release", "Debug", … or "none".
const char* build_type();

}  // namespace apsis
