#pragma once

#include "calls.hpp"

#include <utility>

#include <petscvec.h>

namespace apsis::petsc {

/// A state: a Vec with the semantics of a value.
class vector {
 public:
  vector() = default;
  /// Copies a Vec.
  explicit vector(Vec other) {
    check(VecDuplicate(other, &v_));
    check(VecCopy(other, v_));
  }
  vector(const vector& other) {
    if (other.v_ == nullptr) return;
    check(VecDuplicate(other.v_, &v_));
    check(VecCopy(other.v_, v_));
  }
  vector(vector&& other) noexcept : v_(std::exchange(other.v_, nullptr)) {}
  vector& operator=(const vector& other) {
    if (this == &other) return *this;
    if (v_ != nullptr && other.v_ != nullptr)
      check(VecCopy(other.v_, v_));
    else
      *this = vector(other);
    return *this;
  }
  vector& operator=(vector&& other) noexcept {
    std::swap(v_, other.v_);
    return *this;
  }
  ~vector() { static_cast<void>(VecDestroy(&v_)); }

  /// Copies the values of a Vec. The first call allocates.
  void assign(Vec other) {
    if (v_ == nullptr)
      *this = vector(other);
    else
      check(VecCopy(other, v_));
  }
  /// Returns the Vec. The first call allocates it like `other`, with undefined values.
  Vec like(Vec other) {
    if (v_ == nullptr) check(VecDuplicate(other, &v_));
    return v_;
  }
  void reset() { static_cast<void>(VecDestroy(&v_)); }
  Vec get() const { return v_; }
  explicit operator bool() const { return v_ != nullptr; }

 private:
  Vec v_ = nullptr;
};

}  // namespace apsis::petsc
