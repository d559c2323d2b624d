#pragma once

#include <cstddef>
#include <new>
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

template <class T>
using aligned_vector = std::vector<T, aligned_allocator<T>>;

}  // namespace apsis
