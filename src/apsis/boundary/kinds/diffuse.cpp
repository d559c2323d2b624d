#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/boundary/oblique_reflection.hpp>
#include <apsis/boundary/prescribed_state.hpp>
#include <apsis/boundary/wall_temperature.hpp>
#include <apsis/boundary/wall_values.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// A diffuse wall with any normal (Maxwell 1879): f_in = α ρ_w M[1, u_w, T_w] + (1 − α) f_reflected. u_w is
/// the part of the velocity along the wall, and oblique_reflection gives f_reflected. No mass crosses the
/// wall. A wall that is cut into flat pieces moves along each of them. Reflection does not depend on u_w,
/// because u_w·n = 0.
class oblique_diffuse_wall final : public oblique_wall {
 public:
  oblique_diffuse_wall(const velocity_set& velocities, prescribed_state emitted, face_quantity temperature,
                       std::vector<face_quantity> velocity, face_quantity accommodation)
      : velocities_(velocities),
        emitted_(std::move(emitted)),
        temperature_(std::move(temperature)),
        velocity_(std::move(velocity)),
        accommodation_(std::move(accommodation)) {
    if (!accommodation_.is_constant() || accommodation_at(accommodation_, 0.0, {}) < 1.0)
      reflection_.emplace(velocities);
    for (const auto& one : velocity_) moves_ = moves_ || !one.is_constant() || one.at(0.0, {}) != 0.0;
  }

  std::array<double, 3> velocity(const wall_point& where) const override {
    return velocity_along(velocity_, where);
  }

  void emit(const wall_point& where, const double* inward, const double* arriving,
            double* values) const override {
    const double alpha = accommodation_at(accommodation_, where.t, where.at);
    const auto n = static_cast<std::size_t>(velocities_.components());
    if (alpha < 1.0) reflection_->reflect(where.normal, inward, arriving, values);
    if (alpha == 0.0) return;
    thread_local std::vector<double> memory;  // the emitted row, in addition to the reflected one
    if (alpha < 1.0 && memory.size() < n) memory.resize(n);
    const auto [density, emitted] =
        emission(where, inward, arriving, {alpha < 1.0 ? memory.data() : values, n});
    const double rho = alpha * density;
    for (std::size_t k = 0; k < n; ++k)
      values[k] = rho * emitted[k] + (alpha < 1.0 ? (1.0 - alpha) * values[k] : 0.0);
  }

 private:
  struct emitted_gas {
    double density;
    const double* row;  ///< emitted row for density 1
  };

  /// Returns the emission of a wall with α = 1. The row may be in the buffer.
  emitted_gas emission(const wall_point& where, const double* inward, const double* arriving,
                       std::span<double> buffer) const {
    const auto weights = velocities_.weights();
    const double* emitted = maxwellian(where, buffer);
    double arrived = 0.0, leaving = 0.0;
    for (std::size_t j = 0; j < weights.size(); ++j) {
      if (inward[j] < 0.0) arrived -= weights[j] * inward[j] * arriving[j];
      if (inward[j] > 0.0) leaving += weights[j] * inward[j] * emitted[j];
    }
    if (!(leaving > 0.0))
      throw input_error(
          "the Maxwellian of a wall is 0 at all velocities that leave it (they do not resolve it); increase "
          "velocity.points, or the temperature of the wall");
    return {arrived / leaving, emitted};
  }

  const double* maxwellian(const wall_point& where, std::span<double> row) const {
    if (!moves_) return emitted_.at(where.t, where.at, row);
    const auto u = velocity(where);
    std::array<double, 5> numbers = {1.0};
    for (std::size_t k = 0; k < velocity_.size(); ++k) numbers[k + 1] = u[k];
    numbers[velocity_.size() + 1] = temperature_.at(where.t, where.at);
    emitted_.write_other({numbers.data(), velocity_.size() + 2}, where.t, where.at, row);
    return row.data();
  }

