#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/grid_sums.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/grid_sums.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/line.hpp>
#include <apsis/model/formulas/velocity_grid.hpp>

#include <cstddef>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = octet;
constexpr octet_group eight;

/// Enough for velocity_grid::most_velocities.
constexpr int halvings = 26;

/// Declarations that map the result of a sum to its accumulator.
sums_of_powers<N> accumulator_of(const grid_sums::powers*);
sums_of_six_powers<N> accumulator_of(const grid_sums::six_powers*);
template <class Powers>
using accumulator = decltype(accumulator_of(static_cast<const Powers*>(nullptr)));

template <class Powers>
void store_totals(const accumulator<Powers>& of, double factor, Powers& sums) {
  for (std::size_t p = 0; p < sums.size(); ++p) sums[p] = factor * eight.total(of.of[p]);
}

template <int Functions, class Powers>
void sum_functions(const grid_sums::axis& last, int lines, const double* f, double u, const double* a,
                   Powers* sums) {
  accumulator<Powers> powers[Functions];
  sum_powers<Functions, halvings>(eight, {f, last.n, lines, a}, last.v, last.w, u, powers);
  for (int k = 0; k < Functions; ++k) store_totals(powers[k], 1.0, sums[k]);
}

/// Computes sum_functions() of one function and one line.
template <class Powers>
void sum_line(const grid_sums::axis& last, const double* f, double u, double a, Powers& sums) {
  const row_of_line<octet_group> row{eight, f};
  store_totals(powers_on_line<accumulator<Powers>>(eight, {last.n, last.v, last.w}, u, row), a, sums);
}

/// Calls body(constant), where the constant is the number of functions, at most most_functions.
template <class Body>
void with_functions(int functions, const Body& body) {
  switch (functions) {
    case 1:
      return body(std::integral_constant<int, 1>());
    case 2:
      return body(std::integral_constant<int, 2>());
    case 3:
      return body(std::integral_constant<int, 3>());
    case 4:
      return body(std::integral_constant<int, 4>());
    default:
      return body(std::integral_constant<int, grid_sums::most_functions>());
  }
}

template <class Powers>
void sum_with(const grid_sums::axis& last, int lines, const double* f, double u, const double* a,
              int functions, Powers* sums) {
  if (lines == 1 && functions == 1) return sum_line(last, f, u, a[0], sums[0]);
  with_functions(functions,
                 [&](auto count) APSIS_PACKED { sum_functions<count>(last, lines, f, u, a, sums); });
}

void sum(const grid_sums::axis& last, int lines, const double* f, double u, const double* a, int functions,
         grid_sums::powers* sums) {
  sum_with(last, lines, f, u, a, functions, sums);
}

void sum_six(const grid_sums::axis& last, int lines, const double* f, double u, const double* a,
             int functions, grid_sums::six_powers* sums) {
  sum_with(last, lines, f, u, a, functions, sums);
}

template <int Functions, int Octets>
void sum_columns(const columns_of_grid& of, double* s) {
  N sum[Functions * Octets];
  sum_over_lines<Functions, Octets, halvings>(eight, of, sum);
  for (int k = 0; k < Functions; ++k)
    for (int i = 0; i < Octets && i * octet_length < of.count; ++i)
      eight.store(sum[k * Octets + i], of.count - i * octet_length,
                  s + static_cast<std::ptrdiff_t>(k) * of.of.n + of.first + i * octet_length);
}

void sum_lines(const double* f, int lines, int n, const double* a, int functions, double* s) {
  const lines_of_grid of{f, n, lines, a};
  with_functions(functions, [&](auto count) APSIS_PACKED {
    int j = 0;
    // Longer runs of memory are read faster, if there are enough registers for their sums.
    constexpr int most = vectors_of_chains == 1 ? 4 : 2;
    for (; n - j >= most * octet_length; j += most * octet_length)
      sum_columns<count, most>(columns_of_grid::from(of, j, most), s);
    for (; n - j > octet_length; j += 2 * octet_length)
      sum_columns<count, 2>(columns_of_grid::from(of, j, 2), s);
    if (j < n) sum_columns<count, 1>(columns_of_grid::from(of, j, 1), s);
  });
}

void scale(double factor, const double* g, int n, double* h) {
  for_packs(n, [&](auto tag, int j) APSIS_PACKED {
    using P = pack<decltype(tag)>;
    (P(factor) * P::load(g + j)).store(h + j);
  });
}

void multiply(const double* a, int lines, const double* g, int n, double* m) {
  using packed = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide())), rest = n % length, whole = n - rest;
  const packed last = load_some(g + whole, rest);
  for (int line = 0; line < lines; ++line, m += n) {
    const packed factor(a[line]);
    for (int j = 0; j < whole; j += length) (factor * packed::load(g + j)).store(m + j);
    // Storing a whole vector overwrites the beginning of later lines, which are stored afterwards.
    if (rest > 0) store_some(factor * last, (lines - line) * n - whole >= length ? length : rest, m + whole);
  }
}

double entropy(const double* w, const double* g, const double* h, double degrees, int n) {
  return entropy_of_row(octet_group(), w, g, h, degrees, n);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(sum);
HWY_EXPORT(sum_six);
HWY_EXPORT(sum_lines);
HWY_EXPORT(multiply);
HWY_EXPORT(scale);
HWY_EXPORT(entropy);
}  // namespace

void grid_sums::sum(const axis& last, int lines, const double* f, double u, const double* a, int functions,
                    powers* sums) {
  HWY_DYNAMIC_DISPATCH(sum)(last, lines, f, u, a, functions, sums);
}

void grid_sums::sum(const axis& last, int lines, const double* f, double u, const double* a, int functions,
                    six_powers* sums) {
  HWY_DYNAMIC_DISPATCH(sum_six)(last, lines, f, u, a, functions, sums);
}

void grid_sums::sum_lines(const double* f, int lines, int n, const double* a, int functions, double* s) {
  HWY_DYNAMIC_DISPATCH(sum_lines)(f, lines, n, a, functions, s);
}

void grid_sums::multiply(const double* a, int lines, const double* g, int n, double* m) {
  HWY_DYNAMIC_DISPATCH(multiply)(a, lines, g, n, m);
}

void grid_sums::scale(double factor, const double* g, int n, double* h) {
  HWY_DYNAMIC_DISPATCH(scale)(factor, g, n, h);
}

double grid_sums::entropy(const double* w, const double* g, const double* h, double degrees, int n) {
  return HWY_DYNAMIC_DISPATCH(entropy)(w, g, h, degrees, n);
}

}  // namespace apsis
#endif
