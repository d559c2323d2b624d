#pragma once

#include <apsis/model/data_form.hpp>
#include <apsis/model/maxwellian.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/model_registry.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A gas on a velocity grid of d dimensions whose molecules have D ≥ d degrees of freedom. For D = d a row is
/// f. For D > d a row is (g, h) by Chu's reduction (Chu, Phys. Fluids 8, 1965). Here g = ∫f and h = ∫|η|² f
/// are integrals over the D − d components η that the grid does not resolve.
///
/// Moments are ω = (ρ, ρu, 𝓔) with 𝓔 = ½ Σ(|v|² g + h) Δv^d and T = (2𝓔/ρ − |u|²)/D. The equilibrium is g =
/// M[ρ, u, T] in d dimensions and h = (D − d) T g. Dimensionless.
class gas {
 public:
  /// Makes the velocity grid of the configuration, with d = `velocity_dimensions` (0: as many as space
  /// dimensions) and D = `degrees_of_freedom` (0: D = d). Throws input_error if D < d, if d is below the
  /// number of space dimensions, or if the grid is invalid.
  explicit gas(const model_config& config);

  /// Returns the parameters that every gas has.
  static std::vector<model_parameter> parameters();

  const velocity_grid& grid() const { return grid_; }             ///< the velocity grid
  const velocity_set& velocities() const { return velocities_; }  ///< points of the grid, with one set or two
  int dimensions() const { return grid_.dimensions(); }           ///< d
  int degrees_of_freedom() const { return degrees_; }             ///< D
  bool reduced() const { return degrees_ > grid_.dimensions(); }  ///< whether rows are (g, h)
  int moment_count() const { return grid_.dimensions() + 2; }     ///< length of ω
  equilibrium_choice choice() const { return choice_; }           ///< how equilibria are computed

  /// omega ← the moments ω of `rows` rows, which lie `pitch` numbers apart.
  void moments(const double* row, std::ptrdiff_t pitch, int rows, double* omega) const;
  /// Returns density, bulk velocity and temperature of ω without checking that they are admissible.
  fluid_state state(const double* omega) const;
  /// row ← the equilibrium of ω. Returns false if the grid has none. Moments of a row f ≥ 0 always have one.
  bool equilibrium(const double* omega, double* row) const;
  /// Computes the equilibrium and its central moments `of_row`, which may stay unknown (line_moments::known).
  bool equilibrium(const double* omega, double* row, line_moments& of_row) const;
  /// Computes the equilibria of several ω into rows that lie `pitch` numbers apart. Returns the number of
  /// rows before the first ω without an equilibrium.
  int equilibria(const double* omega, int rows, double* row, std::ptrdiff_t pitch) const;
  /// Returns why ω has no equilibrium, for messages.
  std::string why_inadmissible(const double* omega) const;
  /// row ← `weight` times the Maxwellian of a state by its formula, not the discrete Maxwellian.
  void formula(const fluid_state& state, double weight, double* row) const;
  /// Sets h = energy · g in a row (g, h).
  void fill_h(double energy, double* row) const;
  /// Returns Σ_j [g log g + ½(D − d) g log(g/h)] Δv^d with 0 log 0 = 0, convex in (g, h) and minimal in
  /// equilibrium; for D = d it is Σ f log f Δv^d.
  double entropy(const double* row) const;
  /// Returns the operation count of moments and equilibrium per component.
  double operations() const;

  /// Returns why the grid does not support a row of data, by the rule of velocity_support.hpp.
  unsupported_initial_data check_supported(const double* row) const;
  /// Returns the form of data that prescribes the equilibrium of (ρ, u, T). This object must outlive it.
  data_form maxwellian_form() const;
  /// Returns the form of data that prescribes f, or g and h of a reduced gas, as functions of the velocity.
  /// This object must outlive it.
  data_form distribution_form() const;

 private:
  static constexpr int most_moments = 5;
  /// of_g ← the moments of g alone in the equilibrium of ω. Returns h/g; NaN for T < 0.
  double moments_of_g(const double* omega, double* of_g) const;
  bool equilibrium_of_g(const double* of_g, double* g, line_moments* of_row = nullptr) const;
  int equilibria_of_g(const double* of_g, int rows, double* g, std::ptrdiff_t pitch) const;
  int equilibria_on_line(const double* of_g, int rows, double* g, std::ptrdiff_t pitch) const;
  template <class State>
  bool keeps_formula(const State& state) const;
  std::string row_of(std::span<const double> given, std::span<double> row) const;

  velocity_grid grid_;
  int degrees_;
  equilibrium_choice choice_;
  velocity_set velocities_;
};

}  // namespace apsis
