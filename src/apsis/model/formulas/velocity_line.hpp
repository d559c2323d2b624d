// Loops over the velocities of a line, for eight numbers at a time. A group of eight is an octet_group
// (exec/octet-inl.hpp) or eight lanes of a device. Results have the same bits on all groups.
#if defined(APSIS_MODEL_FORMULAS_VELOCITY_LINE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_VELOCITY_LINE
#undef APSIS_MODEL_FORMULAS_VELOCITY_LINE
#else
#define APSIS_MODEL_FORMULAS_VELOCITY_LINE
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/line.hpp>
#include <apsis/model/formulas/velocity.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Number of values in a group.
inline constexpr int octet_length = 8;

/// The sums Σ f, Σ v f, Σ ½v² f.
struct moments_of_line {
  double mass, momentum, energy;
};

/// of_rows ← the sums over n velocities of several rows, which share the loads of v and ½v².
template <int Rows, class Group, class N = typename Group::number>
APSIS_FORMULA void sum_moments(const Group& group, const double* f, long pitch, const double* v,
                               const double* half_square, int n, moments_of_line* of_rows) {
  sums_of_moments<N> sums[Rows][2];  // two chains each, because additions wait for each other
  int j = 0;
  for (; j + 2 * octet_length <= n; j += 2 * octet_length)
    for (int half = 0; half < 2; ++half) {
      const int k = j + half * octet_length;
      const N speed = group.load(v + k), square = group.load(half_square + k);
      for (int r = 0; r < Rows; ++r) sums[r][half].add(group.load_once(f + r * pitch + k), speed, square);
    }
  for (; j < n; j += octet_length) {
    const N speed = group.load(v + j, n - j), square = group.load(half_square + j, n - j);
    for (int r = 0; r < Rows; ++r) sums[r][0].add(group.load(f + r * pitch + j, n - j), speed, square);
  }
  for (int r = 0; r < Rows; ++r)
    of_rows[r] = {group.total(sums[r][0].mass + sums[r][1].mass),
                  group.total(sums[r][0].momentum + sums[r][1].momentum),
                  group.total(sums[r][0].energy + sums[r][1].energy)};
}

/// Largest number of velocities in one chain of additions. More velocities are halved, because the error of a
/// sum grows with the additions in a chain.
inline constexpr int longest_chain_of_line = 256;

/// Returns the sums over n velocities of a row, with the bits of velocity_rows::moments(). The row is halved
/// repeatedly at whole cache lines, into up to 2^Halvings chains.
template <int Halvings, class Group>
APSIS_FORMULA moments_of_line moments_of_row(const Group& group, const double* f, const double* v,
                                             const double* half_square, int n) {
  moments_of_line before[Halvings];  // sums of the first half
  int behind[Halvings];              // velocities of the second half; 0 while they are summed
  for (int halved = 0, first = 0;;) {
    while (n > longest_chain_of_line) {
      const int half = (n / 2 + octet_length - 1) / octet_length * octet_length;
      behind[halved++] = n - half;
      n = half;
    }
    moments_of_line own;
    sum_moments<1>(group, f + first, 0, v + first, half_square + first, n, &own);
    first += n;
    for (; halved > 0 && behind[halved - 1] == 0; --halved) {
      const moments_of_line& other = before[halved - 1];
      own = {other.mass + own.mass, other.momentum + own.momentum, other.energy + own.energy};
    }
    if (halved == 0) return own;
    before[halved - 1] = own;
    n = behind[halved - 1];
    behind[halved - 1] = 0;
  }
}

/// Velocities and the weights of their quadrature.
struct line_points {
  int n;            ///< how many
  const double *v,  ///< velocities
      *b;           ///< weights; nullptr: all are 1
};

/// Returns Σ_j b_j x_j c_j^p, c = v − u. The call next(j, count, c) returns the numbers x of the octet at j.
/// The line has `count` numbers from j on; numbers behind the line must be 0.
template <class Powers, class Group, class Next, class N = typename Group::number>
APSIS_FORMULA Powers powers_on_line(const Group& group, const line_points& line, double u, const Next& next) {
  Powers powers;
  for (int j = 0; j < line.n; j += octet_length) {
    const int count = line.n - j;
    const N c = group.load(line.v + j, count) - N(u), x = next(j, count, c);
    powers.add(line.b == nullptr ? x : x * group.load(line.b + j, count), c);
  }
  return powers;
}

/// The numbers x of a row, for powers_on_line().
template <class Group, class N = typename Group::number>
struct row_of_line {
  const Group& group;
  const double* x;
  APSIS_FORMULA N operator()(int j, int count, N) const { return group.load(x + j, count); }
};

