#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/source_rate.hpp>
#include <apsis/steady/cell_links.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace apsis {

class tangent_rows;

/// The linearised moment equations J δω = r of a steady state near equilibrium, ω = ℛf, on the mesh of the
/// kinetic equation. Fluxes are those of ∂E/∂ω by sums over half the velocities with third-order upwind
/// weights, those of the deviation (C/ε)⁻¹ v·∇E by central differences, and those at the ends of the gas
/// what the boundary conditions make of them: slip, temperature jumps and impermeable walls are part of J.
/// No moment of the transport part of the deviation is taken off ("c = 1"): smooth modes change by O(Kn)
/// alone, and the correction stays bounded where the gas is rare.
class macroscopic_system {
 public:
  /// Right-hand sides and changes: [cells][moment_count].
  using moments = std::vector<double>;

  /// Force and source inside the domain, beside those of the model.
  struct inside {
    std::optional<acceleration> force = {};  ///< of a gas
    std::optional<source_rate> source = {};  ///< of any model
  };

  /// `equation`, `space` and `links` must outlive the object.
  macroscopic_system(const relaxation_model& equation, const domain& space, const cell_links& links,
                     inside acts, bool first_order);
  ~macroscopic_system();
  macroscopic_system(const macroscopic_system&) = delete;
  macroscopic_system& operator=(const macroscopic_system&) = delete;

  /// Builds and factorizes J for the moments ω and the collision rates C/ε of all cells; `pseudo_rate`: added
  /// to its diagonal. Throws numerical_error with the cell where ω has no equilibrium, or if J is singular.
  void build(const moments& omega, const std::vector<double>& rates, double pseudo_rate);
  /// Whether nothing changes the sum of ω_i over the domain but the initial data. Such a moment adds an
  /// equation to the last build(), its sum, and an unknown, a source of the moment that is the same
  /// everywhere.
  const std::vector<bool>& conserved() const { return conserved_; }
  /// Returns δω with J δω = r and, for moments that are conserved(), Σ δω_i = missing_i over all cells.
  moments solve(const moments& r, const std::vector<double>& missing) const;

 private:
  struct matrices;
  struct assembly;
  void add_faces(assembly& to, int direction) const;
  void add_forces(assembly& to) const;
  bool has_source_of_state() const;
  void differentiate_source(int cell, tangent_rows& tangents, double* matrix) const;
  void add_constraints(assembly& to);

  const relaxation_model& equation_;
  const domain& space_;
  const cell_links& links_;
  inside acts_;
  bool first_order_;
  int count_;
  std::vector<int> number_;  ///< of a cell among those of the gas
  std::vector<bool> conserved_;
  std::unique_ptr<matrices> matrices_;
};

}  // namespace apsis
