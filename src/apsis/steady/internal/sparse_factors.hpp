#pragma once

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace apsis {

/// LU factors of a matrix in the given order of its unknowns.
template <class Number>
using sparse_factors_of = Eigen::SparseLU<Eigen::SparseMatrix<Number>, Eigen::NaturalOrdering<int>>;

/// Factorizes a matrix with an order of unknowns that causes little fill. Throws numerical_error if the
/// matrix is singular.
template <class Number>
void factorize(const Eigen::SparseMatrix<Number>& matrix, sparse_factors_of<Number>& to);

}  // namespace apsis
