#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/cell_links.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsis {

/// Sums, norms and extremes of rows and of moments ω, [cells][moment_count()], over the cells of all
/// processes. All members except moments_of() and scales_of() are collective. Dimensionless.
class cell_measures {
 public:
  /// All references must outlive the object.
  cell_measures(const relaxation_model& equation, const problem_builder& space, const cell_links& links);

  /// to ← ℛu of the cells of this process.
  void moments_of(const field& u, std::vector<double>& to) const;
  /// Returns the scales of the moments of a cell, or their absolute values if the model has other invariants.
  std::vector<double> scales_of(const double* moments) const;

  /// Returns the sum of each moment times the volumes of cells, relative to that of a whole cell.
  std::vector<double> sums(const std::vector<double>& omega) const;
  /// Returns the largest scale of each moment.
  std::vector<double> largest_scales(const std::vector<double>& omega) const;
  /// Returns ‖r‖₂.
  double norm(const field& r) const;
  /// Returns ‖σ f‖₂ with one rate σ for each cell.
  double weighted_norm(const field& f, std::span<const double> rates) const;
  /// Returns the largest change of a moment relative to its scale; infinity for NaN.
  double largest_relative_change(const std::vector<double>& omega, const std::vector<double>& changes) const;
  /// Returns the largest factor ≤ 1 for which `changes` alter the density and energy of no cell by more than
  /// the fraction `most`; 1 for models other than gases.
  double largest_share(const std::vector<double>& omega, const std::vector<double>& changes,
                       double most) const;

  /// Returns true if all cells of a gas keep at least the fraction `share` of their earlier temperature; true
  /// for other models.
  bool keeps_temperature(const std::vector<double>& before, const std::vector<double>& after,
                         double share) const;

  /// Returns the shortest extent of the domain.
  double extent() const;
  /// Returns the lowest √T of the first cells of all processes for a gas, and the largest speed
  /// for other models.
  double thermal_speed(const std::vector<double>& omega) const;
  /// Returns the largest width of a cell relative to the smallest mean free path c/σ,
  /// c = thermal_speed(omega).
  double largest_optical_width(const std::vector<double>& omega, std::span<const double> rates) const;
  /// Returns the mean of one number for each cell.
  double mean(std::span<const double> of_cells) const;

 private:
  template <class Square>
  double root_of_sum(const Square& square_of_cell) const;

  const relaxation_model& equation_;
  const problem_builder& space_;
  const cell_links& links_;
  communicator& processes_;
  std::size_t count_;   ///< number of moments
  std::int64_t cells_;  ///< cells of the gas on all processes
};

}  // namespace apsis
