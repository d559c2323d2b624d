#pragma once

#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/damping.hpp>
#include <apsis/steady/internal/cell_measures.hpp>
#include <apsis/steady/internal/steady_residual.hpp>
#include <apsis/steady/macroscopic_system.hpp>

#include <utility>
#include <vector>

namespace apsis {

/// Computes the corrections δω of the moments, J δω = ℛT. It also decides when to build J again and when to
/// add a pseudo-time term. The sum of a conserved moment remains that of the first state. All members except
/// flags and rates are collective.
class moment_correction {
 public:
  /// `start` is the residual of the first state. `first_order` is the order of J. All references except
  /// `start` must outlive the object.
  moment_correction(const relaxation_model& equation, const problem_builder& space, const cell_links& links,
                    const cell_measures& cells, const steady_residual& start, bool first_order);

  /// Sets the unit of the pseudo-time term: thermal speed over the extent of the domain.
  void set_flight_rate(double rate) { flight_rate_ = rate; }
  double flight_rate() const { return flight_rate_; }

  /// Records the relative residual of the next iteration. Throws steady_stall if no term helps, and
  /// steady_imbalance if a neutral mode causes the stall.
  void note_residual(double residual);
  /// Computes δω for a state and its relative residual. If δω is too large, a term is added. Throws
  /// numerical_error as macroscopic_system::build() does.
  void find(const steady_residual& of, double residual);

  const std::vector<double>& changes() const { return changes_; }  ///< δω of the last find()
  double size() const { return size_; }                            ///< largest δω_i relative to its scale
  double pseudo_rate() const { return pseudo_rate_; }              ///< pseudo-time term of J
  int strength() const { return damped_.strength(); }              ///< damping::strength()
  /// Returns true if images from before the last find() mislead a mixture, and clears this flag.
  bool takes_new_images() { return std::exchange(has_other_images_, false); }
  /// Returns true if J has an equation for the sum of the first moment.
  bool keeps_first_sum() const { return system_.conserved()[0]; }
  /// Returns the sums of the moments of the first state.
  const std::vector<double>& totals() const { return totals_; }

  /// Begins with another J and a term of this strength (damping::strength()).
  void restart(int strength);

 private:
  void forget_system();
  void solve(const steady_residual& of, double residual);
  void build_system_if_due(const steady_residual& of, double residual);
  bool is_due(const steady_residual& of, double residual) const;
  double change_since_system(const std::vector<double>& omega) const;

  const cell_measures& cells_;
  macroscopic_system system_;
  damping damped_;
  std::vector<double> totals_, changes_, omega_of_system_;
  double size_ = 0.0;
  double flight_rate_ = 0.0, pseudo_rate_ = 0.0;
  double lowest_ = 0.0;                ///< smallest residual since J was built
  bool built_ = false, kept_ = false;  ///< whether J was built, and used more than once
  bool holds_neutral_mode_ = false, seeks_neutral_mode_ = true;
  bool has_other_images_ = false;
};

}  // namespace apsis
