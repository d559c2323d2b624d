#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace apsis {

/// A collision in which particles of velocities i and j get velocities k and l, and its inverse. Velocities
/// are numbered from 0.
struct binary_collision {
  int i, j, k, l;
  double rate = 1.0;  ///< A > 0 in the rate A (f_k f_l − f_i f_j) of f_i (dimensionless)
};

/// Elastic collisions of a gas of n velocities v_j (Gatignol, Théorie cinétique des gaz à répartition
/// discrète de vitesses, Lecture Notes in Physics 36, 1975):
///   Q(f) = Σ_c R_c(f) n_c,   R_c = A_c (f_i f_j − f_k f_l),   n_c = e_k + e_l − e_i − e_j.
/// All quantities are dimensionless. Immutable; thread-safe.
class binary_collisions {
 public:
  /// Largest number of velocities.
  static constexpr int most_velocities = 256;

  /// `velocities[j]` are the components of v_j. If `collisions` is empty, all elastic collisions are used,
  /// with the rate 1. Throws input_error in these cases:
  /// - There are no or too many velocities.
  /// - A velocity is not finite, has another number of components than the first, or occurs twice.
  /// - A collision names an unknown velocity, changes nothing, or occurs twice.
  /// - A rate is not a finite number > 0.
  /// - A collision does not conserve momentum and energy, or no collision exists.
  explicit binary_collisions(std::vector<std::vector<double>> velocities,
                             std::vector<binary_collision> collisions = {});

  int size() const { return static_cast<int>(velocities_.size()); }                   ///< n
  int dimensions() const { return static_cast<int>(velocities_.front().size()); }     ///< of the velocities
  const std::vector<std::vector<double>>& velocities() const { return velocities_; }  ///< v_j
  const std::vector<binary_collision>& collisions() const { return collisions_; }     ///< all of them

  /// A sum Σ_j φ_j f_j that collisions conserve.
  struct invariant {
    std::string name;         ///< "mass", "momentum_x", "energy", "spurious_1"
    Eigen::VectorXd weights;  ///< φ_j
  };
  /// Returns a basis of the collision invariants: mass, the components of momentum, and energy, unless they
  /// depend linearly on earlier ones. Spurious invariants follow. A real gas does not have them; they show
  /// that there are too few collisions (Bobylev, Cercignani, J. Stat. Phys. 97, 1999).
  const std::vector<invariant>& invariants() const { return invariants_; }
  /// Returns Σ_j φ_j f_j of all invariants.
  Eigen::VectorXd moments(const double* f) const { return functionals_ * vector(f); }
  /// Returns an orthonormal basis B of the span of all n_c, n × r, r = n − the number of invariants.
  const Eigen::MatrixXd& reachable() const { return reachable_; }

  /// q ← Q(f); both have n numbers.
  void change(const double* f, double* q) const;
  /// result ← Bᵀ Q'(f) B, r × r. `scratch` is reused between calls.
  void derivative(const double* f, Eigen::MatrixXd& scratch, Eigen::MatrixXd& result) const;
  /// Returns max_i Σ_c A_c |f_partner|, the largest collision frequency of a particle. If f ≥ 0 and Δt times
  /// this frequency is at most 1, f + Δt Q(f) ≥ 0.
  double frequency(const double* f) const;

  /// v ← (u + α G(v⁺))/(1 + α L(v⁺)), where Q = G − L f with the gains G and the frequencies L. The solution
  /// of v = u + α Q(v) is a fixed point of this map. For u ≥ 0 the result is nonnegative in floating point. v
  /// is unchanged if α is not finite.
  void gain_over_loss(const double* u, double alpha, double* v) const;

  /// e ← the minimum of Σ e log e among nonnegative rows with the moments Σ_j φ_kj e_j = moments[k] of the
  /// first moments.size() invariants. It has the form exp(Σ_k λ_k φ_k). The error of the moments is a few
  /// roundings of max_j |φ_kj| Σ_j e_j. Zeros of the minimum become positive numbers below rounding. Returns
  /// false if no such row is found.
  bool minimize_entropy(const Eigen::VectorXd& moments, double* e) const;

 private:
  Eigen::Map<const Eigen::VectorXd> vector(const double* f) const { return {f, size()}; }
  void check_velocities() const;
  void check_collision(const binary_collision& one) const;
  void add_elastic_collisions();
  bool elastic(const binary_collision& one) const;
  void compute_invariants();

  std::vector<std::vector<double>> velocities_;
  std::vector<binary_collision> collisions_;
  std::vector<invariant> invariants_;
  Eigen::MatrixXd functionals_;  ///< φ_kj, one row for each invariant
  Eigen::MatrixXd reachable_;    ///< B
  Eigen::MatrixXd projected_;    ///< Bᵀ n_c, one column for each collision
};

}  // namespace apsis