  velocity_set velocities_;
  prescribed_state emitted_;
  face_quantity temperature_;
  std::vector<face_quantity> velocity_;
  face_quantity accommodation_;
  std::optional<oblique_reflection> reflection_;  ///< unless α = 1
  bool moves_ = false;
};

/// A wall of temperature T_w that moves along itself (Maxwell 1879). Of the arriving molecules, the fraction
/// α leaves with the Maxwellian of the wall, and 1 − α is reflected specularly:
///   f_in = α ρ_w M[1, u_w, T_w] + (1 − α) f_out(mirrored v_n),  ρ_w = Σ_out w |v_n| f / Σ_in w |v_n| M.
/// These are the discrete sums of the fluxes in the step, so that no mass crosses the wall.
class diffuse_wall final : public incoming_boundary, public wall_temperature {
 public:
  diffuse_wall(prescribed_state emitted, face_quantity temperature, std::vector<face_quantity> velocity,
               face_quantity accommodation)
      : emitted_(std::move(emitted)),
        temperature_(std::move(temperature)),
        velocity_(std::move(velocity)),
        accommodation_(std::move(accommodation)) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<diffuse_wall>(*this);
    own->mirrored_ = mirrored_components(velocities, where.direction);
    const std::vector<double> inward = inward_speeds(where, velocities);
    own->mass_flux_.assign(velocities.weights().begin(), velocities.weights().end());
    for (std::size_t j = 0; j < own->mass_flux_.size(); ++j) own->mass_flux_[j] *= inward[j];  // > 0: enters
    own->entropy_bound_ = bound_of_entropy(velocities);
    return own;
  }

  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const override {
    return std::make_shared<oblique_diffuse_wall>(velocities, emitted_, temperature_, velocity_,
                                                  accommodation_);
  }

  std::optional<double> temperature(const wall_point& where, const velocity_set&,
                                    const arriving_gas&) const override {
    return temperature_.at(where.t, where.at);
  }

  std::optional<std::vector<double>> entropy_bound() const override { return entropy_bound_; }

  std::array<double, 3> wall_velocity(double t, const position& at) const override {
    std::array<double, 3> u{};
    for (std::size_t k = 0; k < velocity_.size(); ++k) u[k] = velocity_[k].at(t, at);
    return u;
  }

  void incoming(const face& where, double t, const position& at, const double* outgoing,
                double* values) const override {
    static_cast<void>(velocity_along(velocity_, where, t, at));
    const double alpha = accommodation_at(accommodation_, t, at);
    const double* emitted = emitted_.at(t, at, {values, mirrored_.size()});
    double arriving = 0.0, leaving = 0.0;
    for (std::size_t j = 0; j < mass_flux_.size(); ++j) {
      if (mass_flux_[j] < 0.0) arriving -= mass_flux_[j] * outgoing[j];
      if (mass_flux_[j] > 0.0) leaving += mass_flux_[j] * emitted[j];
    }
    const double rho = alpha * (arriving / leaving);
    for (std::size_t k = 0; k < mirrored_.size(); ++k)
      values[k] = rho * emitted[k] + (1.0 - alpha) * outgoing[mirrored_[k]];
  }

 private:
  /// Returns the bound of Darrozes & Guiraud (C. R. Acad. Sci. A 262, 1966). By Jensen's inequality the
  /// entropy relative to the Maxwellian M of the wall, Σ f log(f/M), does not increase. log M is quadratic in
  /// v, so that at most the entropy −(F_energy − u_w·F_momentum)/T_w enters. Returns nothing for values that
  /// change, and if the discrete M differs from the formula.
  std::optional<std::vector<double>> bound_of_entropy(const velocity_set& velocities) const {
    const double T = temperature_.is_constant() ? temperature_.at(0.0, {}) : 0.0;
    const auto is_constant = [](const face_quantity& value) { return value.is_constant(); };
    if (!(T > 0.0) || !std::all_of(velocity_.begin(), velocity_.end(), is_constant)) return std::nullopt;
    std::vector<double> bound = {0.0};
    for (const auto& component : velocity_) bound.push_back(component.at(0.0, {}) / T);
    bound.push_back(-1.0 / T);
    std::vector<double> buffer(mirrored_.size());
    const double* emitted = emitted_.at(0.0, {}, buffer);
    return is_gaussian(velocities, emitted, bound, T) ? std::optional(bound) : std::nullopt;
  }

  /// Returns true if the row is exp(β·v − |v|²/(2T)) with the slopes β of the bound and has the variance T.
  /// Then h = (D − d) T g is exact too. Slopes with a relative error η cause an error ηδ for a flux δ out of
  /// equilibrium. The dissipation is of the size δ², so that the entropy grows by at most η²/4.
  static bool is_gaussian(const velocity_set& velocities, const double* row, const std::vector<double>& bound,
                          double T) {
    constexpr double accurate = 1e-8, negligible = 1e-200;
    const auto weights = velocities.weights();
    double lowest = std::numeric_limits<double>::infinity(), highest = 0.0, mass = 0.0, square = 0.0,
           least_h = lowest, most_h = 0.0;
    for (std::size_t j = 0; j < weights.size(); ++j) {
      if (!(row[j] > negligible)) continue;
      double distance = 0.0;
      for (int k = 0; k < velocities.dimensions(); ++k) {
        const double v = velocities.speeds(k)[j], u = bound[static_cast<std::size_t>(k) + 1] * T;
        distance += (v - u) * (v - u);
      }
      const double ratio = row[j] / std::exp(-0.5 * distance / T);
      lowest = std::min(lowest, ratio);
      highest = std::max(highest, ratio);
      mass += weights[j] * row[j];
      square += weights[j] * row[j] * distance;
      if (velocities.sets() < 2) continue;
      const double of_h = row[weights.size() + j] / row[j];
      least_h = std::min(least_h, of_h);
      most_h = std::max(most_h, of_h);
    }
    const double variance = velocities.dimensions() * T * mass;
    return highest > 0.0 && highest - lowest <= accurate * highest &&
           std::abs(square - variance) <= accurate * variance &&
           (velocities.sets() < 2 || most_h - least_h <= accurate * most_h);
  }

  prescribed_state emitted_;
  face_quantity temperature_;
  std::vector<face_quantity> velocity_;
  face_quantity accommodation_;
  std::vector<int> mirrored_;      ///< for each component, the one with the opposite normal velocity
  std::vector<double> mass_flux_;  ///< fluxes of unit components of the first set; > 0 enters
  std::optional<std::vector<double>> entropy_bound_;
};

}  // namespace

extern const boundary_entry boundary_diffuse;
const boundary_entry boundary_diffuse = {
    .name = "diffuse",
    .description =
        "wall that re-emits molecules with its temperature and velocity, or reflects a part of them",
    .variables =
        [](const model& equation) {
          const int d = maxwellian_form(equation, "diffuse").variables[1].size;
          return std::vector<data_variable>{
              {"T", "temperature of the wall, > 0 (dimensionless)", 1, 1.0, dimensions::temperature},
              {"velocity", "velocity of the wall, 0 along its normal (dimensionless)", d, 0.0,
               dimensions::velocity},
              {"accommodation", "fraction of molecules that is re-emitted, 0 to 1; the others are reflected",
               1, 1.0}};
        },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      const std::vector<face_quantity> velocity(from.values.begin() + 1, from.values.end() - 1);
      std::vector<face_quantity> state = {1.0};  // of density 1
      state.insert(state.end(), velocity.begin(), velocity.end());
      state.push_back(from.values.front());
      return std::make_unique<diffuse_wall>(prescribed_state(maxwellian_form(*from.equation, "diffuse"),
                                                             std::move(state), from.equation->components()),
                                            from.values.front(), velocity, from.values.back());
    },
    .any_normal = true};

}  // namespace apsis
