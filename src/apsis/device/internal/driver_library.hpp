#pragma once

#include <initializer_list>
#include <memory>
#include <string>

namespace apsis {

/// The shared library of a driver, opened at run time.
class driver_library {
 public:
  /// Opens the first of these libraries that the system finds.
  explicit driver_library(std::initializer_list<const char*> names);

  /// Whether a library was found.
  bool found() const { return library_ != nullptr; }
  /// Sets a pointer to a function of the library; returns whether the library has a function of this name.
  template <class Function>
  bool find(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(symbol(name));
    return function != nullptr;
  }

 private:
  void* symbol(const char* name) const;

  std::shared_ptr<void> library_;
};

}  // namespace apsis
