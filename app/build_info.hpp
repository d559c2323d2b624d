#pragma once

#include <nlohmann/json.hpp>

namespace apsis::app {

/// Version of the program.
const char* version();

/// Compiler, build type, instruction set and libraries.
nlohmann::ordered_json build_info();

/// Processor, cores and threads in use.
nlohmann::ordered_json machine_info();

}  // namespace apsis::app
