#include <apsis/steady/internal/sparse_factors.hpp>

#include <apsis/core/errors.hpp>

namespace apsis {

void factorize(const Eigen::SparseMatrix<double>& matrix, sparse_factors& to) {
  // Pivots off the diagonal would undo the order; they are taken where that is a hundred times smaller.
  to.isSymmetric(true);
  to.setPivotThreshold(0.01);
  to.compute(matrix);
  if (to.info() != Eigen::Success)
    throw numerical_error("the moment equations of the steady state are singular", {});
}

}  // namespace apsis
