#include <apsis/steady/internal/sparse_factors.hpp>

#include <apsis/core/errors.hpp>

namespace apsis {

template <class Number>
void factorize(const Eigen::SparseMatrix<Number>& matrix, sparse_factors_of<Number>& to) {
  // Pivots off the diagonal would undo the order. They are used only if the diagonal entry is
  // 100 times smaller.
  to.isSymmetric(true);
  to.setPivotThreshold(Number{0.01F});
  to.compute(matrix);
  if (to.info() != Eigen::Success)
    throw numerical_error("the moment equations of the steady state are singular", {});
}

template void factorize(const Eigen::SparseMatrix<double>& matrix, sparse_factors_of<double>& to);
template void factorize(const Eigen::SparseMatrix<float>& matrix, sparse_factors_of<float>& to);

}  // namespace apsis
