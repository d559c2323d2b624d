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

/// A gas on a velocity grid of d dimensions whose molecules have D ≥ d degrees of freedom, by Chu's reduction
/// (Chu, Phys. Fluids 8, 1965): a row is (g, h), g = ∫f and h = ∫|η|² f over the D − d components η that the
/// grid does not resolve; for D = d it is f alone. Moments ω = (ρ, ρu, 𝓔) with 𝓔 = ½ Σ(|v|² g + h) Δv^d and
/// T = (2𝓔/ρ − |u|²)/D. The equilibrium is g = M[ρ, u, T] in d dimensions and h = (D − d) T g. Dimensionless.
class gas {
 public:
  /// Takes `velocity_dimensions`, `degrees_of_freedom` (0: as many) and the velocity grid of the
  /// configuration. Throws input_error if D < d, or as velocity_grid does.
  explicit gas(const model_config& config);

  /// Returns the parameters that every gas has.
  static std::vector<model_parameter> parameters();

  const velocity_grid& grid() const { return grid_; }             ///< the velocity grid
  const velocity_set& velocities() const { return velocities_; }  ///< its points, with one or two sets
  int dimensions() const { return grid_.dimensions(); }           ///< d
  int degrees_of_freedom() const { return degrees_; }             ///< D
  bool reduced() const { return degrees_ > grid_.dimensions(); }  ///< whether rows are (g, h)
  int moment_count() const { return grid_.dimensions() + 2; }     ///< length of ω
  equilibrium_choice choice() const { return choice_; }           ///< which equilibria are formulas

  /// ω ← the moments of rows, `pitch` numbers apart.
  void moments(const double* row, std::ptrdiff_t pitch, int rows, double* omega) const;
  /// Returns density, bulk velocity and temperature of ω without checking that they are admissible.
  fluid_state state(const double* omega) const;
  /// row ← the equilibrium of ω. Returns false without one on the grid, which moments of rows f ≥ 0 have
  /// always.
  bool equilibrium(const double* omega, double* row) const;
  /// equilibrium() with its moments, which may stay unknown.
  bool equilibrium(const double* omega, double* row, line_moments& of_row) const;
  /// equilibrium() of several rows, `pitch` apart; returns the number of rows before the first without one.
  int equilibria(const double* omega, int rows, double* row, std::ptrdiff_t pitch) const;
  /// Returns why ω has no equilibrium, for messages.
  std::string why_inadmissible(const double* omega) const;
  /// row ← `weight` times the Maxwellian of a state by its formula.
  void formula(const fluid_state& state, double weight, double* row) const;
  /// h ← energy · g in a row (g, h).
  void fill_h(double energy, double* row) const;
  /// Returns Σ_j [g log g + ½(D − d) g log(g/h)] Δv^d with 0 log 0 = 0, convex in (g, h) and minimal in
  /// equilibrium; for D = d it is Σ f log f Δv^d.
  double entropy(const double* row) const;
  /// Returns the operation count of moments and equilibrium per component.
  double operations() const;

  /// Returns why the grid does not support a row of data, by the rule of velocity_support.hpp.
  unsupported_initial_data check_supported(const double* row) const;
  /// Returns the equilibrium of (ρ, u, T) as data of a case. This object must outlive it.
  data_form maxwellian_form() const;
  /// Returns f, or g and h of a reduced gas, as functions of the velocity. This object must outlive it.
  data_form distribution_form() const;

 private:
  static constexpr int most_moments = 5;
  /// of_g ← ω of g alone in the equilibrium of ω; returns h/g, NaN for T < 0.
  double moments_of_g(const double* omega, double* of_g) const;
  bool equilibrium_of_g(const double* of_g, double* g, line_moments* of_row = nullptr) const;
  int equilibria_of_g(const double* of_g, int rows, double* g, std::ptrdiff_t pitch) const;
  template <class State>
  bool keeps_formula(const State& state) const;
  std::string row_of(std::span<const double> given, std::span<double> row) const;

  velocity_grid grid_;
  int degrees_;
  equilibrium_choice choice_;
  velocity_set velocities_;
};

}  // namespace apsis
