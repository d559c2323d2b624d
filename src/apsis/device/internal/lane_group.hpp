#pragma once

#include <apsis/device/internal/lane.hpp>

namespace apsis::kernels {

/// Eight lanes of a block as the group of formulas (model/formulas/velocity_line.hpp): each of them has one
/// number. All groups of a block take the sums together, with `shared`, a number for each lane.
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
  /// The sum of the numbers of a group, halves of halves.
  APSIS_FORMULA double total(double mine) const {
    shared[lane.index()] = mine;
    lane.wait();
    const double* x = shared + 8 * group();
    const double even = (x[0] + x[4]) + (x[2] + x[6]), odd = (x[1] + x[5]) + (x[3] + x[7]);
    lane.wait();
    return even + odd;
  }
};

}  // namespace apsis::kernels
