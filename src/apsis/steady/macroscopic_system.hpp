#pragma once

#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/cell_jacobian.hpp>
#include <apsis/steady/cell_links.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// The linearised moment equations J δω = r of a steady state near equilibrium, ω = ℛf, on the mesh of
/// the kinetic equation.
/// - Fluxes of ∂E/∂ω are sums over half of the velocities with third-order upwind weights.
/// - Fluxes of the deviation (C/ε)⁻¹ v·∇E are central differences.
/// - The boundary conditions determine the fluxes at the ends of the gas. J therefore includes slip,
///   temperature jumps and impermeable walls.
///
/// No moment of the transport part of the deviation is subtracted ("c = 1"). Smooth modes thus change only by
/// O(Kn), and the correction stays bounded in a rare gas. J of first order has upwind weights of first order.
/// Its equations reach half as far, and its factors need less memory.
///
/// Every process differentiates in its own cells. The root stores and solves J. Members that change or solve
/// J are collective.
class macroscopic_system {
 public:
  /// Right-hand sides and changes, [cells of this process][moment_count].
  using moments = std::vector<double>;

  /// All references must outlive the object. `links` are those of the cells of this process. J is of first
  /// order if `first_order`, or if the fluxes of T are.
  macroscopic_system(const relaxation_model& equation, const problem_builder& space, const cell_links& links,
                     bool first_order = false);
  ~macroscopic_system();
  macroscopic_system(const macroscopic_system&) = delete;
  macroscopic_system& operator=(const macroscopic_system&) = delete;

  /// Builds J for the moments ω and the collision rates C/ε of all cells, with `pseudo_rate` added to its
  /// diagonal. If `holds_neutral`, solve() does not change a neutral mode (internal/neutral_mode.hpp).
  /// Returns true if there is such a mode. Throws numerical_error with the cell if ω has no equilibrium, or
  /// if J is singular.
  bool build(const moments& omega, const std::vector<double>& rates, double pseudo_rate,
             bool holds_neutral = false);
  /// Returns for every moment ω_i whether only the initial data determine its sum over the domain. For such a
  /// moment the last build() added an equation, its sum, and an unknown. This unknown is a source of the
  /// moment that is constant in space.
  const std::vector<bool>& conserved() const { return conserved_; }
  /// Returns δω with J δω = r and, for moments that are conserved(), Σ δω_i = missing_i over all cells.
  moments solve(const moments& r, const std::vector<double>& missing) const;

  /// Returns the bytes per cell that the root needs for J, for a mesh of this many directions and cells, with
  /// or without a rotation.
  static double bytes_of_cell(int directions, int moments, double cells, bool turns);

 private:
  class whole_system;

  const problem_builder& space_;
  inside_domain acts_;
  cut_links cut_;
  cell_jacobian jacobian_;
  int count_;
  std::vector<bool> conserved_;
  std::unique_ptr<whole_system> whole_;  ///< on the root
};

}  // namespace apsis
