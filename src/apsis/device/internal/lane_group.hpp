#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// Sums that a group takes together.
inline constexpr int most_totals = 6;

/// Eight lanes of a block as the group of formulas (model/formulas/velocity_line.hpp): each of them has one
/// number. All groups of a block take the sums together, with `shared`, most_totals for each lane.
template <class Lane>
struct lane_group {
  using number = double;  ///< of a lane

  const Lane& lane;  ///< this lane
  double* shared;    ///< of the block

  APSIS_FORMULA int place() const { return lane.index() % 8; }  ///< 0 … 7
  APSIS_FORMULA int group() const { return lane.index() / 8; }  ///< number of the group
  /// The number of the group among those of all blocks.
  APSIS_FORMULA int number_in_launch() const { return lane.block() * (lane.count() / 8) + group(); }
  APSIS_FORMULA double load(const double* from) const { return from[place()]; }       ///< one of eight
  APSIS_FORMULA double load_once(const double* from) const { return from[place()]; }  ///< one of eight
  /// One of `count`, or 0.
  APSIS_FORMULA double load(const double* from, int count) const {
    return place() < count ? from[place()] : 0.0;
  }
  /// One of the first `count`, or 0.
  APSIS_FORMULA double first(double mine, int count) const { return place() < count ? mine : 0.0; }
  APSIS_FORMULA double numbers() const { return place(); }  ///< 0 … 7
  /// Stores this one of the first `count`.
  APSIS_FORMULA void store(double mine, int count, double* to) const {
    if (place() < count) to[place()] = mine;
  }
  /// The sum of the numbers of a group, halves of halves.
  APSIS_FORMULA double total(double mine) const {
    double one[1] = {mine};
    totals(one);
    return one[0];
  }
  /// Replaces several numbers by their sums.
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
  /// Whether something holds for any group of the block; all lanes of a group have the same answer.
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
