// Loops over the velocities of a product of lines, for eight numbers at a time like those
// of velocity_line.hpp.
#if defined(APSIS_MODEL_FORMULAS_VELOCITY_GRID) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_VELOCITY_GRID
#undef APSIS_MODEL_FORMULAS_VELOCITY_GRID
#else
#define APSIS_MODEL_FORMULAS_VELOCITY_GRID
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/velocity_line.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Most lines that are added one after the other. More lines are halved. Most terms of a Gaussian lie far
/// out. Added one by one to a large sum, they would all be rounded away. This loss would have the same sign
/// in every cell and step.
inline constexpr int longest_chain_of_lines = 16;

/// The last lines of a row, and functions a_k with one value per line.
struct lines_of_grid {
  const double* f;  ///< the row
  int n,            ///< points of a line
      lines;        ///< number of lines
  const double* a;  ///< a_kl is a[k · lines + l]
};

/// Consecutive points of all lines.
struct columns_of_grid {
  lines_of_grid of;
  int first,   ///< first point
      count,   ///< points of a line from `first` on
      inside;  ///< number of lines whose whole octets end within the row

  /// Returns the points from `first` on, in `octets` octets.
  static APSIS_FORMULA columns_of_grid from(const lines_of_grid& of, int first, int octets) {
    const int behind = of.n * of.lines - first - octets * octet_length;
    return {of, first, of.n - first, behind < 0 ? 0 : behind / of.n + 1};
  }
};

/// Adds a_kl f_l to sum[k · Octets + i] for octet i of line l.
template <int Functions, int Octets, bool Whole, class Group, class N>
APSIS_FORMULA void add_line(const Group& group, const columns_of_grid& at, int line, N* sum) {
  const double* from = at.of.f + static_cast<long>(line) * at.of.n + at.first;
  N value[Octets];
  for (int i = 0; i < Octets; ++i)
    value[i] = Whole ? group.load_once(from + i * octet_length)
                     : group.load(from + i * octet_length, at.count - i * octet_length);
  for (int k = 0; k < Functions; ++k) {
    const N a(at.of.a[k * at.of.lines + line]);
    for (int i = 0; i < Octets; ++i) sum[k * Octets + i] = fma(a, value[i], sum[k * Octets + i]);
  }
}

/// sum[k · Octets + i] ← Σ_l a_kl f_l for octet i. Points behind `count` get undefined values. Lines are
/// halved repeatedly, at most `Halvings` times.
template <int Functions, int Octets, int Halvings, class Group, class N>
APSIS_FORMULA void sum_over_lines(const Group& group, const columns_of_grid& at, N* sum) {
  constexpr int size = Functions * Octets;
  N before[Halvings][size];  // sums of first halves whose second halves are in progress
  int behind[Halvings];      // lines of the second half; 0 while they are summed
  int halved = 0, line = 0, count = at.of.lines;
  for (;;) {
    for (; count > longest_chain_of_lines; count /= 2) behind[halved++] = count - count / 2;
    N own[size];  // in registers: stores to `sum` might change f
    for (int k = 0; k < size; ++k) own[k] = N(0.0);
    const int end = line + count, inside = at.inside < end ? at.inside : end;
    for (; line < inside; ++line) add_line<Functions, Octets, true>(group, at, line, own);
    for (; line < end; ++line) add_line<Functions, Octets, false>(group, at, line, own);
    for (; halved > 0 && behind[halved - 1] == 0; --halved)
      for (int k = 0; k < size; ++k) own[k] = before[halved - 1][k] + own[k];
    if (halved == 0) {
      for (int k = 0; k < size; ++k) sum[k] = own[k];
      return;
    }
    for (int k = 0; k < size; ++k) before[halved - 1][k] = own[k];
    count = behind[halved - 1];
    behind[halved - 1] = 0;
  }
}

/// Adds the powers of these columns to those of every function.
template <int Functions, int Octets, int Halvings, class Group, class Powers,
          class N = typename Group::number>
APSIS_FORMULA void add_columns(const Group& group, const columns_of_grid& at, const double* v,
                               const double* w, double u, Powers* powers) {
  N sum[Functions * Octets];
  sum_over_lines<Functions, Octets, Halvings>(group, at, sum);
  for (int i = 0; i < Octets && i * octet_length < at.count; ++i) {
    const int j = at.first + i * octet_length, count = at.of.n - j;
    const N c = group.load(v + j, count) - N(u);
    const N weight = w == nullptr ? N(1.0) : group.load(w + j, count);
    for (int k = 0; k < Functions; ++k) powers[k].add(group.first(weight * sum[k * Octets + i], count), c);
  }
}

/// Adds Σ_j w_j c_j^p Σ_l a_kl f_lj, c = v − u, to the powers of every function k. w = nullptr: all weights
/// are 1.
template <int Functions, int Halvings, class Group, class Powers>
APSIS_FORMULA void sum_powers(const Group& group, const lines_of_grid& of, const double* v, const double* w,
                              double u, Powers* powers) {
  for (int j = 0; j < of.n; j += 2 * octet_length) {
    if (of.n - j > octet_length) {
      add_columns<Functions, 2, Halvings>(group, columns_of_grid::from(of, j, 2), v, w, u, powers);
    } else {
      add_columns<Functions, 1, Halvings>(group, columns_of_grid::from(of, j, 1), v, w, u, powers);
    }
  }
}

/// Returns Σ ½|v|² f from Σ v² f of the last direction and Σ ½|v|² f of the others.
APSIS_FORMULA double energy_of_grid(double along, double across) {
  return 0.5 * along + across;
}

/// Functions of the velocities of each direction.
struct functions_of_directions {
  int dimensions;      ///< 1 … 3
  int n[3];            ///< points
  const double* g[3];  ///< values at the points
};

/// Calls put(line, product) for every last line. The product is `factor` times the values of all directions
/// but the last.
template <class Put>
APSIS_FORMULA void multiply_across_lines(const functions_of_directions& of, double factor, const Put& put) {
  if (of.dimensions == 1) return put(0, factor);
  int line = 0;
  for (int i = 0; i < of.n[0]; ++i) {
    const double first = factor * of.g[0][i];
    if (of.dimensions == 2) {
      put(line++, first);
    } else {
      const double* second = of.g[1];
      for (int j = 0; j < of.n[1]; ++j) put(line + j, first * second[j]);
      line += of.n[1];
    }
  }
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
