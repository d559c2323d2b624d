#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace apsis {

/// One cache line, and the widest vector register; rows of a field start on such a boundary, so that the
/// order of operations in a vectorised loop (and with it every rounding) does not depend on an address.
inline constexpr std::size_t alignment = 64;

template <class T>
struct aligned_allocator {
  using value_type = T;
  aligned_allocator() = default;
  template <class U>
  aligned_allocator(const aligned_allocator<U>&) {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(alignment)));
  }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(alignment)); }
  bool operator==(const aligned_allocator&) const { return true; }
};

/// The same for a vector that does not touch its memory when it is made: elements have no value before one is
/// given.
template <class T>
struct untouched_allocator : aligned_allocator<T> {
  using value_type = T;
  untouched_allocator() = default;
  template <class U>
  untouched_allocator(const untouched_allocator<U>&) {}
  template <class U>
  struct rebind {
    using other = untouched_allocator<U>;
  };
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) > 0) ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
};

template <class T>
using aligned_vector = std::vector<T, aligned_allocator<T>>;

}  // namespace apsis
