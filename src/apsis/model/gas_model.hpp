#pragma once

#include <apsis/model/gas.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/model_registry.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace apsis {

namespace scalar {
struct ellipsoidal_model;
struct shakhov_target;
}  // namespace scalar

/// The common part of the BGK, Shakhov and ES-BGK models in one to three space dimensions: a gas that relaxes
/// to a Maxwellian. The equation is f_t + v·∇_x f = (C/ε)(target − f) with moments ω = (ρ, ρu, 𝓔) and
/// equilibrium E = M; rows are those of gas.hpp. C is 1 or, by viscosity, Pr ρ T^{1−s}, with which the
/// viscosity is ε T^s. Dimensionless.
class gas_model : public relaxation_model {
 public:
  /// `prandtl` is the factor Pr of C by viscosity; the viscosity is Pr p ε/C. It is 1 if the stress relaxes
  /// with the rate C. Throws input_error as gas does.
  explicit gas_model(const model_config& config, double prandtl = 1.0);

  /// Returns the parameters that all of these models have. `degrees_of_freedom` fixes the number of degrees
  /// of freedom; 0 leaves it to the user.
  static std::vector<model_parameter> parameters(double degrees_of_freedom);
  static std::vector<model_option> options();  ///< string options that all of these models have
  /// Returns options() and the option "tails" of models whose target may be negative in its tails. `usual` is
  /// the default of "tails".
  static std::vector<model_option> texts_with_tails(const std::string& usual);

  const gas_model* as_gas() const final { return this; }
  const gas& molecules() const { return gas_; }  ///< the rows of the gas
  /// Returns the exponent p of C = Pr ρ T^p by viscosity; nothing if C = 1.
  std::optional<double> rate_exponent() const {
    return by_viscosity_ ? std::optional<double>(exponent_) : std::nullopt;
  }
  double prandtl() const { return prandtl_; }  ///< Pr of C
  /// Returns Shakhov's target as a formula for kernels; null for other models.
  virtual const scalar::shakhov_target* as_shakhov() const { return nullptr; }
  /// Returns the ellipsoidal target as formulas for kernels; null for other models.
  virtual const scalar::ellipsoidal_model* as_ellipsoidal() const { return nullptr; }
  int components() const override { return gas_.velocities().components(); }
  int space_dimensions() const override { return space_dimensions_; }
  const velocity_set& velocities() const override { return gas_.velocities(); }
  velocity_lattice lattice() const override;
  polar_layout polar() const override { return gas_.grid().polar(); }
  bool rate_is_proportional_to_density() const override { return by_viscosity_; }
  /// Returns Σ_k v_max,k/Δx_k, where v_max,k is the end of velocity line k. A uniform line ends half an
  /// interval beyond its last point.
  double cfl_rate(std::span<const double> spacing) const override;
  bool positive() const override { return true; }
  bool collisions_keep_sign() const override { return !signed_tails_; }
  std::string why_signed() const override;

  int moment_count() const override { return gas_.moment_count(); }
  void moments(const double* f, double* omega) const override { gas_.moments(f, 0, 1, omega); }
  void moments_of_rows(const double* f, std::ptrdiff_t pitch, int rows, double* omega) const override {
    gas_.moments(f, pitch, rows, omega);
  }
  bool equilibrium(const double* omega, double* m) const override { return gas_.equilibrium(omega, m); }
  int equilibria(const double* omega, int rows, double* m, std::ptrdiff_t pitch) const override {
    return gas_.equilibria(omega, rows, m, pitch);
  }
  double rate(const double* omega) const override;
  double operations_of_equilibrium() const override { return gas_.operations(); }
  std::string why_inadmissible(const double* omega) const override { return gas_.why_inadmissible(omega); }

  std::optional<convex_entropy> entropy() const override {
    return convex_entropy{[this](const double* f) { return gas_.entropy(f); }};
  }

  std::vector<std::string> invariants() const override;
  std::vector<dimension> invariant_dimensions() const override;
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// Momenta of particles with opposite velocities cancel. The scale of a momentum is therefore √(2ρ𝓔), a
  /// bound of Σ|v_k| f by the Cauchy–Schwarz inequality.
  void invariant_scales(std::span<const double> densities, double* scales) const override;

