#pragma once

#include "guarded.hpp"
#include "integrator_handle.hpp"

#include <apsis/apsis.h>

namespace apsis::c {

inline constexpr const char* handle = "the integrator";

/// Throws input_error unless `free`.
void require_free(bool free);

/// Returns an integrator that no callback and no other thread uses. Throws input_error if one does.
apsis_integrator& idle(apsis_integrator* integrator);

}  // namespace apsis::c
