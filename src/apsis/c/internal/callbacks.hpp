#pragma once

#include "guarded.hpp"
#include "observing_thread.hpp"

#include <apsis/apsis.h>
#include <apsis/core/errors.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>
#include <apsis/integrate/stage_preconditioner.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace apsis::c {

/// The functions of a program, and how often they were called.
struct callbacks {
  void* data = nullptr;
  std::size_t block_size = 0, dense_limit = 96;
  apsis_transport_function* transport = nullptr;
  apsis_stage_function* stage = nullptr;
  apsis_flow_function* flow = nullptr;
  apsis_rate_function* rate = nullptr;
  apsis_timed_rate_function* timed_rate = nullptr;
  apsis_jacobian_function* jacobian = nullptr;
  apsis_product_function* product = nullptr;
  apsis_timed_product_function* timed_product = nullptr;
  apsis_curvature_function* curvature = nullptr;
  apsis_prepare_function* prepare = nullptr;
  apsis_precondition_function* precondition = nullptr;
  apsis_time_function* forward_euler_step = nullptr;
  apsis_time_function* relaxation_time = nullptr;
  apsis_admissible_function* admissible = nullptr;
  apsis_observer_function* observer = nullptr;
  apsis_event_function* events = nullptr;
  apsis_event_observer_function* event_observer = nullptr;
  std::optional<sparsity_pattern> pattern{};  ///< of the Jacobian of a block
  std::optional<mass_matrix<double>> mass{};  ///< of a block
  observing_thread observing{};
  std::array<long long, APSIS_PRECONDITIONER_SOLVES + 1> counts{};
  long long preparation = 0;  ///< number of the last preparation, for which solves are ready

  void count(apsis_counter which, long long more = 1) { counts[static_cast<std::size_t>(which)] += more; }

  /// out ← T(t, u); 0 without transport. Throws numerical_error if T is not finite.
  void evaluate_transport(double t, const std::vector<double>& u, std::vector<double>& out);
  /// out ← Q(t, u), block by block; 0 without a rate. Throws numerical_error if Q is not finite.
  void evaluate_rate(double t, const std::vector<double>& u, std::vector<double>& out);
  /// Sets q ← Q(t, u) of one block; 0 without a rate. Newton's method may only try this state and abandon it.
  void evaluate_block(double t, std::size_t block, std::span<const double> u, std::span<double> q);
  /// Whether there is a rate, of u or of t and u.
  bool has_rate() const { return rate != nullptr || timed_rate != nullptr; }
  /// Whether there is a function for derivatives of Q.
  bool has_derivatives() const {
    return jacobian != nullptr || product != nullptr || timed_product != nullptr;
  }
  /// Whether derivatives of Q are differences of the rate.
  bool is_differenced() const { return has_rate() && !has_derivatives(); }
  /// Returns a solver of (M − γQ'(t, u)) x = r for a block. It calls `prepare` if another one was used last.
  shifted_solve<double> solver_of(std::size_t block, double t, std::span<const double> u, double gamma);
  /// Whether a block is admissible.
  bool is_admissible(std::size_t block, std::span<const double> u) const;
  /// Returns the first block that is not admissible; nothing if all are.
  std::optional<std::size_t> first_inadmissible(const std::vector<double>& u) const;
  /// Throws numerical_error unless all blocks of a stage are admissible and finite.
  void require_valid(const std::vector<double>& u) const;
  /// Returns the result of a time_function; +infinity without one.
  double time_of(apsis_time_function* function, const char* name, double t,
                 const std::vector<double>& u) const;
};

}  // namespace apsis::c
