#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/model/maxwellian.hpp>
#include <apsis/velocity/velocity_grid.hpp>

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace apsis::ring_exponentials {

/// Components along the axis, and the two across it.
struct components {
  explicit components(const velocity_grid& grid)
      : axis(static_cast<std::size_t>(grid.last_component())),
        across{static_cast<std::size_t>(grid.component_across(0)),
               static_cast<std::size_t>(grid.component_across(1))} {}
  std::size_t axis;                   ///< of v_x
  std::array<std::size_t, 2> across;  ///< of v_⊥ cos ω and v_⊥ sin ω
};

/// β along the axis and in both directions across it, and γ.
using parameters = Eigen::Vector4d;

/// Moments of a normalized weight: means of ψ = (c_x, c_1, c_2, ½|c|²) and their covariances.
struct dual_sums {
  double log_of_sum = 0.0;                               ///< log Σ w e^{λ·ψ}
  parameters mean = parameters::Zero();                  ///< ⟨ψ⟩
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< ⟨ψψᵀ⟩ − ⟨ψ⟩⟨ψ⟩ᵀ
};

/// e^{λ·ψ} at the velocities of a grid with rings, as factors along the axis and across it. Their largest
/// exponents are taken out.
class factors {
 public:
  /// The velocities are relative to the bulk velocity of the state. Both must outlive the object. A
  /// thread has one object at a time.
  factors(const velocity_grid& grid, const fluid_state& state);

  /// Returns the sums for λ.
  dual_sums evaluate(const parameters& of);
  /// m ← ρ e^{λ·ψ} over its sum, for the λ of the last evaluate().
  void write(double* m);

 private:
  double add_along(const parameters& of, dual_sums& to);
  double add_across(const parameters& of, dual_sums& to);

  const velocity_grid& grid_;
  components at_;
  fluid_state state_;
  aligned_vector<double>&along_, &across_;  ///< of this thread
  double sum_along_ = 0.0, sum_across_ = 0.0;
};

}  // namespace apsis::ring_exponentials
