#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// Largest number of sums that a group computes together.
inline constexpr int most_totals = 6;

/// Eight lanes of a block as the group of formulas (model/formulas/velocity_line.hpp). Each lane has one
/// number. All groups of a block compute sums together; `shared` has most_totals numbers for each lane.
template <class Lane>
struct lane_group {
  using number = double;  ///< number of a lane

  const Lane& lane;  ///< this lane
  double* shared;    ///< memory of the block

  APSIS_FORMULA int place() const { return lane.index() % 8; }  ///< 0 … 7
  APSIS_FORMULA int group() const { return lane.index() / 8; }  ///< number of the group
  /// Returns the number of the group among the groups of all blocks.
  APSIS_FORMULA int number_in_launch() const { return lane.block() * (lane.count() / 8) + group(); }
  APSIS_FORMULA double load(const double* from) const { return from[place()]; }       ///< one of eight
  APSIS_FORMULA double load_once(const double* from) const { return from[place()]; }  ///< one of eight
  /// Returns the number of this lane among `count`; 0 beyond.
  APSIS_FORMULA double load(const double* from, int count) const {
    return place() < count ? from[place()] : 0.0;
  }
  /// Returns `mine` for the first `count` lanes, and 0 for the others.
  APSIS_FORMULA double first(double mine, int count) const { return place() < count ? mine : 0.0; }
  APSIS_FORMULA double numbers() const { return place(); }  ///< 0 … 7
  /// Stores the number of this lane if it is one of the first `count`.
  APSIS_FORMULA void store(double mine, int count, double* to) const {
    if (place() < count) to[place()] = mine;
  }
  /// Returns the sum of the numbers of a group, by adding halves until one number remains.
  APSIS_FORMULA double total(double mine) const {
    double one[1] = {mine};
    totals(one);
    return one[0];
  }
  /// Replaces several numbers of each lane by their sums over the group.
  template <int Count>
  APSIS_FORMULA void totals(double (&of)[Count]) const {
    static_assert(Count <= most_totals);
    for (int k = 0; k < Count; ++k) shared[k * lane.count() + lane.index()] = of[k];
    lane.wait();
    for (int k = 0; k < Count; ++k) {
      const double* x = shared + k * lane.count() + 8 * group();
      const double even = (x[0] + x[4]) + (x[2] + x[6]), odd = (x[1] + x[5]) + (x[3] + x[7]);
      of[k] = even + odd;
    }
    lane.wait();
  }
  /// Whether `here` holds for any group of the block. All lanes of a group must pass the same value.
  APSIS_FORMULA bool any_of_block(bool here) const {
    shared[lane.index()] = here ? 1.0 : 0.0;
    lane.wait();
    bool some = false;
    for (int k = 0; k < lane.count(); k += 8) some = some || shared[k] != 0.0;
    lane.wait();
    return some;
  }
};

}  // namespace apsis::kernels
