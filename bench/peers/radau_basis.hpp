#pragma once

#include "radau_steps.hpp"

#include <complex>

#include <Eigen/Eigenvalues>

namespace apsis::bench::peers {

/// The eigenvalues of the weights A of Radau IIA, one of them real and two a conjugate pair. In the basis of
/// the eigenvectors the stages of a Newton step decouple into a real system and a complex one.
struct radau_basis {
  using number = std::complex<double>;
  int real = 0, pair = 0;             ///< places of the real eigenvalue and of one of the pair
  Eigen::Vector3cd values;            ///< eigenvalues of A
  Eigen::Matrix3cd vectors, inverse;  ///< eigenvectors, and the inverse of their matrix

  double real_value() const { return values[real].real(); }
  number pair_value() const { return values[pair]; }

  static const radau_basis& get() {
    static const radau_basis made = make();
    return made;
  }

  /// Returns (I − h A⊗J)⁻¹ D, with solve_real(v) = (I − hγJ)⁻¹ v for the real eigenvalue γ and
  /// solve_pair(v) the same for that of the pair.
  template <class Stages, class SolveReal, class SolvePair>
  Stages solve(const Stages& defect, const SolveReal& solve_real, const SolvePair& solve_pair) const {
    const Eigen::Matrix<number, Eigen::Dynamic, 3> right =
        defect.template cast<number>() * inverse.transpose();
    const Eigen::VectorXd of_real = solve_real(Eigen::VectorXd(right.col(real).real()));
    const Eigen::VectorXcd of_pair = solve_pair(Eigen::VectorXcd(right.col(pair)));
    const Eigen::Matrix<number, Eigen::Dynamic, 3> sum =
        of_real.cast<number>() * vectors.col(real).transpose() +
        2.0 * of_pair * vectors.col(pair).transpose();
    return sum.real();
  }

 private:
  static radau_basis make() {
    const Eigen::EigenSolver<Eigen::Matrix3d> of_weights(radau_tableau::get().weights);
    radau_basis made;
    for (int i = 0; i < 3; ++i) {
      if (of_weights.eigenvalues()[i].imag() == 0.0) made.real = i;
      if (of_weights.eigenvalues()[i].imag() > 0.0) made.pair = i;
    }
    made.values = of_weights.eigenvalues();
    made.vectors = of_weights.eigenvectors();
    made.inverse = made.vectors.inverse();
    return made;
  }
};

}  // namespace apsis::bench::peers
