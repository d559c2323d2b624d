// A walk over the rows of a plane (model/plane_walk.hpp), for eight numbers at a time like the loops of
// velocity_line.hpp.
#if defined(APSIS_MODEL_FORMULAS_PLANE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_PLANE
#undef APSIS_MODEL_FORMULAS_PLANE
#else
#define APSIS_MODEL_FORMULAS_PLANE
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/velocity_line.hpp>
#include <apsis/model/plane_walk.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Calls put(row, first velocity, values) for n velocities v of all rows, octet by octet. It takes two
/// exponentials per octet, and two multiplications per value.
template <class Group, class Put, class N = typename Group::number>
APSIS_FORMULA void walk_over_rows(const Group& group, const plane_walk& of, const double* v, int n,
                                  const Put& put) {
  const N change = exp_or_zero(N(of.log_of_change));
  for (int j = 0; j < n; j += octet_length) {
    const N at = group.load(v + j, n - j), y = at - N(of.u);
    const N start = gaussian_start(N(of.height), at - N(of.centre), N(0.5 / of.T));
    const N right = exp_of(N(of.log_of_factor) - N(of.slope) * y);
    gaussian_walk<false, N> walk{start, right, change};
    for (int row = of.first; row < of.rows; ++row) {
      put(row, j, walk.value);
      walk.advance();
    }
    walk = {start, change / right, change};
    for (int row = of.first - 1; row >= 0; --row) {
      walk.advance();
      put(row, j, walk.value);
    }
  }
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
