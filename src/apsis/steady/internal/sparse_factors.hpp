#pragma once

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace apsis {

/// Factors of a matrix in the order of its unknowns.
using sparse_factors = Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::NaturalOrdering<int>>;

/// Factorizes a matrix whose unknowns have an order of little fill. Throws numerical_error if it is singular.
void factorize(const Eigen::SparseMatrix<double>& matrix, sparse_factors& to);

}  // namespace apsis
