#include <apsis/core/version.hpp>

namespace apsis {

const char* version() {
  return APSIS_VERSION;
}

const char* build_type() {
  return APSIS_BUILD_TYPE;
}

}  // namespace apsis
