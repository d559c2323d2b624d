#pragma once

#include <apsis/core/index.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/ring_turn.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// A linear map A of rows: a factor for each component, or the rotation of rings at a radius.
struct row_map {
  std::span<const double> factors = {};  ///< factors; not used if there is a rotation
  const ring_turn* turn = nullptr;       ///< rotation
  double radius = 1.0;                   ///< r of the rotation
};

/// The equilibrium E(ω) of one cell and its derivatives ∂E/∂ω_j, as differences of rows, with the matrices of
/// the moment equations. Errors of the differences affect only the speed of the iteration. Matrices have m²
/// numbers, row by row, m = relaxation_model::moment_count().
class tangent_rows {
 public:
  /// `equation` must outlive the object.
  explicit tangent_rows(const relaxation_model& equation);

  /// Moves to other moments. Returns false if there is no equilibrium for ω, or for a moment changed by a
  /// step in either direction.
  bool move_to(const double* omega);

  const double* equilibrium() const { return equilibrium_.data(); }  ///< E(ω)
  /// Returns E(ω + step(j) e_j).
  const double* changed(int j) const { return changed_[at(j)].data(); }
  double step(int j) const { return steps_[at(j)]; }  ///< step of ω_j

  /// matrix ← ℛ A ∂E/∂ω.
  void moments_of(const row_map& map, double* matrix);
  /// matrix ← ℛ B G. G is the deviation that A ∂E/∂ω causes, in units of the mean time between collisions. It
  /// is A ∂E/∂ω itself, with moments s divided by λ if they relax with another rate λ (Chapman & Enskog).
  void moments_of_deviation(const row_map& cause, const row_map& effect, double* matrix);

 private:
  void difference(int j, const row_map& map);
  void apply(const row_map& map);
  void set_relaxation();
  bool set_tail(const std::vector<double>& s, double size);
  bool set_target(const std::vector<double>& s, double size, aligned_vector<double>& row);
  void add_slow_part();

  const relaxation_model& equation_;
  int count_, relaxing_;
  std::vector<double> omega_, scales_, steps_;
  aligned_vector<double> equilibrium_, row_, tail_, target_, unchanged_, turned_;
  ring_turn::workspace turning_;
  std::vector<aligned_vector<double>> changed_;
  std::vector<double> column_;
  // Relaxing moments s: those of the equilibrium and of a row, the sizes of their changes, and 𝒮E_s.
  std::vector<double> s_, s_of_row_, sizes_, response_;
};

}  // namespace apsis