  /// First group: ρ, u, T, stress p_kl = Σ c_k c_l g − p δ_kl for k ≤ l (none if D = 1), heat flux
  /// ½ Σ c (|c|² g + h).
  ///
  /// Second group: pressure p = ρT, Mach number |u|/√(γT) with γ = (D + 2)/D, and the distance Σ|f − M|/Σ f
  /// to equilibrium. The distance is that of g if there are two functions.
  ///
  /// Third group: the local Knudsen number λ|∇ρ|/ρ with the mean free path by viscosity, λ = μ √(πT/2)/p.
  /// The viscosity is μ = p ε/C, or Pr p ε/C for the ellipsoidal model. The number is NaN where the gas has
  /// no temperature.
  ///
  /// Further groups: divergence and vorticity (flow_fields()).
  std::vector<field_group> fields() const override;

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    return {gas_.maxwellian_form(), gas_.distribution_form()};
  }
  unsupported_initial_data check_supported(const double* f) const override { return gas_.check_supported(f); }

 protected:
  /// Returns the rate λ_e = (λA + λ²B)/(A + B) at which s relaxes in a stage. `derivative` is the weight
  /// λB/(A + B) of Q̇.
  static double rate_of_stage(double lambda, double derivative) {
    return lambda + (lambda - 1.0) * derivative;
  }

  /// Implements target(). A call find(part, keep, e, raised) computes the target for `part` times s and
  /// returns whether its moments are ω (see conservative_target()). e ← the target for the largest part among
  /// 1, ½, … with this property, or the equilibrium. Nonnegative tails are bounded by `keep`. If e differs
  /// from the published target E', cut ← |𝒮e − 𝒮E'|/(λ_e |s|), where λ_e = `rate_of_s`. Returns false if ω is
  /// not admissible.
  template <class Find>
  bool find_target(const double* omega, const double* s, double rate_of_s, double keep, double* e,
                   double& cut, const Find& find) const {
    constexpr double none = std::numeric_limits<double>::infinity();
    bool raised = false;
    const double part = largest_part(signed_tails_ ? none : keep, e, raised, find);
    if (part == 0.0 && !equilibrium(omega, e)) return false;
    if (part == 1.0 && !raised) return true;
    if (signed_tails_) {
      cut = lost_by_part(part, rate_of_s);
      return true;
    }
    thread_local std::vector<double> published;
    published.resize(static_cast<std::size_t>(components()));
    const double best = largest_part(none, published.data(), raised, find);
    if (best == 0.0) equilibrium(omega, published.data());
    cut = lost_by_part(best, rate_of_s) + relative_change(omega, s, rate_of_s, e, published.data());
    return true;
  }

 private:
  std::vector<field_name> names_of_moments() const;
  void moment_fields(const double* f, double* values) const;
  void thermodynamics(const double* f, double* values) const;
  double local_knudsen(const field_point& at) const;
  bool has_stress() const;
  /// Returns the largest part for which find() succeeds; 0 if there is no such part.
  template <class Find>
  static double largest_part(double keep, double* e, bool& raised, const Find& find) {
    for (double part = 1.0; part > 0.01; part *= 0.5)
      if (find(part, keep, e, raised)) return part;
    return 0.0;
  }
  /// Returns |𝒮e − 𝒮E'|/(λ_e |s|) for 𝒮e = part · 𝒮E' and 𝒮E' = (1 − λ_e)s.
  static double lost_by_part(double part, double rate_of_s) {
    return (1.0 - part) * std::abs(1.0 - rate_of_s) / rate_of_s;
  }
  double relative_change(const double* omega, const double* s, double rate_of_s, const double* e,
                         const double* published) const;
  void two_beams(double a, double b, double rho, double T, std::span<double> f) const;
  void expansion(double rho, std::span<double> f) const;
  void make_initial_data();

  gas gas_;
  int space_dimensions_;
  bool by_viscosity_;
  double exponent_, prandtl_;
  bool signed_tails_;
  std::vector<initial_data> initial_;
};

}  // namespace apsis
