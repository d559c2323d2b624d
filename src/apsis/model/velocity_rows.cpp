#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/velocity_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/velocity_rows.hpp>

#include <apsis/model/formulas/velocity.hpp>

#include <algorithm>
#include <array>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(wide()));

HWY_INLINE double total(N x) {
  return hn::GetLane(hn::SumOfLanes(wide(), x.v));
}

/// Several rows share the loads of v and ½v².
template <int Rows>
HWY_INLINE void moments_of(const double* f, std::ptrdiff_t pitch, const double* v, const double* half_square,
                           int n, velocity_rows::sums* of_rows) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  sums_of_moments<N> sums[Rows][2];  // two of each kind: an addition waits for the one before it
  int j = 0;
  for (; j + 2 * length <= n; j += 2 * length)
    for (int half = 0; half < 2; ++half) {
      const int k = j + half * length;
      const N speed = N::load(v + k), square = N::load(half_square + k);
      for (int r = 0; r < Rows; ++r)
        sums[r][half].add(N::load(f + r * pitch + k).loaded_once(), speed, square);
    }
  for (; j < n; j += length) {
    const N speed = load_some(v + j, n - j), square = load_some(half_square + j, n - j);
    for (int r = 0; r < Rows; ++r) sums[r][0].add(load_some(f + r * pitch + j, n - j), speed, square);
  }
  for (int r = 0; r < Rows; ++r)
    of_rows[r] = {total(sums[r][0].mass + sums[r][1].mass), total(sums[r][0].momentum + sums[r][1].momentum),
                  total(sums[r][0].energy + sums[r][1].energy)};
}

void moments(const double* f, std::ptrdiff_t pitch, int rows, const double* v, const double* half_square,
             int n, velocity_rows::sums* of_rows) {
  int r = 0;
  for (; r + 3 <= rows; r += 3) moments_of<3>(f + r * pitch, pitch, v, half_square, n, of_rows + r);
  for (; r < rows; ++r) moments_of<1>(f + r * pitch, pitch, v, half_square, n, of_rows + r);
}

/// v − u of all points of vector k.
HWY_INLINE N distances(const velocity_rows::points& line, double u, double k) {
  const auto length = static_cast<double>(hn::Lanes(wide()));
  return distance_to(N(u), N(line.spacing), N(hn::Iota(wide(), 0.0)) + N(k * length + 0.5 - 0.5 * line.n));
}

void gaussian_by_exponentials(const velocity_rows::points& line, const velocity_rows::gaussian& of,
                              double* m) {
  const int length = static_cast<int>(hn::Lanes(wide())), vectors = (line.n + length - 1) / length;
  const N a(of.a), per(0.5 / of.T);
  for (int k = 0; k < vectors; ++k)
    store_some(gaussian_start(a, distances(line, of.u, k), per), line.n - k * length, m + k * length);
}

void gaussian_at(const double* v, int n, const velocity_rows::gaussian& of, double* m) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  for (int j = 0; j < n; j += length) {
    const N x = load_some(v + j, n - j) - N(of.u);
    store_some(gaussian_start(N(of.a), x, N(0.5 / of.T)), n - j, m + j);
  }
}

void exponentials(double shift, int n, double* x) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  for (int j = 0; j < n; j += length) store_some(exp_of(load_some(x + j, n - j) - N(shift)), n - j, x + j);
}

/// A Gaussian seen from one vector of points: what the vectors to the right and to the left are multiplied
/// with.
struct outwards {
  N value, right, left, change;
};

template <bool Deep>
HWY_INLINE void fill(const outwards& from, int centre, int n, double* m) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  gaussian_walk<Deep, N> walk{from.value, from.right, from.change};
  int k = centre * length;
  for (; k + length <= n; k += length) {
    walk.value.store(m + k);
    walk.advance();
  }
  if (k < n) store_some(walk.value, n - k, m + k);
  walk = {from.value, from.left, from.change};
  for (k = (centre - 1) * length; k >= 0; k -= length) {
    walk.advance();
    walk.value.store(m + k);
  }
}

/// Returns the number of vectors of a line.
int vectors_of(const velocity_rows::points& line) {
  return (line.n + lanes - 1) / lanes;
}

bool recurs(const velocity_rows::points& line, const velocity_rows::gaussian& of) {
  const double jump = line.spacing * lanes;
  return gaussian_recurs(jump * jump * (0.5 / of.T), vectors_of(line));
}

