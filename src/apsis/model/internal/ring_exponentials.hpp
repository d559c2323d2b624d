#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/model/maxwellian.hpp>
#include <apsis/velocity/velocity_grid.hpp>

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace apsis::ring_exponentials {

/// Indices of the components along the axis and across it.
struct components {
  explicit components(const velocity_grid& grid)
      : axis(static_cast<std::size_t>(grid.last_component())),
        across{static_cast<std::size_t>(grid.component_across(0)),
               static_cast<std::size_t>(grid.component_across(1))} {}
  std::size_t axis;                   ///< index of v_x
  std::array<std::size_t, 2> across;  ///< indices of v_⊥ cos ω and v_⊥ sin ω
};

/// The parameters λ: β along the axis and in both directions across it, and γ.
using parameters = Eigen::Vector4d;

/// Moments of the weights w e^{λ·ψ} over their sum: means and covariances of ψ = (c_x, c_1, c_2, ½|c|²).
struct dual_sums {
  double log_of_sum = 0.0;                               ///< log Σ w e^{λ·ψ}
  parameters mean = parameters::Zero();                  ///< ⟨ψ⟩
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< ⟨ψψᵀ⟩ − ⟨ψ⟩⟨ψ⟩ᵀ
};

/// Values of e^{λ·ψ} at the velocities of a grid with rings, as factors along the axis and across it. The
/// factors are scaled so that the largest one is 1.
class factors {
 public:
  /// Velocities are relative to the bulk velocity of the state. The grid must outlive the object. A thread
  /// may have one object at a time.
  factors(const velocity_grid& grid, const fluid_state& state);

  /// Returns the sums for λ.
  dual_sums evaluate(const parameters& of);
  /// m ← ρ e^{λ·ψ}/Σ w e^{λ·ψ}, for the λ of the last evaluate().
  void write(double* m);

 private:
  double add_along(const parameters& of, dual_sums& to);
  double add_across(const parameters& of, dual_sums& to);

  const velocity_grid& grid_;
  components at_;
  fluid_state state_;
  aligned_vector<double>&along_, &across_;  ///< memory of this thread
  double sum_along_ = 0.0, sum_across_ = 0.0;
};

}  // namespace apsis::ring_exponentials
