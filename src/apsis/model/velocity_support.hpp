#pragma once

#include <apsis/model/gas.hpp>
#include <apsis/model/gas_scales.hpp>
#include <apsis/model/model.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Limits of velocity_fit::missed. They apply to data, walls, sources and states during a
/// run (docs/velocities.md).
namespace velocity_limits {
inline constexpr double good = 1e-3,  ///< up to this limit nothing is reported
    bad = 0.1;                        ///< beyond this limit data are refused and a run ends
}  // namespace velocity_limits

/// The part of a Maxwellian that discrete velocities miss. Let G be the Gaussian of mean u and variance T
/// along a direction, and c = (v − u)/√T. Sums over the velocities miss |Σ w G − 1|, |Σ w c G| and |Σ w c² G
/// − 1|.
struct velocity_fit {
  double missed = 0.0;  ///< the largest of the three over all directions
  double beyond = 0.0;  ///< largest share over all directions of mass beyond the velocities
  int direction = 0;    ///< direction with the largest `missed`
  bool ends = false;    ///< whether at least half of `missed` is energy beyond the ends, and not an error of
                        ///< the spacing
};

/// Squares of the two ratios that decide how well velocities represent a Maxwellian; smaller is worse.
struct velocity_margins {
  double room,     ///< smallest (distance from u_k to an end of the velocities)²/T
      resolution;  ///< smallest T/Δv², Δv the spacing at u_k
};

/// Measures how well the velocities of a gas represent Maxwellians. A line of velocities ends half a weight
/// beyond its last points, which is ±max on a uniform line.
class velocity_support {
 public:
  /// Takes a gas, which must outlive the object.
  explicit velocity_support(const gas& of);

  /// Returns the part of the Maxwellian of an admissible state that the velocities miss.
  velocity_fit fit(const fluid_state& state) const;
  /// Returns fit() for the moments ω and stores their state in `state`; nothing if the state is
  /// not admissible.
  std::optional<velocity_fit> fit_of_moments(const double* omega, fluid_state& state) const;
  /// Returns the margins of the moments ω, in a few operations; infinite if ρ ≤ 0 or T ≤ 0.
  velocity_margins margins(const double* omega) const;
  static constexpr double safe_room = 6.0,  ///< distance to an end, in thermal speeds √T
      safe_resolution = 1.0;                ///< thermal speeds √T per spacing
  /// Returns true if both margins are finite and at least the squares of safe_room and safe_resolution.
  /// Uniform velocities then miss less than 3e-7, other sets less than velocity_limits::good.
  static bool is_safe(const velocity_margins& of);
  const gas& molecules() const { return gas_; }  ///< the gas

 private:
  /// The velocities of a direction.
  struct line {
    double lower, upper;       ///< ends
    double first, per_gap;     ///< velocity of the first entry of `gaps`, and entries per unit of velocity
    std::vector<double> gaps;  ///< squares of the spacing; a single entry for a uniform line

    /// Divides `length`, from the first velocity on, into equal parts. Sets `gaps` to the squares of
    /// gap(left, right) of the parts.
    template <class Gap>
    void set_gaps(int entries, double length, const Gap& gap) {
      per_gap = entries / length;
      gaps.clear();
      for (int j = 0; j < entries; ++j) {
        const double left = first + j / per_gap, widest = gap(left, left + 1.0 / per_gap);
        gaps.push_back(widest * widest);
      }
    }
  };
  static line line_of(const velocity_line& from);
  static line line_of(const polar_layout& rings);
  bool is_across(int direction) const;
  double missed_along(int direction, const fluid_state& state) const;
  /// Returns the square of the widest spacing at u and at u ± 2 √T.
  static double gap_square(const line& of, double u, double T);

  const gas& gas_;
  std::vector<line> lines_;
};

/// Returns the support of the velocities of a gas; nothing for models other than gases.
std::optional<velocity_support> support_of(const model& equation);

/// Parts of a message about velocities.
struct velocity_words {
  std::string subject;                 ///< "the data"
  const gas_scales* scales = nullptr;  ///< if given, the message adds values in SI units
  bool from_file = false;              ///< whether the case gives the velocities, not velocity.max
  double needed = 0.0;                 ///< sufficient largest velocity, if more than the state needs
};
/// Returns the key that must change, and a message with the problem and a sufficient value.
unsupported_initial_data velocity_problem(const gas& of, const fluid_state& state, const velocity_fit& fit,
                                          const velocity_words& words);

/// Returns the largest velocity that a Maxwellian needs along a direction, |u| + 6 √T. A fraction of 1e-7 of
/// its energy lies beyond it.
double velocity_needed(double u, double T);

/// Returns the reason, for messages, if moments have no equilibrium because the bulk velocity of a gas has
/// reached an end of its velocities. Returns "" otherwise.
std::string why_beyond_velocities(const model& equation, const double* omega);

}  // namespace apsis