/// The first vectors of as many Gaussians as a vector has numbers. The change of `right` is one number for a
/// Gaussian, so that those of all of them are one exponential. The others could be made from a few numbers as
/// well, but then all their numbers would err to the same side, and so would the moments.
class first_vectors {
 public:
  first_vectors(const velocity_rows::points& line, const velocity_rows::gaussian* of, int rows)
      : line_(line) {
    gaussian_vector(gathered(&of->u, rows), N(line.spacing), N(line.n), N(length), N(vectors_of(line)))
        .store(centre_);
    const N per = N(0.5) / gathered(&of->T, rows);
    per.store(per_);
    // All of them before the first row is filled: exponentials are long chains, which then overlap.
    for (int p = 0; p < rows; ++p) {
      const N x = distances(line, of[p].u, centre_[p]);
      gaussian_start(N(of[p].a), x, N(per_[p])).store(values_[p]);
      gaussian_right(x, N(per_[p]), N(jump())).store(right_[p]);
    }
    gaussian_change(per, N(jump())).store(change_);
  }

  void fill_row(int p, const velocity_rows::gaussian& of, double* m) const {
    if (!recurs(line_, of)) return gaussian_by_exponentials(line_, of, m);
    const N right = N::load(right_[p]), change(change_[p]);
    const outwards from{N::load(values_[p]), right, change / right, change};
    const int centre = static_cast<int>(centre_[p]);
    const double farthest = 0.5 * line_.spacing * line_.n + jump() + std::abs(of.u);
    if (gaussian_is_deep(of.a, farthest, per_[p])) {
      fill<true>(from, centre, line_.n, m);
    } else {
      fill<false>(from, centre, line_.n, m);
    }
  }

 private:
  static constexpr int length = static_cast<int>(hn::MaxLanes(wide()));
  /// A number of each Gaussian, and of the last one where there are fewer than a vector has numbers.
  static HWY_INLINE N gathered(const double* of_first, int rows) {
    constexpr int apart = sizeof(velocity_rows::gaussian) / sizeof(double);
    const hn::RebindToSigned<wide> index;
    const auto row = hn::Min(hn::Iota(index, 0), hn::Set(index, rows - 1));
    return N(hn::GatherIndex(wide(), of_first, hn::Mul(row, hn::Set(index, apart))));
  }
  double jump() const { return line_.spacing * length; }

  const velocity_rows::points& line_;
  alignas(64) double centre_[most_lanes], per_[most_lanes], change_[most_lanes],
      right_[most_lanes][most_lanes], values_[most_lanes][most_lanes];
};

void gaussians(const velocity_rows::points& line, const velocity_rows::gaussian* of_rows, int rows, double* m,
               std::ptrdiff_t pitch) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  for (int first = 0; first < rows; first += length) {
    const int some = std::min(length, rows - first);
    const auto* const group = of_rows + first;
    double* const to = m + first * pitch;
    if (std::none_of(group, group + some, [&](const auto& one) { return recurs(line, one); })) {
      for (int p = 0; p < some; ++p) gaussian_by_exponentials(line, group[p], to + p * pitch);
    } else {
      const first_vectors of(line, group, some);
      for (int p = 0; p < some; ++p) of.fill_row(p, group[p], to + p * pitch);
    }
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(moments);
HWY_EXPORT(gaussians);
HWY_EXPORT(gaussian_at);
HWY_EXPORT(exponentials);
}  // namespace

void velocity_rows::moments(const double* f, std::ptrdiff_t pitch, int rows, const double* v,
                            const double* half_square, int n, sums* of_rows) {
  if (n <= longest_chain) return HWY_DYNAMIC_DISPATCH(moments)(f, pitch, rows, v, half_square, n, of_rows);
  // Halves of halves, at whole cache lines: the error of a sum grows with the additions in a chain.
  constexpr int line = 8, some = 16;
  const int half = (n / 2 + line - 1) / line * line;
  std::array<sums, some> rest;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int first = 0; first < rows; first += some) {
    const int together = std::min(some, rows - first);
    const double* from = f + first * pitch;
    moments(from, pitch, together, v, half_square, half, of_rows + first);
    moments(from + half, pitch, together, v + half, half_square + half, n - half, rest.data());
    for (int r = 0; r < together; ++r) {
      const auto& behind = rest[static_cast<std::size_t>(r)];
      auto& sum = of_rows[first + r];
      sum = {sum.mass + behind.mass, sum.momentum + behind.momentum, sum.energy + behind.energy};
    }
  }
}

void velocity_rows::gaussians(const points& line, const gaussian* of_rows, int rows, double* m,
                              std::ptrdiff_t pitch) {
  HWY_DYNAMIC_DISPATCH(gaussians)(line, of_rows, rows, m, pitch);
}

void velocity_rows::exponentials(double shift, int n, double* x) {
  HWY_DYNAMIC_DISPATCH(exponentials)(shift, n, x);
}

void velocity_rows::gaussian_at(const double* v, int n, const gaussian& of, double* m) {
  HWY_DYNAMIC_DISPATCH(gaussian_at)(v, n, of, m);
}

}  // namespace apsis
#endif
