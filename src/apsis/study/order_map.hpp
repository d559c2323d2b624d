#pragma once

#include <apsis/config/case.hpp>
#include <apsis/output/picture.hpp>
#include <apsis/study/study_control.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Effect of halving a step on an error.
enum class order_class {
  design,   ///< at least order p − 0.3
  reduced,  ///< between the two
  plateau,  ///< below order 0.3: the error stalls or grows
  unknown   ///< below the accuracy of the reference
};

/// Errors of a method on a case over ε and Δt, with space discretised once (time_study). They show where the
/// method has its order, and where it is reduced.
struct order_map {
  static constexpr double tolerated_loss = 0.3;  ///< tolerated loss of order, see order_class
  std::string model,                             ///< model.name
      method;                                    ///< time.method
  int order = 0;                                 ///< order p that the method claims
  std::vector<double> epsilon,                   ///< in the order in which they were given
      dt;                                        ///< each half of the previous one
  /// [epsilon][dt], largest difference from the exact solution in time.
  std::vector<std::vector<double>> error;

  /// Returns log2(error(Δt)/error(Δt/2)) for dt[k] and dt[k + 1]; NaN below the accuracy of the reference.
  double slope(std::size_t e, std::size_t k) const;
  /// Returns the class of slope(e, k) for the order of the method.
  order_class kind(std::size_t e, std::size_t k) const;
  /// Returns the smallest slope of the map; +infinity if no slope could be measured.
  double smallest_slope() const;
  /// Returns the mean slope at epsilon[e], from the largest Δt to the last with a measurable error above
  /// `smallest`. Returns NaN if there is no such error.
  double coarse_slope(std::size_t e, double smallest) const;
  /// Returns the mean of the last two measurable slopes at epsilon[e].
  double fine_slope(std::size_t e) const;
  /// Returns the slopes over (Δt, ε) as a map.
  panel map() const;
};

/// Returns the maps of the methods for a case, with end/2^coarsest ≥ Δt ≥ end/2^finest. ε, method and step of
/// the case are not used. Throws the errors of time_study.
std::vector<order_map> measure_order_maps(const case_config& config, const std::vector<std::string>& methods,
                                          const std::vector<double>& epsilons, int coarsest, int finest,
                                          const study_control& control = {});

}  // namespace apsis
