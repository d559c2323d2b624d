#pragma once

#include <cstddef>

namespace apsis {

/// A number that counts operations. Kernels for packs (exec/simd-inl.hpp) are instantiated with it to
/// obtain their operation count. An addition, multiplication, multiply–add, division, comparison, minimum,
/// maximum or absolute value counts as one operation, because it is one instruction on a pack. Negations,
/// selections and moves do not count. The count assumes that no branch on data is taken: no number is
/// limited or exceptional.
class counted {
 public:
  /// Result of a comparison, without content.
  struct mask {};

  counted(double) {}                                  ///< constants cost nothing; their values are ignored
  static counted load(const double*) { return 0.0; }  ///< reads nothing
  void store(double*) const {}                        ///< writes nothing
  static bool any(mask) { return false; }             ///< no exceptional numbers in a pack …
  static bool all(mask) { return true; }              ///< … and every number is regular

  /// Returns the number of operations of body().
  template <class Body>
  static double operations_of(const Body& body) {
    const double before = operations_;
    body();
    return operations_ - before;
  }

  /// @cond
  // Interface of a pack.
  friend counted operator+(counted, counted) { return one(); }
  friend counted operator-(counted, counted) { return one(); }
  friend counted operator*(counted, counted) { return one(); }
  friend counted operator/(counted, counted) { return one(); }
  friend counted operator-(counted) { return 0.0; }
  friend mask operator<(counted, counted) { return one(), mask(); }
  friend mask operator>(counted, counted) { return one(), mask(); }
  friend counted fma(counted, counted, counted) { return one(); }
  friend counted negative_fma(counted, counted, counted) { return one(); }
  friend counted select(mask, counted, counted) { return 0.0; }
  friend counted smaller(counted, counted) { return one(); }
  friend counted larger(counted, counted) { return one(); }
  friend counted minimum(counted, counted) { return one(); }
  friend counted maximum(counted, counted) { return one(); }
  friend counted absolute(counted) { return one(); }
  friend counted inverse_power_of_two(counted) { return 0.0; }
  /// @endcond

 private:
  static counted one() {
    ++operations_;
    return 0.0;
  }
  inline static thread_local double operations_ = 0.0;
};

/// A walk along a pencil (scheme/walk-inl.hpp) of counted numbers, which reads and writes nothing.
struct counting_walk {
  using number = counted;  ///< type of loaded and stored numbers
  /// Returns an arbitrary number at no cost.
  template <class... Where>
  counted load(const Where&...) const {
    return 0.0;
  }
  /// Returns an arbitrary number, in place of that of the downstream row, at no cost.
  template <class... Where>
  counted load_downstream(const Where&...) const {
    return 0.0;
  }
  /// Prefetches nothing, at no cost.
  template <class... Where>
  void prefetch(const Where&...) const {}
  /// Writes nothing, at no cost.
  template <class... Where>
  void store(const Where&...) const {}
};

}  // namespace apsis
