#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/grid_sums.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/grid_sums.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/line.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;

constexpr int lanes = static_cast<int>(hn::MaxLanes(wide())), vectors = vectors_of_chains;
/// Lines that are added one after the other; more are halved. Most terms of a Gaussian lie far out. Added one
/// by one to a large sum they would all be rounded away: a loss of the same sign in every cell and step.
constexpr int longest_chain = 16;

/// Consecutive points of all lines.
struct columns {
  const double* f;  ///< of the first line
  int n,            ///< points of a line
      count;        ///< points to be added
  const double* a;  ///< functions
  int lines,        ///< of a row
      inside;       ///< lines before the first whose whole vectors would end behind the row
};

/// sum[k · Vectors + i] ← Σ_l a_kl f_l of vector i, over `count` lines from `first` on; any values at points
/// behind the count.
template <int Functions, int Vectors>
void sum_over_lines(const columns& of, int first, int count, N* sum) {
  constexpr int size = Functions * Vectors;
  if (count > longest_chain) {
    const int half = count / 2;
    N rest[size];
    sum_over_lines<Functions, Vectors>(of, first, half, sum);
    sum_over_lines<Functions, Vectors>(of, first + half, count - half, rest);
    for (int k = 0; k < size; ++k) sum[k] = sum[k] + rest[k];
    return;
  }
  N own[size];  // in registers: stores to `sum` might change f
  for (int k = 0; k < size; ++k) own[k] = N(0.0);
  const auto add = [&](int line, const auto& load) APSIS_PACKED {
    const double* from = of.f + static_cast<std::ptrdiff_t>(line) * of.n;
    N value[Vectors];
    for (int i = 0; i < Vectors; ++i) value[i] = load(from, i);
    for (int k = 0; k < Functions; ++k) {
      const N a(of.a[k * of.lines + line]);
      for (int i = 0; i < Vectors; ++i) own[k * Vectors + i] = fma(a, value[i], own[k * Vectors + i]);
    }
  };
  int line = first;
  for (; line < std::min(first + count, of.inside); ++line)
    add(line, [](const double* from, int i) APSIS_PACKED { return N::load(from + i * lanes).loaded_once(); });
  for (; line < first + count; ++line)
    add(line, [&](const double* from, int i)
                  APSIS_PACKED { return load_some(from + i * lanes, std::max(of.count - i * lanes, 0)); });
  for (int k = 0; k < size; ++k) sum[k] = own[k];
}

/// Adds the powers of some columns to those of every function and chain.
template <int Functions, int Sets, class Powers>
HWY_INLINE void add_columns(const columns& of, const double* v, const double* w, double u,
                            Powers (&powers)[Functions][vectors]) {
  constexpr int together = Sets * vectors;
  N sum[Functions * together];
  sum_over_lines<Functions, together>(of, 0, of.lines, sum);
  for (int i = 0; i < together && i * lanes < of.count; ++i) {
    const int count = of.count - i * lanes;
    const auto inside = hn::FirstN(wide(), static_cast<std::size_t>(std::min(count, lanes)));
    const N c = load_some(v + i * lanes, count) - N(u),
            weight = w == nullptr ? N(1.0) : load_some(w + i * lanes, count);
    for (int k = 0; k < Functions; ++k)
      powers[k][i % vectors].add(N(hn::IfThenElseZero(inside, (weight * sum[k * together + i]).v)), c);
  }
}

/// The accumulator of powers.
sums_of_powers<N> accumulator_of(const grid_sums::powers*);
sums_of_six_powers<N> accumulator_of(const grid_sums::six_powers*);
template <class Powers>
using accumulator = decltype(accumulator_of(static_cast<const Powers*>(nullptr)));

template <class Powers>
void store_totals(const accumulator<Powers> (&of)[vectors], double factor, Powers& sums) {
  for (std::size_t p = 0; p < sums.size(); ++p) {
    N of_vectors[vectors];
    for (int i = 0; i < vectors; ++i) of_vectors[i] = of[i].of[p];
    sums[p] = factor * total_of_chains(of_vectors);
  }
}

/// The columns from j on, in sets of `together` points.
columns columns_from(int j, int together, int n, int lines, const double* f, const double* a) {
  const int behind = n * lines - j - together;
  return {f + j, n, n - j, a, lines, behind < 0 ? 0 : behind / n + 1};
}

template <int Functions, class Powers>
void sum_functions(const grid_sums::axis& last, int lines, const double* f, double u, const double* a,
                   Powers* sums) {
  accumulator<Powers> powers[Functions][vectors];
  for (int j = 0; j < last.n; j += 2 * sum_chains) {
    const int left = last.n - j, together = left > sum_chains ? 2 * sum_chains : sum_chains;
    const columns of = columns_from(j, together, last.n, lines, f, a);
    const double *v = last.v + j, *w = last.w == nullptr ? nullptr : last.w + j;
    if (left > sum_chains) {
      add_columns<Functions, 2>(of, v, w, u, powers);
    } else {
      add_columns<Functions, 1>(of, v, w, u, powers);
    }
  }
  for (int k = 0; k < Functions; ++k) store_totals(powers[k], 1.0, sums[k]);
}

/// sum_functions() of one function and one line.
template <class Powers>
void sum_line(const grid_sums::axis& last, const double* f, double u, double a, Powers& sums) {
  accumulator<Powers> powers[vectors];
  for (int j = 0; j < last.n; j += sum_chains)
    for (int i = 0; i < vectors; ++i) {
      const int k = j + i * lanes, count = std::max(last.n - k, 0);
      const N value = load_some(f + k, count), c = load_some(last.v + k, count) - N(u);
      powers[i].add(last.w == nullptr ? value : load_some(last.w + k, count) * value, c);
    }
  store_totals(powers, a, sums);
}

/// Calls body(constant) with the number of functions, at most most_functions.
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

template <int Functions, int Sets>
void sum_columns(const columns& of, double* s, std::ptrdiff_t pitch) {
  constexpr int together = Sets * vectors;
  N sum[Functions * together];
  sum_over_lines<Functions, together>(of, 0, of.lines, sum);
  for (int k = 0; k < Functions; ++k)
    for (int i = 0; i < together && i * lanes < of.count; ++i)
      store_some(sum[k * together + i], of.count - i * lanes, s + k * pitch + i * lanes);
}

void sum_lines(const double* f, int lines, int n, const double* a, int functions, double* s) {
  with_functions(functions, [&](auto count) APSIS_PACKED {
    for (int j = 0; j < n; j += 2 * sum_chains) {
      if (n - j > sum_chains) {
        sum_columns<count, 2>(columns_from(j, 2 * sum_chains, n, lines, f, a), s + j, n);
      } else {
        sum_columns<count, 1>(columns_from(j, sum_chains, n, lines, f, a), s + j, n);
      }
    }
  });
}

void scale(double factor, const double* g, int n, double* h) {
  for_packs(n, [&](auto tag, int j) APSIS_PACKED {
    using P = pack<decltype(tag)>;
    (P(factor) * P::load(g + j)).store(h + j);
  });
}

void multiply(const double* a, int lines, const double* g, int n, double* m) {
  const int rest = n % lanes, whole = n - rest;
  const N last = load_some(g + whole, rest);
  for (int line = 0; line < lines; ++line, m += n) {
    const N factor(a[line]);
    for (int j = 0; j < whole; j += lanes) (factor * N::load(g + j)).store(m + j);
    // A whole vector changes the beginning of later lines, which are stored after it.
    if (rest > 0) store_some(factor * last, (lines - line) * n - whole >= lanes ? lanes : rest, m + whole);
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
