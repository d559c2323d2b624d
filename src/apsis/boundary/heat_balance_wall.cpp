#include <apsis/boundary/heat_balance_wall.hpp>

#include <apsis/boundary/gas_end.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/boundary/oblique_reflection.hpp>
#include <apsis/boundary/wall_values.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

prescribed_state emission(const model& equation, const std::string& kind,
                          const std::vector<face_quantity>& velocity) {
  // The temperature is a function, so that the state is not constant. Only try_other() computes rows.
  std::vector<face_quantity> state = {1.0};
  state.insert(state.end(), velocity.begin(), velocity.end());
  state.emplace_back([](double, const position&) { return 1.0; });
  return {maxwellian_form(equation, kind), std::move(state), equation.components()};
}

}  // namespace

/// The balance at one face and time, divided by the arriving mass m: α e(T) + c T⁴ = α E/m + c T_0⁴ with
/// c = factor/m.
class heat_balance_wall::balance {
 public:
  /// `mass_flux` is that of unit components of the first set, > 0 where it leaves the wall.
  balance(const heat_balance_wall& wall, const velocity_set& velocities, std::span<const double> mass_flux,
          const std::array<double, 3>& u, double t, std::span<double> row)
      : wall_(wall), velocities_(velocities), mass_flux_(mass_flux), u_(u), t_(t), row_(row) {}

  double arriving_mass = 0.0, arriving_heat = 0.0;
  double alpha = 1.0;
  radiation radiated;

  /// Adds the mass and the heat that arrive in a row.
  void add_arriving(const double* row) {
    for (std::size_t j = 0; j < mass_flux_.size(); ++j)
      if (mass_flux_[j] < 0.0) {
        arriving_mass -= mass_flux_[j] * row[j];
        arriving_heat -= mass_flux_[j] * heat(row, j);
      }
  }

  /// row ← the Maxwellian of density 1 with the temperature that satisfies the balance. Returns the density
  /// at which the wall emits all arriving mass.
  double solve() {
    given_ = arriving_heat / arriving_mass;
    c_ = radiated.factor / arriving_mass;
    sum_ = alpha * given_ + c_ * fourth(radiated.surroundings);
    if (!(arriving_mass > 0.0 && given_ > 0.0 && std::isfinite(sum_)))
      fail(given_, "what arrives has no heat");
    trial last = first_trial(start()), before = last, best = last;
    double low = 0.0, high = std::numeric_limits<double>::infinity();
    // An excess of this size is the rounding of the sums.
    const double small = 2.0 * std::numeric_limits<double>::epsilon() * (sum_ + c_ * fourth(last.T));
    constexpr int most = 200, between_halvings = 6;
    for (int n = 1; n < most && !(std::abs(best.excess) <= small); ++n) {
      (last.excess > 0.0 ? high : low) = last.T;
      double next = last.T - last.excess / slope(before, last);
      const bool halve = n % between_halvings == 0;  // or doubles T while there is no upper bound
      if (halve || !(next > low && next < high))
        next = std::isfinite(high) ? 0.5 * (low + high) : 2.0 * last.T;
      if (!(next > low && next < high)) break;
      if (const auto excess = excess_at(next)) {
        before = std::exchange(last, {next, *excess});
        if (std::abs(last.excess) < std::abs(best.excess)) best = last;
      } else {
        (next < last.T ? low : high) = next;
      }
    }
    constexpr double accurate = 1e-10;  // relative to the sums, far above their rounding
    if (!(std::abs(best.excess) <= accurate * (sum_ + c_ * fourth(best.T))))
      fail(best.T, "no temperature on the velocities has this heat");
    excess_at(best.T);
    temperature_ = best.T;
    return arriving_mass / emitted_mass_;
  }

  /// Returns the temperature that solve() found.
  double temperature() const { return temperature_; }

 private:
  /// A temperature that the velocities represent, and its excess α e(T) + c T⁴ − sum_.
  struct trial {
    double T, excess;
  };

  static double fourth(double T) { return T * T * (T * T); }

  /// Returns the root for continuous velocities, by Newton's method from above on a convex function.
  double start() const {
    const double slope = alpha * wall_.heat_of_mass_;
    double T = slope > 0.0 ? sum_ / slope : std::numeric_limits<double>::infinity();
    if (c_ > 0.0) T = std::min(T, std::sqrt(std::sqrt(sum_ / c_)));
    constexpr int enough = 40;
    for (int n = 0; n < enough && c_ > 0.0; ++n) {
      const double next = T - (slope * T + c_ * fourth(T) - sum_) / (slope + 4.0 * c_ * T * T * T);
      if (!(next < T)) break;
      T = next;
    }
    return T;
  }

