#pragma once

#include <apsis/method/linear_formula.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/multistage_formula.hpp>

#include <complex>
#include <cstddef>
#include <vector>

namespace apsis {

/// Growth of the solution of u' = λ_T u + λ_Q u in a step. The method treats λ_T u as transport and λ_Q u as
/// collision, with z = Δt λ_T and w = Δt λ_Q ≤ 0. The amplification factors ζ of a method of k steps are the
/// roots of a polynomial of degree k; a method of one step has ζ = R(z, w).
class amplification {
 public:
  /// A method of one step, or the rows of a two-step method (method::steps).
  explicit amplification(const method& m);
  /// A formula of several steps.
  explicit amplification(linear_formula<double> m);
  /// A general linear method: the factors are the eigenvalues of its stability matrix.
  explicit amplification(multistage_formula<double> m);

  /// Whether all |ζ| are below `bound` > 0. Explicit methods treat Q like T: they use z + w.
  bool is_within(double bound, std::complex<double> z, double w) const;

  /// Whether the collision is treated implicitly or exactly, so that every w ≤ 0 is admissible.
  bool is_stiff() const { return kind_ != method_kind::explicit_only; }
  /// Returns all coefficients; they determine the factors.
  std::vector<double> fingerprint() const;

  /// Whether the factors depend on z; those of implicit methods do not.
  bool has_transport() const { return kind_ != method_kind::implicit_only; }

 private:
  using complex = std::complex<double>;
  struct entry {
    std::size_t column;
    double value, transport, collision;  ///< multiples of u_j, z u_j and w u_j
  };
  struct row {
    double initial, d, ddot;
    std::vector<entry> entries;
  };
  void set_rows(const method& m);
  void find_two_steps(complex z, double w) const;
  complex relaxed(const row& r, complex stage, double w) const;
  void set_polynomial_of_stages(complex z, double w) const;

  method_kind kind_;
  int steps_;
  std::vector<row> rows_;                ///< of methods of one and two steps
  linear_formula<double> formula_;       ///< if rows_ is empty and there are no stages
  multistage_formula<double> staged_;    ///< if rows_ is empty and there are stages
  mutable std::vector<complex> stages_;  ///< multiples of u^n
  mutable std::vector<complex> before_;  ///< multiples of u^{n−1}
  mutable std::vector<complex> polynomial_;
};

/// Whether all roots of Σ c_k ζ^k, k = 0 … n, lie in |ζ| < `radius` (recursion of Schur and Cohn: Henrici,
/// Applied and Computational Complex Analysis 1, 1974, section 6.8). Requires c_n ≠ 0.
bool has_roots_within(std::vector<std::complex<double>> c, double radius);

}  // namespace apsis
