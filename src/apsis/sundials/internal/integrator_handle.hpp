#pragma once

#include "functions.hpp"
#include "nvector_problem.hpp"

#include <apsis/apsis_sundials.h>
#include <apsis/integrate/evolution.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/method/time_integrator.hpp>

#include <atomic>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace apsis::sundials {

/// Limits of the steps.
struct step_limits {
  std::optional<double> dt, first_step;
  double safety = 1.0;
  int growth = 0;  ///< of a graded start; 0 without one
  std::string controller{usual_step_law};
};

/// Events, and times at which steps end.
struct event_settings {
  std::size_t count = 0;
  std::vector<int> directions, ends;  ///< of each function
  std::vector<double> stops;          ///< increasing times
};

/// A problem with the evolution that integrates it.
struct run {
  /// Starts from time and state of an integrator, which must outlive this object. Throws like make_march().
  run(apsis_sundials& s, const step_rule<double>& rule);

  nvector_problem problem;
  evolution<nvector_problem> solution;
};

/// Makes the run of an integrator from its time and state. Throws input_error if settings are missing or
/// contradict each other.
std::unique_ptr<run> make_run(apsis_sundials& s);
/// Returns an integrator that no callback and no other thread uses. Throws input_error if one does.
apsis_sundials& idle(apsis_sundials* integrator);
/// Copies time, state and counts from the run and ends it, because other settings need another one.
void end_run(apsis_sundials& s);

/// Throws input_error unless a vector has as many elements as the state.
void require_length(const apsis_sundials& s, N_Vector y);

}  // namespace apsis::sundials

struct apsis_sundials {
  const apsis::time_integrator* method;
  apsis::sundials::nvector u;  ///< state at the beginning of `running`; the present one without a run
  double t = std::numeric_limits<double>::quiet_NaN();
  std::array<apsis::sundials::nvector, 3> work{};  ///< work vectors of the sums
  apsis::sundials::functions of{};
  apsis::sundials::stage_accuracy accuracy{};
  apsis::sundials::step_limits limits{};
  apsis::sundials::event_settings events{};
  long long steps = 0, rejected = 0;
  long long steps_before_reset = 0;  ///< of a SUNStepper, since it was last reinitialized
  std::vector<apsis::found_event<double>> found{};
  std::unique_ptr<apsis::sundials::run> running{};  ///< of the present settings; made at the next integration
  std::atomic<bool> busy{false};                    ///< whether an integration is in progress
};
