#pragma once

#include <apsis/exec/profile.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/run/setup.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis::bench {

/// Steps of the paper's mixed-regime problem (data V, 150 velocities) without any looking at them.
class mixed_step {
 public:
  /// `overrides` are further keys of the case, "key=value".
  mixed_step(const std::string& formulation, const std::string& method, int cells,
             std::vector<std::string> overrides = {});

  void take(int steps) {
    for (int k = 0; k < steps; ++k) stepper_.step(0.0, dt_, u_);
  }
  /// Operations and bytes of one step, counted while one is done.
  work count_work();
  /// Fraction of the values that are subnormal numbers.
  double subnormal_share() const;
  /// Point·stages of a step: N · N_v · s.
  double point_stages() const;
  /// Numbers of one field, padding included.
  std::size_t numbers() const {
    return static_cast<std::size_t>(u_.cells()) * static_cast<std::size_t>(u_.stride());
  }
  /// How often a step passes over the field, all threads waiting for each other after each time.
  int passes() const;
  /// So many steps take about this long.
  int steps_in(double seconds);

 private:
  run_setup setup_;
  std::unique_ptr<semidiscrete_problem> problem_;
  stepper<semidiscrete_problem> stepper_;
  field u_;
  bool solves_in_passing_;  ///< point values: as soon as they are complete, in the pass that makes them
  double dt_;
};

}  // namespace apsis::bench
