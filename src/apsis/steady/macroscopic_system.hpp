#pragma once

#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/cell_jacobian.hpp>
#include <apsis/steady/cell_links.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// The linearised moment equations J δω = r of a steady state near equilibrium, ω = ℛf, on the mesh of the
/// kinetic equation. Fluxes are those of ∂E/∂ω by sums over half the velocities with third-order upwind
/// weights, those of the deviation (C/ε)⁻¹ v·∇E by central differences, and those at the ends of the gas
/// what the boundary conditions make of them: slip, temperature jumps and impermeable walls are part of J.
/// No moment of the transport part of the deviation is taken off ("c = 1"): smooth modes change by O(Kn)
/// alone, and the correction stays bounded where the gas is rare.
/// J of first order has upwind weights of first order. Its equations reach half as far, and its factors need
/// less memory.
///
/// Every process differentiates in its own cells; the root holds and solves J. Members that change or solve J
/// are collective.
class macroscopic_system {
 public:
  /// Right-hand sides and changes: [cells of this process][moment_count].
  using moments = std::vector<double>;

  /// All references must outlive the object; `links`: of the cells of this process. J is of first order if
  /// `first_order`, or if the fluxes of T are.
  macroscopic_system(const relaxation_model& equation, const problem_builder& space, const cell_links& links,
                     bool first_order = false);
  ~macroscopic_system();
  macroscopic_system(const macroscopic_system&) = delete;
  macroscopic_system& operator=(const macroscopic_system&) = delete;

  /// Builds J for the moments ω and the collision rates C/ε of all cells; `pseudo_rate`: added
  /// to its diagonal. `holds_neutral`: whether solve() leaves a neutral mode as it is
  /// (internal/neutral_mode.hpp). Returns whether there is one that it leaves. Throws numerical_error with
  /// the cell where ω has no equilibrium, or if J is singular.
  bool build(const moments& omega, const std::vector<double>& rates, double pseudo_rate,
             bool holds_neutral = false);
  /// Whether nothing changes the sum of ω_i over the domain but the initial data. Such a moment adds an
  /// equation to the last build(), its sum, and an unknown, a source of the moment that is the same
  /// everywhere.
  const std::vector<bool>& conserved() const { return conserved_; }
  /// Returns δω with J δω = r and, for moments that are conserved(), Σ δω_i = missing_i over all cells.
  moments solve(const moments& r, const std::vector<double>& missing) const;

  /// Returns the bytes per cell that the root needs for J, for a mesh of so many directions and cells.
  static double bytes_of_cell(int directions, int moments, double cells);

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
