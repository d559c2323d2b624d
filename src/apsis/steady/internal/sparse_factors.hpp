#pragma once

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace apsis {

/// Factors of a matrix in the order of its unknowns.
template <class Number>
using sparse_factors_of = Eigen::SparseLU<Eigen::SparseMatrix<Number>, Eigen::NaturalOrdering<int>>;

/// Factorizes a matrix whose unknowns have an order of little fill. Throws numerical_error if it is singular.
template <class Number>
void factorize(const Eigen::SparseMatrix<Number>& matrix, sparse_factors_of<Number>& to);

}  // namespace apsis
