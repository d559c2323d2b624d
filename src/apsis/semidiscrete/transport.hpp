#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/source_rate.hpp>

#include <span>
#include <vector>

namespace apsis {

/// Factor slightly below 1 of every forward Euler step. At the exact limit, the rounding of α u + β T(u)
/// could make a value negative by a few units in the last place.
inline constexpr double rounding_allowance = 1.0 - 1e-14;

/// A function of cells begin … end−1: a reference to a lambda, without allocation. Empty by default.
struct cells_job {
  void (*call)(const void* body, int begin, int end) = nullptr;  ///< calls the lambda; null if empty
  const void* body = nullptr;                                    ///< the lambda, not copied

  /// Returns a job that calls body(begin, end); `body` must outlive the job.
  template <class Body>
  static cells_job of(const Body& body) {
    return {[](const void* b, int begin, int end) { (*static_cast<const Body*>(b))(begin, end); }, &body};
  }
  /// Returns true if the job is not empty.
  explicit operator bool() const { return call != nullptr; }
  /// Calls the lambda; the job must not be empty.
  void operator()(int begin, int end) const { call(body, begin, end); }
};

/// The transport operator T(t, u) = −Σ_k ∂_xk(v_k u) − a·∇_v u + S(t, x, u) of a model on a mesh, with a
/// discretization. In axisymmetric flow it includes the rotation of the velocities. One call evaluates all
/// cells, so that the loops belong to the derived class.
///
/// The object has scratch memory and permits one call at a time. On several processes every member function
/// is collective, except those that return a time step or a growth.
class transport {
 public:
  virtual ~transport() = default;

  /// For each target: acc ← (fresh ? 0 : acc) + α u + β T(t, u). T is evaluated once, or not at all if every
  /// β is 0. If fusion pays, `then` is called with completed cells of all targets while they are in cache,
  /// and the result is true. Otherwise `then` is not called, and the result is false.
  virtual bool add_transport(double t, const field& u, std::span<const target<field, double>> targets,
                             const cells_job& then = {}) const = 0;

  /// sum ← Σ_k α_k u_k with at least one term, added in order; `sum` may be the state of the first term.
  virtual void combine(std::span<const linear_term<field, double>> terms, field& sum) const = 0;

  /// Returns the rates of a boundary_budget: the amounts that u received per unit of time in the last
  /// evaluation of T. They are empty without space.
  virtual std::span<const double> budget_rates() const = 0;

  /// Returns face_fluxes::observed() of the state u at time t; empty without space.
  virtual std::vector<double> observe_surfaces(double t, const field& u) const = 0;

  /// Adds a force. Throws input_error as the constructor of `force` does.
  virtual void set_force(acceleration of) = 0;
  /// Adds the rotation of the velocities in axisymmetric flow; `radial` is the direction of r. Throws
  /// input_error as the constructor of `ring_rotation` does.
  virtual void set_rotation(int radial) = 0;
  /// Adds a source.
  virtual void set_source(source_rate rate) = 0;

  /// Returns Δt_FE of advection, rotation and force: a step within it preserves what the discretization
  /// preserves. Returns +infinity without space.
  virtual double forward_euler_step() const = 0;
  /// Sets the bound of the limiter: β ≤ share α Δt_FE in all later calls, 0 < share ≤ 1 (initially 1). The
  /// limiter then changes less, and preserves the same properties.
  virtual void limit_for_steps(double share) = 0;
  /// Limits for a steady state instead, until the next call of limit_for_steps(). The bound of each component
  /// is limiter::steady_inverse_cfl(), for the slowest rate of collisions at the start. f ≥ 0 holds in a
  /// steady state, and not in steps. Called after all terms have been set. Not in axisymmetric flow.
  virtual void limit_for_steady_states(double collisions) = 0;
  /// Returns the largest source_rate::growth in the cells of this process; 0 if no source depends on u.
  virtual double growth_of_source(double t, const field& u) const = 0;
  /// Returns true if there is a source that depends on u.
  virtual bool source_depends_on_state() const = 0;
};

}  // namespace apsis
