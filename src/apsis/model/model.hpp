#pragma once

#include <apsis/model/point_collision.hpp>
#include <apsis/phase/position.hpp>
#include <apsis/phase/velocity_set.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A macroscopic quantity that is written to results: its name and its label for plots.
struct field_name {
  std::string name;   ///< "rho"
  std::string label;  ///< "density (dimensionless)"
};

/// Initial data, and the exact solution that grows out of them where a formula for it is known.
struct initial_data {
  std::string name;         ///< value of the key model.initial
  std::string description;  ///< one line with the formula
  /// u ← all components at x; at a jump, those of the side of larger coordinates.
  std::function<void(const position& x, std::span<double> u)> point_value;
  /// u ← the solution at t and x, which is smooth; empty if no formula is known.
  std::function<void(double t, const position& x, std::span<double> u)> exact = {};
  std::vector<double> jumps = {};  ///< where data on a line are discontinuous, in increasing order
};

/// Data that a model cannot hold.
struct unsupported_initial_data {
  std::string key,  ///< of the case, that must change; "" if all is well
      problem;      ///< message; "" if all is well
};

/// An equation u_t + Σ_k ∂_xk(v_k u) = S(u) + Q(u)/ε, seen at one point of space: it knows no mesh and no
/// time. A row u holds components() values; all quantities are dimensionless.
class model {
 public:
  virtual ~model() = default;

  /// Numbers of a row, N.
  virtual int components() const = 0;
  /// 0 for an ordinary differential equation.
  virtual int space_dimensions() const = 0;
  /// The velocities that transport the components; none without space.
  virtual const velocity_set& velocities() const;
  /// Transport speed of every component along a direction; empty without space.
  std::span<const double> speeds(int direction) const { return velocities().speeds(direction); }
  /// v of the CFL number v Δt/Δx along a direction: the largest |speed| where a model says nothing else; 0
  /// without space.
  virtual double reference_speed(int direction) const;

  /// Whether S(u) is not 0 everywhere.
  virtual bool has_source() const { return false; }
  /// s ← S(u), the explicit local source, part of the operator T. Where there is none: 0.
  virtual void source(const double* u, double* s) const;

  /// The solver of collisions at points, with scratch memory for one thread and batches within `limits`. The
  /// model must outlive it.
  virtual std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const = 0;
  /// Whether make_collision() knows the relaxation time ε/C.
  virtual bool has_relaxation_time() const { return false; }

  /// Whether negative components have no meaning (then positivity can be promised).
  virtual bool positive() const { return false; }
  /// Whether entropy() has a meaning.
  virtual bool has_entropy() const { return false; }
  /// Convex entropy density of a nonnegative row, whose sum over all cells decays under upwind transport and
  /// collision. Where there is none: NaN.
  virtual double entropy(const double* u) const;

  /// Names of quantities that collisions and periodic transport conserve, linear in u; may be none.
  virtual std::vector<std::string> invariants() const = 0;
  /// How much of each a row has per volume, in the order of invariants().
  virtual void invariant_densities(const double* u, double* densities) const = 0;
  /// The size of what is added up in each of them, against which its rounding is small: |densities| where
  /// a model says nothing else. A momentum may be zero because as much flies one way as the other.
  virtual void invariant_scales(const double* densities, double* scales) const;

  /// Macroscopic fields that results have.
  virtual std::vector<field_name> fields() const = 0;
  /// Their values for a row, in the order of fields().
  virtual void macroscopic(const double* u, double* values) const = 0;

  /// At least one; the first is the default.
  virtual const std::vector<initial_data>& initial() const = 0;

  /// Why the discrete model (its velocity grid) cannot hold a row of data, and what could.
  virtual unsupported_initial_data check_supported(const double* u) const;
  /// Likewise for data whose macroscopic fields lie between these extremes.
  virtual unsupported_initial_data check_supported_range(const double* lowest, const double* highest) const;
};

/// Q(u) = C(ω)(E(ω) − u) with ω = ℛu and ℛQ = 0 (paper, Properties 3–5): every stage is solved in closed
/// form.
class relaxation_model : public model {
 public:
  /// Length of ω.
  virtual int moment_count() const = 0;
  /// ω = ℛu.
  virtual void moments(const double* u, double* omega) const = 0;
  /// E(ω). False when ω is not admissible (NaN, ρ ≤ 0, T ≤ 0, …); e is then undefined.
  virtual bool equilibrium(const double* omega, double* e) const = 0;
  /// The same for some rows `pitch` numbers apart. Rows of ω and of E are those of the functions of one row,
  /// which is what these do where a model gains nothing by seeing several at once.
  virtual void moments_of_rows(const double* u, std::ptrdiff_t pitch, int rows, double* omega) const;
  /// Number of rows before the first ω that is not admissible.
  virtual int equilibria(const double* omega, int rows, double* e, std::ptrdiff_t pitch) const;
  /// C(ω) > 0.
  virtual double rate(const double* omega) const = 0;
  std::unique_ptr<point_collision> make_collision(const batch_limits& limits) const final;
  bool has_relaxation_time() const final { return true; }
  /// For messages: "temperature -0.3 is not positive".
  virtual std::string why_inadmissible(const double* omega) const = 0;
  /// Operations (exec/counted.hpp) of ℛu and E(ω) together for each component; 0: not counted.
  virtual double operations_of_equilibrium() const { return 0.0; }
};

}  // namespace apsis
