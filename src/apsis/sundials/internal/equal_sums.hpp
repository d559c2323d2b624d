#pragma once

#include <array>

#include <sundials/sundials_nvector.h>

namespace apsis::sundials {

/// Replaces the scalar product of a vector, and its norms that contain sums, by the functions below. Their
/// results do not depend on how the vector is divided among threads or processes. Vectors cloned from it
/// inherit these functions.
void use_equal_sums(N_Vector v);

/// Returns Σ x_i y_i. The rounded products are divided into parts that are multiples of a power of two. Sums
/// of parts are then exact in any order (S. M. Rump, T. Ogita, S. Oishi, Accurate floating-point summation,
/// SIAM J. Sci. Comput. 31 (2008), 189–224; J. Demmel, H. D. Nguyen, ARITH 21 (2013), 163–172). The remainder
/// is below 2^−53 max |x_i y_i| and omitted. Takes about eight passes over memory. NaN if memory is lacking.
double equal_dot_product(N_Vector x, N_Vector y);
/// Returns √(Σ (x_i w_i)²/n), summed in the same way.
double equal_wrms_norm(N_Vector x, N_Vector w);
/// Returns √(Σ (x_i w_i)²), summed in the same way.
double equal_wl2_norm(N_Vector x, N_Vector w);

/// While an object of this class exists, the sums of its thread use its work vectors instead of allocating
/// vectors for each sum.
class sums_without_allocation {
 public:
  /// Stores three vectors. They must outlive this object, and nothing else may use them.
  explicit sums_without_allocation(const std::array<N_Vector, 3>& work);
  ~sums_without_allocation();
  sums_without_allocation(const sums_without_allocation&) = delete;
  sums_without_allocation& operator=(const sums_without_allocation&) = delete;

 private:
  std::array<N_Vector, 3> before_;
};

}  // namespace apsis::sundials
