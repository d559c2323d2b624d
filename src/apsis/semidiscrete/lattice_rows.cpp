#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/lattice_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/lattice_rows.hpp>

#include <apsis/semidiscrete/formulas/lattice.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(wide()));

/// Lines with adjacent numbers at each point. The numbers of point j are `pitch` numbers after those of point
/// j − 1.
struct bundle {
  const double* values;
  double *sum, *into_last;
  std::ptrdiff_t pitch;
  int points, count;  ///< `count`: number of lines, at most a vector
};

/// The values of a bundle in the direction of motion, with a vacuum beyond its ends.
template <bool Whole>
class values_along {
 public:
  HWY_INLINE values_along(const bundle& of, bool forward)
      : first_(of.values + (forward ? 0 : (of.points - 1) * of.pitch)),
        step_(forward ? of.pitch : -of.pitch),
        points_(of.points),
        count_(of.count) {}
  HWY_INLINE N operator()(int j) const {
    if (j < 0 || j >= points_) return N(0.0);
    const double* from = first_ + j * step_;
    if constexpr (Whole) return N::load(from);
    return load_some(from, count_);
  }

 private:
  const double* first_;
  std::ptrdiff_t step_;
  int points_, count_;
};

template <bool Limited, bool FifthOrder, bool Whole>
HWY_INLINE void change_bundle(const bundle& of, const lattice_rows::flux_rule& rule, double rate,
                              bool fresh) {
  const values_along<Whole> values(of, rule.forward);
  const std::ptrdiff_t step = rule.forward ? of.pitch : -of.pitch;
  double* sum = of.sum + (rule.forward ? 0 : (of.points - 1) * of.pitch);
  const auto put = [&](N difference) APSIS_PACKED {
    const N before = fresh ? N(0.0) : Whole ? N::load(sum) : load_some(sum, of.count);
    const N after = fma(N(rate), difference, before);
    if constexpr (Whole)
      after.store(sum);
    else
      store_some(after, of.count, sum);
    sum += step;
  };
  const N in = add_fluxes<Limited, FifthOrder>(values, of.points, N(rule.inverse_cfl), put);
  store_some(in, of.count, of.into_last);
}

template <bool Limited, bool FifthOrder>
HWY_INLINE void change_lines(const bundle& of, const lattice_rows::flux_rule& rule, double rate, bool fresh) {
  if (of.count == lanes)
    change_bundle<Limited, FifthOrder, true>(of, rule, rate, fresh);
  else
    change_bundle<Limited, FifthOrder, false>(of, rule, rate, fresh);
}

void change_bundle_by(const bundle& of, const lattice_rows::flux_rule& rule, double rate, bool fresh) {
  if (rule.limited && rule.fifth_order) return change_lines<true, true>(of, rule, rate, fresh);
  if (rule.limited) return change_lines<true, false>(of, rule, rate, fresh);
  if (rule.fifth_order) return change_lines<false, true>(of, rule, rate, fresh);
  change_lines<false, false>(of, rule, rate, fresh);
}

/// Transposes a square of lanes² numbers.
HWY_INLINE void transpose([[maybe_unused]] N (&row)[lanes]) {
#if HWY_TARGET != HWY_SCALAR  // a target without such operations
  const wide d;
  if constexpr (lanes >= 2)
    for (int k = 0; k < lanes; k += 2) {
      const auto low = hn::InterleaveLower(d, row[k].v, row[k + 1].v);
      row[k + 1] = N(hn::InterleaveUpper(d, row[k].v, row[k + 1].v));
      row[k] = N(low);
    }
  if constexpr (lanes == 4)
    for (int k = 0; k < 2; ++k) {
      const auto low = hn::ConcatLowerLower(d, row[k + 2].v, row[k].v);
      row[k + 2] = N(hn::ConcatUpperUpper(d, row[k + 2].v, row[k].v));
      row[k] = N(low);
    }
  if constexpr (lanes == 8) {
    for (int k = 0; k < 8; ++k) {
      if ((k & 2) != 0) continue;
      const auto low = row[k].v, high = row[k + 2].v;
      row[k] = N(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(high), low));
      row[k + 2] = N(hn::OddEvenBlocks(high, hn::SwapAdjacentBlocks(low)));
    }
    for (int k = 0; k < 4; ++k) {
      const auto low = hn::ConcatLowerLower(d, row[k + 4].v, row[k].v);
      row[k + 4] = N(hn::ConcatUpperUpper(d, row[k + 4].v, row[k].v));
      row[k] = N(low);
    }
  }
