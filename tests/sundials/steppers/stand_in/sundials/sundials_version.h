// The version of the installed SUNDIALS, replaced by the first with the steppers that Apsis uses.
#pragma once

#include_next <sundials/sundials_version.h>

#undef SUNDIALS_VERSION_MAJOR
#undef SUNDIALS_VERSION_MINOR
#define SUNDIALS_VERSION_MAJOR 7
#define SUNDIALS_VERSION_MINOR 5
