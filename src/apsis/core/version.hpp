#pragma once

namespace apsis {

/// Version of the library and the program, "1.2.3".
const char* version();

/// How it was built: "Release", "Debug", … or "none".
const char* build_type();

}  // namespace apsis