  /// Returns the first of T, 2T, T/2, 4T, … that the velocities represent.
  trial first_trial(double T) {
    constexpr int most_doublings = 10;
    double factor = 1.0;
    for (int k = 0; k <= most_doublings; ++k, factor *= 2.0)
      for (const double one : {T * factor, T / factor})
        if (const auto excess = excess_at(one)) return {one, *excess};
    excess_at(T);
    fail(T, why_);
  }

  /// Returns the slope of the excess between two temperatures. For a single one it assumes that e is
  /// proportional to T, as with continuous velocities.
  double slope(const trial& before, const trial& last) const {
    if (before.T != last.T)
      if (const double found = (last.excess - before.excess) / (last.T - before.T); found > 0.0) return found;
    return (last.excess + sum_ + 3.0 * c_ * fourth(last.T)) / last.T;
  }

  /// row ← the Maxwellian of a temperature. Returns its excess, or nothing if the velocities do
  /// not represent it.
  std::optional<double> excess_at(double T) {
    std::array<double, 5> numbers = {1.0};
    const std::size_t d = wall_.velocity_.size();
    std::copy_n(u_.begin(), d, numbers.begin() + 1);
    numbers[d + 1] = T;
    why_ = wall_.emitted_.try_other({numbers.data(), d + 2}, row_);
    if (!why_.empty()) return std::nullopt;
    double heat = 0.0;
    emitted_mass_ = 0.0;
    for (std::size_t j = 0; j < mass_flux_.size(); ++j)
      if (mass_flux_[j] > 0.0) {
        emitted_mass_ += mass_flux_[j] * row_[j];
        heat += mass_flux_[j] * this->heat(row_.data(), j);
      }
    if (emitted_mass_ > 0.0) return alpha * (heat / emitted_mass_) + c_ * fourth(T) - sum_;
    why_ = "its Maxwellian is 0 at all velocities that leave it";
    return std::nullopt;
  }

  /// Returns ½(|v − u|² g + h) at velocity j.
  double heat(const double* row, std::size_t j) const {
    double square = 0.0;
    for (int k = 0; k < velocities_.dimensions(); ++k) {
      const double c = velocities_.speeds(k)[j] - u_[static_cast<std::size_t>(k)];
      square += c * c;
    }
    return 0.5 * (square * row[j] + (velocities_.sets() > 1 ? row[mass_flux_.size() + j] : 0.0));
  }

  [[noreturn]] void fail(double T, const std::string& why) const {
    throw numerical_error(
        fmt::format("a wall '{}' has no temperature that balances its heat (near T = {:.6g}: {}); use more "
                    "velocity.points or a larger velocity.max, or space.limiter = \"positivity\"",
                    wall_.kind_, T, why),
        {-1, t_, -1, T});
  }

  const heat_balance_wall& wall_;
  const velocity_set& velocities_;
  std::span<const double> mass_flux_;
  const std::array<double, 3>& u_;
  double t_;
  std::span<double> row_;
  double given_ = 0.0, c_ = 0.0, sum_ = 0.0;  ///< E/m, c, and the right-hand side
  double emitted_mass_ = 0.0, temperature_ = 0.0;
  std::string why_;  ///< reason why the velocities do not represent the last temperature
};

/// The wall with any normal. Specular reflection returns the arriving heat. If it can match only the mass,
/// the wall re-emits all arriving molecules, and the balance is exact too.
class heat_balance_wall::oblique_form final : public oblique_wall {
 public:
  oblique_form(std::shared_ptr<const heat_balance_wall> wall, const velocity_set& velocities)
      : wall_(std::move(wall)), velocities_(velocities) {
    const face_quantity& part = wall_->accommodation_;
    if (!part.is_constant() || accommodation_at(part, 0.0, {}) < 1.0) reflection_.emplace(velocities);
  }

  std::array<double, 3> velocity(const wall_point& where) const override {
    return velocity_along(wall_->velocity_, where);
  }

  void emit(const wall_point& where, const double* inward, const double* arriving,
            double* values) const override {
    const auto n = static_cast<std::size_t>(velocities_.components());
    thread_local std::vector<double> flux, emitted;
    flux.assign(velocities_.weights().begin(), velocities_.weights().end());
    for (std::size_t j = 0; j < flux.size(); ++j) flux[j] *= inward[j];
    if (emitted.size() < n) emitted.resize(n);
    const std::array<double, 3> u = velocity(where);
    balance of(*wall_, velocities_, flux, u, where.t, {emitted.data(), n});
    of.alpha = accommodation_at(wall_->accommodation_, where.t, where.at);
    of.radiated = wall_->radiated(where.t, where.at);
    if (of.alpha < 1.0 && !reflection_->reflect(where.normal, inward, arriving, values).is_matched)
      of.alpha = 1.0;
    if (of.alpha == 0.0) return;
    of.add_arriving(arriving);
    // If nothing arrives, nothing leaves at any temperature.
    const bool emits = of.arriving_mass != 0.0;
    const double rho = emits ? of.alpha * of.solve() : 0.0;
    for (std::size_t k = 0; k < n; ++k)
      values[k] = (emits ? rho * emitted[k] : 0.0) + (of.alpha < 1.0 ? (1.0 - of.alpha) * values[k] : 0.0);
  }