/// The numbers x of a row times e^(βc + γc²), for powers_on_line(). They replace those of the row. Exponents
/// are at most small_exponent.
template <class Group, class N = typename Group::number>
struct changed_row_of_line {
  const Group& group;
  double* x;
  double beta, gamma;
  APSIS_FORMULA N operator()(int j, int count, N c) const {
    const N changed = changed_weight(group.load(x + j, count), c, N(beta), N(gamma));
    group.store(changed, count, x + j);
    return changed;  // 0 behind the line, like the loaded numbers
  }
};

/// Evenly spaced velocities.
struct spaced_line {
  int n;           ///< how many
  double spacing;  ///< Δv

  APSIS_FORMULA int octets() const { return (n + octet_length - 1) / octet_length; }
  APSIS_FORMULA double jump() const { return spacing * octet_length; }
};

/// A Gaussian a exp(−(v − u)²/(2T)).
struct gaussian_of_line {
  double a, u, T;

  APSIS_FORMULA double per() const { return 0.5 / T; }
};

/// Whether the recursion computes the values.
APSIS_FORMULA bool walks_outwards(const spaced_line& line, const gaussian_of_line& of) {
  return gaussian_recurs(line.jump() * line.jump() * of.per(), line.octets());
}

/// Returns v − u for the velocities of octet k.
template <class Group, class N = typename Group::number>
APSIS_FORMULA N distances_of_octet(const Group& group, const spaced_line& line, double u, double k) {
  return distance_to(N(u), N(line.spacing), group.numbers() + N(k * octet_length + 0.5 - 0.5 * line.n));
}

/// Calls put(first velocity, values) for all octets, with values by exponentials.
template <class Group, class Put, class N = typename Group::number>
APSIS_FORMULA void gaussian_by_octets(const Group& group, const spaced_line& line, const gaussian_of_line& of,
                                      const Put& put) {
  for (int k = 0; k < line.octets(); ++k)
    put(k * octet_length, gaussian_start(N(of.a), distances_of_octet(group, line, of.u, k), N(of.per())));
}

/// A Gaussian on one octet, with the factors to the octets on the right and on the left, and the change of
/// the factors.
template <class N>
struct gaussian_outwards {
  N value, right, left, change;
};

/// Calls put(first velocity, values) for all octets, outwards from octet `centre`.
template <bool Deep, class N, class Put>
APSIS_FORMULA void walk_outwards(const gaussian_outwards<N>& from, int centre, int n, const Put& put) {
  gaussian_walk<Deep, N> walk{from.value, from.right, from.change};
  int k = centre * octet_length;
  for (; k + octet_length <= n; k += octet_length) {
    put(k, walk.value);
    walk.advance();
  }
  if (k < n) put(k, walk.value);
  walk = {from.value, from.left, from.change};
  for (k = (centre - 1) * octet_length; k >= 0; k -= octet_length) {
    walk.advance();
    put(k, walk.value);
  }
}

/// Calls put(first velocity, values) for all octets outwards. Checks values only if they may leave the range
/// of normal numbers.
template <class N, class Put>
APSIS_FORMULA void walk_outwards(const gaussian_outwards<N>& from, int centre, const spaced_line& line,
                                 const gaussian_of_line& of, const Put& put) {
  const double farthest = 0.5 * line.spacing * line.n + line.jump() + __builtin_fabs(of.u);
  if (gaussian_is_deep(of.a, farthest, of.per())) {
    walk_outwards<true>(from, centre, line.n, put);
  } else {
    walk_outwards<false>(from, centre, line.n, put);
  }
}

/// Primitive variables of the moments on a line.
struct state_of_line {
  double rho, u, T;

  /// Returns the state of ω = (ρ, ρu, 𝓔), without checking that it is admissible.
  static APSIS_FORMULA state_of_line of(double mass, double momentum, double energy) {
    const double u = momentum / mass;
    return {mass, u, 2.0 * energy / mass - u * u};
  }
  /// Returns ρ/√(2πT).
  APSIS_FORMULA double height() const {
    return rho * (1.0 / __builtin_sqrt(2.0 * 3.14159265358979323846 * T));
  }
  /// Whether all are finite, ρ > 0 and T > 0.
  APSIS_FORMULA bool admissible() const {
    const double sum = rho + __builtin_fabs(u) + T;
    return rho > 0.0 && T > 0.0 && sum - sum == 0.0;
  }
};

/// Whether sums of the Gaussian over evenly spaced velocities up to `max` equal its moments to rounding
/// (formula_has_exact_moments() of maxwellian.hpp).
APSIS_FORMULA bool gaussian_has_exact_moments(double spacing, double max, const state_of_line& state) {
  constexpr double dense = 1e-250;  // values below 1e-300 are below its rounding
  constexpr double enough = 40.0;   // 100 e^−40 is below the rounding of a sum
  constexpr double spacings = enough / (2.0 * 3.14159265358979323846 * 3.14159265358979323846);
  const double room = max - __builtin_fabs(state.u);
  return state.rho >= dense && state.T >= spacings * spacing * spacing && room > 0.0 &&
         room * room >= 2.0 * enough * state.T;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