#endif
}

/// Calls body(point) for squares of `lanes` points that cover a line. The last square may overlap
/// the one before.
template <class Body>
HWY_INLINE void for_squares(int points, const Body& body) {
  for (int point = 0; point < points; point += lanes) body(std::max(0, std::min(point, points - lanes)));
}

/// Copies lines of contiguous points to the columns of a bundle; to_lines() is the inverse.
HWY_INLINE void to_columns(const double* lines, int count, int points, double* columns) {
  for_squares(points, [&](int point) APSIS_PACKED {
    N square[lanes];
    for (int k = 0; k < lanes; ++k)
      square[k] = k < count ? load_some(lines + k * points + point, points - point) : N(0.0);
    transpose(square);
    for (int k = 0; k < lanes; ++k) square[k].store(columns + (point + k) * lanes);
  });
}
HWY_INLINE void to_lines(const double* columns, int count, int points, double* lines) {
  for_squares(points, [&](int point) APSIS_PACKED {
    N square[lanes];
    for (int k = 0; k < lanes; ++k) square[k] = N::load(columns + (point + k) * lanes);
    transpose(square);
    for (int k = 0; k < count; ++k) store_some(square[k], points - point, lines + k * points + point);
  });
}

void add_changes(const lattice_rows::layout& at, const lattice_rows::flux_rule& rule, double rate,
                 const double* row, bool fresh, double* sum, double* into_last, double* scratch) {
  if (at.apart > 1) {
    for (int block = 0; block < at.blocks;
         ++block, row += at.block(), sum += at.block(), into_last += at.apart)
      for (int k = 0; k < at.apart; k += lanes)
        change_bundle_by(
            {row + k, sum + k, into_last + k, at.apart, at.points, std::min(lanes, at.apart - k)}, rule, rate,
            fresh);
    return;
  }
  double *values = scratch, *changes = scratch + (at.points + lanes) * lanes;
  for (int line = 0; line < at.blocks; line += lanes) {
    const int count = std::min(lanes, at.blocks - line);
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(line) * at.points;
    double into[lanes];
    to_columns(row + first, count, at.points, values);
    if (!fresh) to_columns(sum + first, count, at.points, changes);
    change_bundle_by({values, changes, into, lanes, at.points, lanes}, rule, rate, fresh);
    to_lines(changes, count, at.points, sum + first);
    std::copy_n(into, count, into_last + line);
  }
}

void add(const double* change, double beta, int n, double* acc) {
  for_packs(n, [&](auto tag, int k) APSIS_PACKED {
    using P = pack<decltype(tag)>;
    with_change(P::load(acc + k), P(beta), P::load(change + k)).store(acc + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(add_changes);
HWY_EXPORT(add);
}  // namespace

namespace lattice_rows {

std::size_t scratch_size(int points) {
  constexpr std::size_t most_lanes = 8;
  return 2 * (static_cast<std::size_t>(points) + most_lanes) * most_lanes;
}

void add_changes(const layout& at, const flux_rule& rule, double rate, const double* row, bool fresh,
                 double* sum, double* into_last, double* scratch) {
  HWY_DYNAMIC_DISPATCH(add_changes)(at, rule, rate, row, fresh, sum, into_last, scratch);
}

void add(const double* change, double beta, int n, double* acc) {
  HWY_DYNAMIC_DISPATCH(add)(change, beta, n, acc);
}

}  // namespace lattice_rows
}  // namespace apsis
#endif
