#pragma once

#include <apsis/run/progression.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <cstddef>
#include <optional>

namespace apsis {

/// Iterations of a steady_solver in place of steps. They count as time. Fluxes are those of the last
/// residual; what the gas received since the start is nothing, and defects of conservation are the net rates.
/// Nothing is promised.
class steady_iterations final : public progression {
 public:
  explicit steady_iterations(running_case& run) : run_(run) {}

  void start() override;
  void advance() override;
  /// Throws numerical_error where steady.iterations were not enough.
  void check() override;
  bool finished() const override { return found_; }
  double next_dt() override { return run_.march.next(1.0); }
  long steps_left() override { return run_.march.steps_left(1.0); }
  bool next_step_depends_on_end() override { return false; }
  std::size_t stages_of_step() const override { return 1; }
  void save(run_state& saved) const override;
  void restore(const run_state& saved) override;

 private:
  void record(const steady_iteration& done);
  void set_net_rates();

  running_case& run_;
  std::optional<steady_solver> solver_;
  int damping_ = 0;     ///< of the last iteration
  bool found_ = false;  ///< the steady state
};

}  // namespace apsis
