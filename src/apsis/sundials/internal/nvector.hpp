#pragma once

#include "equal_sums.hpp"

#include <new>
#include <utility>

#include <sundials/sundials_nvector.h>

namespace apsis::sundials {

/// Throws input_error unless the operation `name` of the vectors is `there`. `use` states who calls it.
void require_operation(const char* name, bool there, const char* use);

/// A state: an N_Vector of any kind, copied by its operations. Its sums do not depend on its division among
/// threads or processes. Throws std::bad_alloc if a vector cannot be cloned.
class nvector {
 public:
  nvector() = default;  ///< no vector
  /// Copies a vector.
  explicit nvector(N_Vector from) { copy(from); }
  nvector(const nvector& other) { copy(other.v_); }
  nvector(nvector&& other) noexcept : v_(std::exchange(other.v_, nullptr)) {}
  nvector& operator=(const nvector& other) {
    if (this == &other) return *this;
    if (v_ != nullptr && other.v_ != nullptr)
      N_VScale(1.0, other.v_, v_);
    else
      nvector(other).swap(*this);
    return *this;
  }
  nvector& operator=(nvector&& other) noexcept {
    swap(other);
    return *this;
  }
  ~nvector() {
    if (v_ != nullptr) N_VDestroy(v_);
  }

  /// Returns a vector of the same kind with undefined contents.
  nvector another() const {
    nvector made;
    made.clone(v_);
    return made;
  }

  void swap(nvector& other) noexcept { std::swap(v_, other.v_); }
  friend void swap(nvector& a, nvector& b) noexcept { a.swap(b); }

  N_Vector get() const { return v_; }  ///< NULL without a vector
  explicit operator bool() const { return v_ != nullptr; }

 private:
  void clone(N_Vector like) {
    v_ = N_VClone(like);
    if (v_ == nullptr) throw std::bad_alloc();
    use_equal_sums(v_);
  }
  void copy(N_Vector from) {
    if (from == nullptr) return;
    clone(from);
    N_VScale(1.0, from, v_);
  }

  N_Vector v_ = nullptr;
};

}  // namespace apsis::sundials
