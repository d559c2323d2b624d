#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/system_flux.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The law of default cases: shallow water with g = 1.
const std::vector<std::string> default_variables = {"h", "q"};
const std::vector<std::string> default_flux = {"q", "q^2/h + h^2/2"};

/// Relaxation of u_t + F(u)_x = 0 with n variables (Jin, Xin, Comm. Pure Appl. Math. 48, 1995; in diagonal
/// form Aregba-Driollet, Natalini, SIAM J. Numer. Anal. 37, 2000): f±_t ± a f±_x = (E±(u) − f±)/ε with
/// u = f₊ + f₋ and E± = (u ± F(u)/a)/2. As ε → 0, u_t + F(u)_x = ε((a² − F'(u)²) u_x)_x + O(ε²), which is
/// stable if F' has real eigenvalues |λ| ≤ a, the subcharacteristic condition. A row has f₊ and f₋ of each
/// variable in turn. Dimensionless.
class law_model final : public relaxation_model {
 public:
  explicit law_model(const model_config& config)
      : flux_(config.lists.at("variables"), config.lists.at("flux"), config.constants),
        n_(flux_.size()),
        a_(config.parameters.at("speed")),
        margin_(config.parameters.at("speed_margin")),
        velocities_({{a_, -a_}}, {1.0, 1.0}, n_) {
    if (config.lists.at("variables") == default_variables && config.lists.at("flux") == default_flux)
      make_initial_data();
    for (const auto& name : flux_.variables())
      if (name == wave_speed)
        throw input_error(
            fmt::format("model.variables has '{}' (results have a field of this name); choose "
                        "another name",
                        name));
    for (const auto& name : config.lists.at("odd")) {
      const auto& all = flux_.variables();
      const auto found = std::find(all.begin(), all.end(), name);
      if (found == all.end())
        throw input_error(fmt::format("model.odd has '{:.60}' (it is no variable of the law); {}", name,
                                      suggest(name, all)));
      signs_.resize(all.size(), 1.0);
      signs_[static_cast<std::size_t>(found - all.begin())] = -1.0;
    }
  }

  int components() const override { return 2 * n_; }
  int space_dimensions() const override { return 1; }
  const velocity_set& velocities() const override { return velocities_; }
  std::vector<double> reflection_signs() const override {
    if (signs_.empty())
      throw input_error(
          "boundary 'symmetry' cannot be used (model.odd does not say which variables change their sign in a "
          "mirror); name them there, for example odd = [\"q\"], or choose another kind");
    return signs_;
  }

  int moment_count() const override { return n_; }
  void moments(const double* f, double* omega) const override {
    for (int k = 0; k < n_; ++k) omega[k] = f[2 * k] + f[2 * k + 1];
  }
  bool equilibrium(const double* omega, double* e) const override {
    return equilibria(omega, 1, e, components()) == 1;
  }
  /// Formulas are evaluated for several rows together.
  int equilibria(const double* omega, int rows, double* e, std::ptrdiff_t pitch) const override {
    constexpr int together = 32;
    std::array<double, together * system_flux::most_variables> F;
    for (int done = 0; done < rows; done += together) {
      const int count = std::min(together, rows - done);
      flux_.evaluate(omega + done * n_, count, F.data());
      for (int p = 0; p < count; ++p) {
        const double* u = omega + (done + p) * n_;
        double* row = e + (done + p) * pitch;
        for (int k = 0; k < n_; ++k) {
          const double over_a = F[static_cast<std::size_t>(k * count + p)] / a_;
          row[2 * k] = 0.5 * (u[k] + over_a);
          row[2 * k + 1] = 0.5 * (u[k] - over_a);
        }
        if (!std::all_of(row, row + 2 * n_, [](double value) { return std::isfinite(value); }))
          return done + p;
      }
    }
    return rows;
  }
  double rate(const double*) const override { return 1.0; }
  std::string why_inadmissible(const double* omega) const override {
    return fmt::format("the flux is not finite at {}", flux_.text_of(omega));
  }

  std::vector<std::string> invariants() const override { return flux_.variables(); }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// f± have the size of u ± F/a, also where u vanishes, as the momentum of water at rest.
  void invariant_scales(const double* densities, double* scales) const override {
    flux_.evaluate(densities, 1, scales);
    for (int k = 0; k < n_; ++k) {
      const double size = std::abs(densities[k]), from_flux = std::abs(scales[k]) / a_;
      scales[k] = std::isfinite(from_flux) ? size + from_flux : size;
    }
  }

