#pragma once

#include <apsis/apsis.h>
#include <apsis/integrate/evolution.hpp>

namespace apsis::c {

/// Returns the apsis_status of an integration that ended without an error.
inline int status_of(evolution_end end) {
  switch (end) {
    case evolution_end::stopped:
      return APSIS_STOPPED;
    case evolution_end::event:
      return APSIS_EVENT;
    case evolution_end::reached:
      break;
  }
  return APSIS_OK;
}

}  // namespace apsis::c
