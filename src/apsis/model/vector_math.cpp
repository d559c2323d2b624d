// g++-12 warns inside its own AVX-512 intrinsics when they are inlined (GCC bug 105593).
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"
#endif

#include <apsis/model/vector_math.hpp>

#include <Eigen/Core>

namespace apsis {

void exp_packets(double* x, int n) {
  Eigen::Map<Eigen::ArrayXd, Eigen::Aligned64> array(x, n);
  array = array.exp();
}

void log_packets(double* x, int n) {
  Eigen::Map<Eigen::ArrayXd, Eigen::Aligned64> array(x, n);
  array = array.log();
}

}  // namespace apsis
