#pragma once

#include <apsis/integrate/lane_functions-inl.hpp>

#include <cmath>
#include <cstddef>
#include <cstring>

// Vectors are values of inlined functions only, so that no call between object files passes one.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

// A namespace of its own, because apsis::log is a namespace.
namespace apsis::lane_arithmetic {

/// One number of each of eight systems. Arithmetic is that of eight doubles, which compilers carry out in the
/// widest vectors of the target (-march=native). The number of lanes is the same for every target.
/// Comparisons do not exist: lanes would take different branches.
class lanes {
 public:
  static constexpr std::size_t count = 8;  ///< number of systems
  static_assert(count == vectors::count);

  /// Undefined numbers.
  lanes() = default;
  /// The same number in all lanes.
  lanes(double x) : all_(vector{} + x) {}

  /// Returns the eight numbers at a place.
  static lanes load(const double* from) {
    lanes x;
    std::memcpy(&x.all_, from, sizeof x.all_);
    return x;
  }
  /// Stores the eight numbers at a place.
  void store(double* to) const { std::memcpy(to, &all_, sizeof all_); }
  /// Returns the number of a lane.
  double operator[](std::size_t k) const { return all_[k]; }

  lanes& operator+=(const lanes& y) { return *this = *this + y; }  ///< adds in every lane
  lanes& operator-=(const lanes& y) { return *this = *this - y; }  ///< subtracts in every lane
  lanes& operator*=(const lanes& y) { return *this = *this * y; }  ///< multiplies in every lane

  friend lanes operator-(const lanes& x) { return lanes(-x.all_); }                          ///< −x
  friend lanes operator+(const lanes& x, const lanes& y) { return lanes(x.all_ + y.all_); }  ///< x + y
  friend lanes operator-(const lanes& x, const lanes& y) { return lanes(x.all_ - y.all_); }  ///< x − y
  friend lanes operator*(const lanes& x, const lanes& y) { return lanes(x.all_ * y.all_); }  ///< xy
  friend lanes operator/(const lanes& x, const lanes& y) { return lanes(x.all_ / y.all_); }  ///< x/y

  /// |x|
  friend lanes abs(const lanes& x) { return lanes(x.all_ < 0.0 ? -x.all_ : x.all_); }
  /// The larger number of each lane; x where y is NaN.
  friend lanes larger(const lanes& x, const lanes& y) { return lanes(y.all_ > x.all_ ? y.all_ : x.all_); }
  /// A selection of lanes.
  class choice {
    friend class lanes;
    friend choice where_larger(const lanes& x, const lanes& y);
    friend void exchange(const choice& of, lanes& x, lanes& y);
    vectors::integers chosen_;
  };
  /// Returns the lanes in which |y| > |x|.
  friend choice where_larger(const lanes& x, const lanes& y) {
    choice of;
    of.chosen_ = abs(y).all_ > abs(x).all_;
    return of;
  }
  /// Exchanges x and y in the selected lanes.
  friend void exchange(const choice& of, lanes& x, lanes& y) {
    const vector first = x.all_;
    x.all_ = of.chosen_ ? y.all_ : first;
    y.all_ = of.chosen_ ? first : y.all_;
  }

  /// √x
  friend lanes sqrt(const lanes& x) {
    return one_by_one(x, [](double z) { return std::sqrt(z); });
  }
  /// xⁿ
  friend lanes pow(const lanes& x, double n) {
    return one_by_one(x, [n](double z) { return std::pow(z, n); });
  }
  /// eˣ
  friend lanes exp(const lanes& x) {
    lanes y;
    vectors::exp(x.all_, y.all_);
    return y;
  }
  /// ln x
  friend lanes log(const lanes& x) {
    lanes y;
    vectors::log(x.all_, y.all_);
    return y;
  }
  /// sin x
  friend lanes sin(const lanes& x) {
    lanes y;
    vectors::sin(x.all_, y.all_);
    return y;
  }
  /// cos x
  friend lanes cos(const lanes& x) {
    lanes y;
    vectors::cos(x.all_, y.all_);
    return y;
  }

 private:
  using vector = vectors::numbers;
  template <class F>
  static lanes one_by_one(const lanes& x, const F& f) {
    lanes y;
    vectors::one_by_one(x.all_, y.all_, f);
    return y;
  }
  explicit lanes(const vector& all) : all_(all) {}

  vector all_;
};

/// ln x, declared again, because otherwise `log` would name the namespace of messages.
inline lanes log(const lanes& x);

}  // namespace apsis::lane_arithmetic

namespace apsis {
using lane_arithmetic::lanes;
}  // namespace apsis

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
