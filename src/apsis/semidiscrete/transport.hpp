#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/acceleration.hpp>
#include <apsis/model/source_rate.hpp>

#include <span>
#include <vector>

namespace apsis {

/// Factor slightly below 1 of every forward Euler step: at the exact limit the rounding of α u + β T(u), a
/// few units in the last place, could make a value negative.
inline constexpr double rounding_allowance = 1.0 - 1e-14;

/// A function of cells begin … end−1, a reference to a lambda that does not allocate; empty by default.
struct cells_job {
  void (*call)(const void* body, int begin, int end) = nullptr;  ///< calls the lambda; null if empty
  const void* body = nullptr;                                    ///< the lambda, not copied

  /// Returns a job that calls body(begin, end); `body` must outlive it.
  template <class Body>
  static cells_job of(const Body& body) {
    return {[](const void* b, int begin, int end) { (*static_cast<const Body*>(b))(begin, end); }, &body};
  }
  /// Whether the job is not empty.
  explicit operator bool() const { return call != nullptr; }
  /// Calls the lambda; the job must not be empty.
  void operator()(int begin, int end) const { call(body, begin, end); }
};

/// The transport operator T(t, u) = −Σ_k ∂_xk(v_k u) − a·∇_v u + S(t, x, u) of a model on a mesh, with a
/// discretization; in axisymmetric flow also the rotation of the velocities. One call evaluates all cells, so
/// that its loops are those of the derived class.
///
/// It has scratch memory: one call at a time. On several processes every member function is collective,
/// except those that return a time step or a growth.
class transport {
 public:
  virtual ~transport() = default;

  /// For each target: acc ← (fresh ? 0 : acc) + α u + β T(t, u), with one evaluation of T, or none if every β
  /// is 0. `then` is called with completed cells of all targets while they are in cache, and true is
  /// returned; where fusion does not pay it is not called, and false is returned.
  virtual bool add_transport(double t, const field& u, std::span<const target<field, double>> targets,
                             const cells_job& then = {}) const = 0;

  /// sum ← Σ_k α_k u_k, one term at least, added in their order; `sum` may be the state of the first term.
  virtual void combine(std::span<const linear_term<field, double>> terms, field& sum) const = 0;

  /// Returns the rates of a boundary_budget: the amounts that u received per unit of time in the last
  /// evaluation of T. Empty without space.
  virtual std::span<const double> budget_rates() const = 0;

  /// Returns face_fluxes::observed() of the state u at time t; nothing without space.
  virtual std::vector<double> observe_surfaces(double t, const field& u) const = 0;

  /// Adds a force. Throws input_error as force does.
  virtual void set_force(acceleration of) = 0;
  /// Adds the rotation of the velocities in axisymmetric flow, where `radial` is the direction of r. Throws
  /// input_error as rotation does.
  virtual void set_rotation(int radial) = 0;
  /// Adds a source.
  virtual void set_source(source_rate rate) = 0;

  /// Returns Δt_FE of advection, rotation and force: a step within it preserves what the discretization
  /// preserves. +infinity without space.
  virtual double forward_euler_step() const = 0;
  /// Tells the limiter that β ≤ share α Δt_FE in all calls to come, 0 < share ≤ 1 (initially 1): it then
  /// changes less, and preserves the same.
  virtual void limit_for_steps(double share) = 0;
  /// Returns the largest source_rate::growth in the cells of this process; 0 without a source that depends on
  /// u.
  virtual double growth_of_source(double t, const field& u) const = 0;
  /// Whether there is a source that depends on u.
  virtual bool source_depends_on_state() const = 0;
};

}  // namespace apsis
