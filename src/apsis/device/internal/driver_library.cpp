#include <apsis/device/internal/driver_library.hpp>

#include <dlfcn.h>

namespace apsis {

driver_library::driver_library(std::initializer_list<const char*> names) {
  // The library is never closed, because drivers have threads and handlers of their own.
  for (const char* name : names)
    if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL); library != nullptr) {
      library_ = std::shared_ptr<void>(library, [](void*) {});
      return;
    }
}

void* driver_library::symbol(const char* name) const {
  return library_ == nullptr ? nullptr : dlsym(library_.get(), name);
}

}  // namespace apsis
