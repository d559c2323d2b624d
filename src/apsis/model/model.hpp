#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// A macroscopic quantity that is written to results: its name and its label for plots.
struct field_name {
  std::string name;   ///< "rho"
  std::string label;  ///< "density (dimensionless)"
};

/// Initial data by name: point values of all components at x (at a jump, those of its right side), and the
/// exact solution that grows out of them where a formula for it is known (empty otherwise; it is smooth).
struct initial_data {
  std::string name;
  std::string description;
  std::function<void(double x, std::span<double> u)> point_value;
  std::function<void(double t, double x, std::span<double> u)> exact = {};
  std::vector<double> jumps = {};  ///< where the data are discontinuous, in increasing order
};

/// Data that a model cannot hold: the key of the case that must change, and a message; both "" if all is
/// well.
struct misfit {
  std::string key, problem;
};

/// An equation u_t + Σ_k ∂_xk(v_k u) = S(u) + Q(u)/ε, seen at one point of space: it knows no mesh and no
/// time. A row u holds components() values; all quantities are dimensionless.
class model {
 public:
  virtual ~model() = default;

  virtual int components() const = 0;
  /// 0 for an ordinary differential equation.
  virtual int space_dimensions() const = 0;
  /// Transport speed of every component along a direction.
  virtual std::span<const double> speeds(int direction) const;

  /// Explicit local source S(u), part of the operator T; only where has_source().
  virtual bool has_source() const { return false; }
  virtual void source(const double* u, double* s) const;

  /// Whether negative components have no meaning (then positivity can be promised).
  virtual bool positive() const { return false; }
  /// Convex entropy density of a row, decaying under upwind transport and collision (row nonnegative).
  virtual bool has_entropy() const { return false; }
  virtual double entropy(const double* u) const;

  /// Quantities that collisions and periodic transport conserve, linear in u; may be none.
  virtual std::vector<std::string> invariants() const = 0;
  virtual void invariant_densities(const double* u, double* densities) const = 0;

  /// Macroscopic fields of a row for results.
  virtual std::vector<field_name> fields() const = 0;
  virtual void macroscopic(const double* u, double* values) const = 0;

  virtual const std::vector<initial_data>& initial() const = 0;

  /// Why the discrete model (its velocity grid) cannot hold a row of data, and what could.
  virtual misfit unfit(const double* u) const;
  /// Likewise for data whose macroscopic fields lie between these extremes.
  virtual misfit unfit_range(const double* lowest, const double* highest) const;
};

/// Q(u) = C(ω)(E(ω) − u) with ω = ℛu and ℛQ = 0 (paper, Properties 3–5): every stage is solved in closed
/// form.
class relaxation_model : public model {
 public:
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
  /// For messages: "temperature -0.3 is not positive".
  virtual std::string why_inadmissible(const double* omega) const = 0;
  /// Operations (core/counted.hpp) of ℛu and E(ω) together for each component; 0: not counted.
  virtual double operations_of_equilibrium() const { return 0.0; }
};

}  // namespace apsis
