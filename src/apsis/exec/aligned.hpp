#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace apsis {

/// Alignment in bytes: a cache line, and the widest vector register. Rows of a field start on such a
/// boundary. The order of operations in a vectorized loop, and every rounding error, is then independent
/// of addresses.
inline constexpr std::size_t alignment = 64;

/// Standard allocator of memory aligned to `alignment` bytes. Throws std::bad_alloc. All
/// instances are interchangeable.
template <class T>
struct aligned_allocator {
  /// @cond
  // Requirements of the standard on allocators.
  using value_type = T;
  aligned_allocator() = default;
  template <class U>
  aligned_allocator(const aligned_allocator<U>&) {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(alignment)));
  }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(alignment)); }
  bool operator==(const aligned_allocator&) const { return true; }
  /// @endcond
};

/// Vector whose data are aligned to `alignment` bytes.
template <class T>
using aligned_vector = std::vector<T, aligned_allocator<T>>;

}  // namespace apsis