  std::vector<field_name> fields() const override {
    std::vector<field_name> all;
    for (const auto& name : flux_.variables()) all.push_back({name, name + " (dimensionless)"});
    return all;
  }
  void macroscopic(const double* f, double* values) const override { moments(f, values); }
  std::vector<field_name> further_fields() const override {
    return {{wave_speed, "fastest wave of the law (dimensionless)"}};
  }
  void further_macroscopic(const double* f, double* values) const override { values[0] = speeds_of(f).speed; }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    data_form form{"equilibrium", {}, [this](std::span<const double> given, std::span<double> f) {
                     return equilibrium(given.data(), f.data()) ? "" : why_inadmissible(given.data());
                   }};
    for (const auto& name : flux_.variables())
      form.variables.push_back({name, "conserved quantity (dimensionless)"});
    return {form};
  }

  std::string condition() const override { return "subcharacteristic condition"; }
  unsupported_initial_data check_supported(const double* f) const override {
    const auto waves = speeds_of(f);
    if (waves.speed <= a_ * (1.0 + rounding) && waves.imaginary <= not_real * a_) return {};
    std::array<double, system_flux::most_variables> u{};
    moments(f, u.data());
    const std::string at = flux_.text_of(u.data());
    if (!std::isfinite(waves.speed))
      return {"model.flux", fmt::format("model.flux has no finite derivative at {}; change the formulas or "
                                        "the data",
                                        at)};
    if (waves.imaginary > not_real * a_)
      return {"model.flux",
              fmt::format("model.flux is not hyperbolic at {} (F' has an eigenvalue with the imaginary part "
                          "{:.6g}, and perturbations of short wavelength grow without bound); change the "
                          "formulas or the data",
                          at, waves.imaginary)};
    return {"model.speed",
            fmt::format("model.speed = {:g} is too small (an eigenvalue of F' is {:.6g} in size at {}, and "
                        "the subcharacteristic condition is |lambda| <= speed); give at least {:g}",
                        a_, waves.speed, at, rounded_up(waves.speed))};
  }

  double automatic_value(const std::string&, const std::vector<std::vector<double>>& rows) const override {
    double fastest = 0.0;
    for (const auto& row : rows) {
      const double speed = speeds_of(row.data()).speed;
      if (!std::isfinite(speed)) {
        const auto problem = check_supported(row.data());
        throw input_error(problem.problem);
      }
      fastest = std::max(fastest, speed);
    }
    if (!(fastest > 0.0))
      throw input_error(
          "model.speed cannot be chosen (every eigenvalue of F' is 0 for the initial data); give a number");
    return rounded_up(margin_ * fastest);
  }

 private:
  static constexpr const char* wave_speed = "wave_speed";
  /// Allowed excess of an eigenvalue over the speed, for the error of the numerical derivative.
  static constexpr double rounding = 1e-6;
  /// Imaginary parts up to this part of the speed count as 0: an error δ of F' splits a double eigenvalue by
  /// √δ and a triple one by its cube root.
  static constexpr double not_real = 1e-3;

  /// Rounds up to four digits.
  static double rounded_up(double x) {
    const double digits = 3.0 - std::floor(std::log10(x)), unit = std::pow(10.0, std::abs(digits));
    const double exact = 1.0 - 1e-9;  // four digits stay as they are
    return digits > 0.0 ? std::ceil(x * unit * exact) / unit : std::ceil(x / unit * exact) * unit;
  }

  system_flux::waves speeds_of(const double* f) const {
    std::array<double, system_flux::most_variables> u{};
    moments(f, u.data());
    return flux_.characteristic_speeds(u.data());
  }

  static std::array<double, 2> smooth(double x) {
    using std::numbers::pi;
    return {0.16 + 0.04 * std::sin(pi * x), 0.02 * std::cos(pi * x)};
  }

  /// Data of the default law; speeds and depths are such that a is near 1.
  void make_initial_data() {
    initial_.push_back({"smooth",
                        "h = 0.16 + 0.04 sin(pi x), q = 0.02 cos(pi x), out of equilibrium: fluxes F + 0.05 "
                        "(cos(pi x), sin(pi x))",
                        [this](const position& x, std::span<double> f) {
                          equilibrium(smooth(x[0]).data(), f.data());
                          const double phase = std::numbers::pi * x[0];
                          const std::array away = {0.025 * std::cos(phase) / a_,
                                                   0.025 * std::sin(phase) / a_};
                          for (std::size_t k = 0; k < 2; ++k) {
                            f[2 * k] += away[k];
                            f[2 * k + 1] -= away[k];
                          }
                        }});
    initial_.push_back(
        {"smooth-consistent", "the local equilibrium of 'smooth'",
         [this](const position& x, std::span<double> f) { equilibrium(smooth(x[0]).data(), f.data()); }});
    initial_.push_back({"dam-break",
                        "h = 0.25 for x < 0, else 0.1; q = 0",
                        [this](const position& x, std::span<double> f) {
                          const std::array<double, 2> state = {x[0] < 0.0 ? 0.25 : 0.1, 0.0};
                          equilibrium(state.data(), f.data());
                        },
                        {},
                        {0.0}});
  }

  system_flux flux_;
  int n_;
  double a_, margin_;
  velocity_set velocities_;
  std::vector<double> signs_;  ///< of the variables in a mirror; empty if unknown
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_conservation_law;
const model_entry model_conservation_law = {
    .name = "conservation-law",
    .description = "u_t + F(u)_x = 0 by relaxation: f+-_t +- a f+-_x = ((u +- F(u)/a)/2 - f+-)/epsilon",
    .source = "Jin, Xin (1995); Aregba-Driollet, Natalini, SIAM J. Numer. Anal. 37 (2000)",
    .parameters = {{.name = "speed",
                    .value = 1.0,
                    .lowest = 1e-6,
                    .highest = 1e6,
                    .doc =
                        "a, the speed of the waves; |lambda| <= a is required of every eigenvalue of F' at "
                        "every step",
                    .automatic = true},
                   {.name = "speed_margin",
                    .value = 2.0,
                    .lowest = 1.0,
                    .highest = 1e3,
                    .doc = "speed = \"auto\" is the largest |lambda| of the initial data times this"}},
    .lists = {{.name = "variables",
               .value = default_variables,
               .variables = "",
               .doc = "names of the conserved quantities u; they are variables of [initial] and fields of "
                      "the results"},
              {.name = "flux",
               .value = default_flux,
               .variables = "variables",
               .doc = "F(u), one formula for each variable; the default is shallow water with g = 1"},
              {.name = "odd",
               .value = {},
               .variables = "",
               .doc = "variables that change their sign in a mirror, as a momentum; the boundary 'symmetry' "
                      "needs them"}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<law_model>(config);
    }};

}  // namespace apsis
