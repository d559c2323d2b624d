#pragma once

#include <cstddef>

namespace apsis {

/// A number that counts what is done with it: formulas that are written for packs of numbers
/// (exec/simd-inl.hpp) tell by it how many operations they are. An addition, multiplication, multiply–add,
/// division, comparison, minimum, maximum and absolute value is one operation each: one instruction on a
/// pack. Choosing between two numbers and moving them is none. Nothing is limited and nothing exceptional:
/// branches that need a reason are not taken.
class counted {
 public:
  /// What a comparison gives; it carries nothing.
  struct mask {};

  counted(double) {}                                  ///< constants cost nothing, and have no value here
  static counted load(const double*) { return 0.0; }  ///< reads nothing
  void store(double*) const {}                        ///< writes nothing
  static bool any(mask) { return false; }             ///< no pack is exceptional …
  static bool all(mask) { return true; }              ///< … and every number is as usual

  /// Operations of body().
  template <class Body>
  static double operations_of(const Body& body) {
    const double before = operations_;
    body();
    return operations_ - before;
  }

  /// @cond
  // The operations of a pack.
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

/// Walks along a pencil of counted numbers (scheme/walk-inl.hpp): nothing is read or written, wherever it is.
struct counting_walk {
  using number = counted;  ///< type of what is loaded and stored
  /// Some number, at no cost.
  template <class... Where>
  counted load(const Where&...) const {
    return 0.0;
  }
  /// The same of the downstream one of two rows.
  template <class... Where>
  counted load_downstream(const Where&...) const {
    return 0.0;
  }
  /// Nothing, at no cost.
  template <class... Where>
  void store(const Where&...) const {}
};

}  // namespace apsis
