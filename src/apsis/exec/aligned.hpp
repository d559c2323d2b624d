#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace apsis {

/// One cache line, and the widest vector register; rows of a field start on such a boundary, so that the
/// order of operations in a vectorised loop (and with it every rounding) does not depend on an address.
inline constexpr std::size_t alignment = 64;

/// Memory that begins at a multiple of `alignment` bytes, as an allocator of the standard library. Throws
/// std::bad_alloc. Any of them frees what another one gave.
template <class T>
struct aligned_allocator {
  /// @cond
  // What the standard asks of an allocator.
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

/// The same for a vector that does not touch its memory when it is made: elements have no value before one is
/// given.
template <class T>
struct untouched_allocator : aligned_allocator<T> {
  /// @cond
  using value_type = T;
  untouched_allocator() = default;
  template <class U>
  untouched_allocator(const untouched_allocator<U>&) {}
  template <class U>
  struct rebind {
    using other = untouched_allocator<U>;
  };
  /// @endcond
  /// An element from its arguments; without arguments nothing is written (a page of memory belongs to
  /// the thread that writes to it first).
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) > 0) ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
};

/// Numbers that begin at a multiple of `alignment` bytes.
template <class T>
using aligned_vector = std::vector<T, aligned_allocator<T>>;

}  // namespace apsis
