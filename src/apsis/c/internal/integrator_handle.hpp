#pragma once

#include "callbacks.hpp"

#include <apsis/apsis.h>
#include <apsis/integrate/events.hpp>
#include <apsis/method/step_law.hpp>
#include <apsis/method/time_integrator.hpp>

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace apsis::c {

using numbers = std::vector<double>;

/// Limits of the steps.
struct step_limits {
  std::optional<double> dt, first_step;
  double safety = 1.0, relative = 0.0;
  numbers absolute;  ///< of each unknown; empty without a tolerance
  int growth = 0;    ///< of a graded start; 0 without one
  std::string controller{usual_step_law};
};

/// Events, and times at which steps end.
struct event_settings {
  std::size_t count = 0;
  std::vector<int> directions, ends;  ///< of each function
  numbers stops;                      ///< increasing times
};

/// A problem with the evolution that integrates it.
class any_run {
 public:
  /// Like evolution::observer.
  using observer = std::function<bool(long step, double t, double dt, const numbers& u)>;
  virtual ~any_run() = default;
  /// Calls evolution::advance() and returns its apsis_status.
  virtual int advance(double t1, const observer& observe) = 0;
  virtual numbers at(double t) = 0;
  virtual double t() const = 0;
  virtual const numbers& u() const = 0;
  virtual long steps() const = 0;
  virtual long rejected() const = 0;
  virtual const std::vector<found_event<double>>& found() const = 0;
};

/// Makes the run of a problem from time and state; `fresh` states that no step precedes. Throws input_error
/// if settings are missing or contradict each other.
std::unique_ptr<any_run> make_run(const time_integrator& m, callbacks& of, const step_limits& limits,
                                  const event_settings& events, double t, const numbers& u, bool fresh);

}  // namespace apsis::c

struct apsis_integrator {
  const apsis::time_integrator* method;
  std::size_t n;
  apsis::c::callbacks of{};
  apsis::c::step_limits limits{};
  apsis::c::event_settings events{};
  bool started = false;
  /// Time, state and counts at the beginning of `run`; the present ones without a run.
  double t = std::numeric_limits<double>::quiet_NaN();
  apsis::c::numbers u{};
  long long steps = 0, rejected = 0;
  std::vector<apsis::found_event<double>> found{};
  std::unique_ptr<apsis::c::any_run> run{};  ///< of the present settings; made at the next integration
  std::atomic<bool> busy{false};             ///< whether an integration is in progress
};
