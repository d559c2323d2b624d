#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/velocity_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/velocity_rows.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/velocity_line.hpp>

#include <algorithm>
#include <array>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = octet;
constexpr octet_group eight;

template <int Rows>
HWY_INLINE void moments_of(const double* f, std::ptrdiff_t pitch, const double* v, const double* half_square,
                           int n, velocity_rows::sums* of_rows) {
  moments_of_line sums[Rows];
  sum_moments<Rows>(eight, f, pitch, v, half_square, n, sums);
  for (int r = 0; r < Rows; ++r) of_rows[r] = {sums[r].mass, sums[r].momentum, sums[r].energy};
}

void moments(const double* f, std::ptrdiff_t pitch, int rows, const double* v, const double* half_square,
             int n, velocity_rows::sums* of_rows) {
  int r = 0;
  for (; r + 3 <= rows; r += 3) moments_of<3>(f + r * pitch, pitch, v, half_square, n, of_rows + r);
  for (; r < rows; ++r) moments_of<1>(f + r * pitch, pitch, v, half_square, n, of_rows + r);
}

HWY_INLINE gaussian_of_line curve(const velocity_rows::gaussian& of) {
  return {of.a, of.u, of.T};
}

void gaussian_by_exponentials(const spaced_line& line, const velocity_rows::gaussian& of, double* m) {
  gaussian_by_octets(eight, line, curve(of),
                     [&](int k, const N& values) APSIS_PACKED { eight.store(values, line.n - k, m + k); });
}

void gaussian_at(const double* v, int n, const velocity_rows::gaussian& of, double* m) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  using packed = pack<wide>;
  for (int j = 0; j < n; j += length) {
    const packed x = load_some(v + j, n - j) - packed(of.u);
    store_some(gaussian_start(packed(of.a), x, packed(0.5 / of.T)), n - j, m + j);
  }
}

void exponentials(double shift, int n, double* x) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  for (int j = 0; j < n; j += length)
    store_some(exp_of(load_some(x + j, n - j) - pack<wide>(shift)), n - j, x + j);
}

/// The first octets of eight Gaussians. The change of `right` is one number per Gaussian, so that one vector
/// exponential computes it for all of them. The other factors could also be computed from a few numbers.
/// Their errors would then have the same sign, and so would those of the moments.
class first_octets {
 public:
  first_octets(const spaced_line& line, const velocity_rows::gaussian* of, int rows) : line_(line) {
    gaussian_vector(gathered(&of->u, rows), N(line.spacing), N(line.n), N(octet_length), N(line.octets()))
        .store(centre_);
    const N per = N(0.5) / gathered(&of->T, rows);
    per.store(per_);
    // All exponentials are computed before the first row is filled, because their long chains of operations
    // then overlap.
    for (int p = 0; p < rows; ++p) {
      const N x = distances_of_octet(eight, line, of[p].u, centre_[p]);
      gaussian_start(N(of[p].a), x, N(per_[p])).store(values_[p]);
      gaussian_right(x, N(per_[p]), N(line.jump())).store(right_[p]);
    }
    gaussian_change(per, N(line.jump())).store(change_);
  }

  void fill_row(int p, const velocity_rows::gaussian& of, double* m) const {
    if (!walks_outwards(line_, curve(of))) return gaussian_by_exponentials(line_, of, m);
    const N right = N::load(right_[p]), change(change_[p]);
    const gaussian_outwards<N> from{N::load(values_[p]), right, change / right, change};
    const int n = line_.n;
    walk_outwards(from, static_cast<int>(centre_[p]), line_, curve(of),
                  [&](int k, const N& values) APSIS_PACKED {
                    if (k + octet_length <= n)
                      values.store(m + k);
                    else
                      eight.store(values, n - k, m + k);
                  });
  }

 private:
  /// Returns one number of each Gaussian. If there are fewer than eight, the last one is repeated.
  static HWY_INLINE N gathered(const double* of_first, int rows) {
    constexpr int apart = sizeof(velocity_rows::gaussian) / sizeof(double);
    alignas(64) double all[octet_length];
    for (int p = 0; p < octet_length; ++p) all[p] = of_first[apart * std::min(p, rows - 1)];
    return N::load(all);
  }

  const spaced_line& line_;
  alignas(64) double centre_[octet_length], per_[octet_length], change_[octet_length],
      right_[octet_length][octet_length], values_[octet_length][octet_length];
};

void gaussians(const velocity_rows::points& points, const velocity_rows::gaussian* of_rows, int rows,
               double* m, std::ptrdiff_t pitch) {
  const spaced_line line{points.n, points.spacing};
  for (int first = 0; first < rows; first += octet_length) {
    const int some = std::min(octet_length, rows - first);
    const auto* const group = of_rows + first;
    double* const to = m + first * pitch;
    if (std::none_of(group, group + some,
                     [&](const auto& one) { return walks_outwards(line, curve(one)); })) {
      for (int p = 0; p < some; ++p) gaussian_by_exponentials(line, group[p], to + p * pitch);
    } else {
      const first_octets of(line, group, some);
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
  // Rows are halved repeatedly, at whole cache lines, because the error of a sum grows with the additions in
  // a chain.
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