 private:
  std::shared_ptr<const heat_balance_wall> wall_;
  velocity_set velocities_;
  std::optional<oblique_reflection> reflection_;  ///< unless α = 1
};

heat_balance_wall::heat_balance_wall(const model& equation, const std::string& kind,
                                     std::vector<face_quantity> velocity, face_quantity accommodation)
    : kind_(kind),
      emitted_(emission(equation, kind, velocity)),
      velocity_(std::move(velocity)),
      accommodation_(std::move(accommodation)),
      heat_of_mass_(0.5 * (gas_of(equation, kind).degrees_of_freedom() + 1)) {}

std::vector<data_variable> heat_balance_wall::variables(const model& equation, const std::string& kind) {
  const int d = gas_of(equation, kind).dimensions();
  return {
      {"velocity", "velocity of the wall, 0 along its normal (dimensionless)", d, 0.0, dimensions::velocity},
      {"accommodation", "fraction of molecules that is re-emitted, 0 to 1; the others are reflected", 1,
       1.0}};
}

std::shared_ptr<const boundary> heat_balance_wall::prepared(const face& where,
                                                            const velocity_set& velocities) const {
  auto own = copy();
  own->velocities_ = velocities;
  own->mirrored_ = mirrored_components(velocities, where.direction);
  const std::vector<double> inward = inward_speeds(where, velocities);
  own->mass_flux_.assign(velocities.weights().begin(), velocities.weights().end());
  for (std::size_t j = 0; j < own->mass_flux_.size(); ++j) own->mass_flux_[j] *= inward[j];
  return own;
}

std::shared_ptr<const oblique_wall> heat_balance_wall::oblique(const velocity_set& velocities) const {
  return std::make_shared<oblique_form>(copy(), velocities);
}

std::optional<double> heat_balance_wall::temperature(const wall_point& where, const velocity_set& velocities,
                                                     const arriving_gas& arriving) const {
  const std::array<double, 3> u = velocity_along(velocity_, where);
  std::vector<double> flux(velocities.weights().begin(), velocities.weights().end()),
      row(static_cast<std::size_t>(velocities.components()));
  for (std::size_t j = 0; j < flux.size(); ++j) {
    double inward = 0.0;
    for (int k = 0; k < velocities.dimensions(); ++k)
      inward += where.normal[static_cast<std::size_t>(k)] * velocities.speeds(k)[j];
    flux[j] *= inward;
  }
  balance of(*this, velocities, flux, u, where.t, row);
  of.alpha = accommodation_at(accommodation_, where.t, where.at);
  of.radiated = radiated(where.t, where.at);
  of.arriving_mass = arriving.mass;
  of.arriving_heat = arriving.energy;
  for (std::size_t k = 0; k < u.size(); ++k)
    of.arriving_heat += u[k] * (0.5 * u[k] * arriving.mass - arriving.momentum[k]);
  if (of.alpha == 0.0 || !(arriving.mass > 0.0)) return std::nullopt;
  of.solve();
  return of.temperature();
}

std::array<double, 3> heat_balance_wall::wall_velocity(double t, const position& at) const {
  std::array<double, 3> u{};
  for (std::size_t k = 0; k < velocity_.size(); ++k) u[k] = velocity_[k].at(t, at);
  return u;
}

void heat_balance_wall::incoming(const face& where, double t, const position& at, const double* outgoing,
                                 double* values) const {
  const std::array<double, 3> u = velocity_along(velocity_, where, t, at);
  balance of(*this, velocities_, mass_flux_, u, t, {values, mirrored_.size()});
  of.alpha = accommodation_at(accommodation_, t, at);
  of.radiated = radiated(t, at);
  of.add_arriving(outgoing);
  // If nothing arrives, nothing leaves at any temperature.
  const bool emits = of.alpha > 0.0 && of.arriving_mass != 0.0;
  const double rho = emits ? of.alpha * of.solve() : 0.0;
  for (std::size_t k = 0; k < mirrored_.size(); ++k)
    values[k] = (emits ? rho * values[k] : 0.0) + (1.0 - of.alpha) * outgoing[mirrored_[k]];
}

}  // namespace apsis
