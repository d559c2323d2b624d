#include <apsis/model/model_registry.hpp>
#include <apsis/model/scalar_flux.hpp>

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The hyperbolic relaxation system u₁_t + u₂_x = 0, u₂_t + a² u₁_x = (F(u₁) − u₂)/ε (paper, eq. hr, with a
/// = 1; Jin, Xin, Comm. Pure Appl. Math. 48, 1995). The components are f± = (u₁ ± u₂/a)/2, which travel
/// with the velocities ±a. ω = u₁, C = 1 and E = (u₁ ± F(u₁)/a)/2. As ε → 0, u₁_t + F(u₁)_x = 0 if |F'| ≤
/// a. Dimensionless.
class relaxation_system final : public relaxation_model {
 public:
  explicit relaxation_system(const model_config& config)
      : a_(config.parameters.at("speed")),
        flux_(config.options.at("flux"), config.parameters.at("slope"),
              config.parameters.at("viscosity_ratio"), config.constants),
        velocities_({{a_, -a_}}, {1.0, 1.0}) {
    make_initial_data(config.parameters.at("left"), config.parameters.at("right"),
                      config.parameters.at("jump"));
  }

  int components() const override { return 2; }
  int space_dimensions() const override { return 1; }
  const velocity_set& velocities() const override { return velocities_; }

  int moment_count() const override { return 1; }
  void moments(const double* f, double* omega) const override { omega[0] = f[0] + f[1]; }
  bool equilibrium(const double* omega, double* e) const override {
    from_fields(omega[0], flux_(omega[0]), e);
    return std::isfinite(e[0]) && std::isfinite(e[1]);
  }
  double rate(const double*) const override { return 1.0; }
  std::string why_inadmissible(const double* omega) const override {
    if (!std::isfinite(omega[0])) return "u1 is not finite";
    return fmt::format("the flux is {} at u1 = {:.6g}", flux_(omega[0]), omega[0]);
  }

  std::vector<std::string> invariants() const override { return {"mass"}; }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }

  std::vector<field_group> fields() const override {
    return {{{{"u1", "conserved quantity u1 (dimensionless)"}, {"u2", "its flux u2 (dimensionless)"}},
             [this](const field_point& at, double* values) {
               values[0] = at.u[0] + at.u[1];
               values[1] = a_ * (at.u[0] - at.u[1]);
             }}};
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    const data_variable u1{"u1", "conserved quantity (dimensionless)"};
    const source_of_state source = {
        [this](std::span<const double> f, std::span<double> values) { moments(f.data(), values.data()); },
        [this](std::span<const double> values, std::span<const double> rates, std::span<double> f) {
          const double slope = flux_.derivative(values[0]);
          from_fields(rates[0], std::isfinite(slope) ? slope * rates[0] : 0.0, f.data());
        }};
    return {{"equilibrium, u2 = F(u1)",
             {u1},
             [this](std::span<const double> given, std::span<double> f) {
               return equilibrium(given.data(), f.data()) ? "" : why_inadmissible(given.data());
             },
             source},
            {"u1 and its flux u2",
             {u1, {"u2", "flux (dimensionless)"}},
             [this](std::span<const double> given, std::span<double> f) {
               from_fields(given[0], given[1], f.data());
               return std::string();
             }}};
  }

  /// Checks the subcharacteristic condition |F'| ≤ a (Liu, Comm. Math. Phys. 108, 1987). Without it the limit
  /// ε → 0 is unstable.
  unsupported_initial_data check_supported_range(const double* lowest, const double* highest) const override {
    const auto wave = flux_.fastest(lowest[0], highest[0]);
    if (!std::isfinite(wave.speed))
      return {"model.flux", fmt::format("model.flux = \"{}\" cannot be used (it has no finite slope at u = "
                                        "{:.6g}, which the data reach); change the formula or the data",
                                        flux_.text(), wave.u)};
    constexpr double rounding = 1e-9;  // error of the slope of a formula
    if (wave.speed <= a_ * (1.0 + rounding)) return {};
    return {"model.speed",
            fmt::format("model.speed = {:g} is too small for the flux \"{}\" (|F'(u)| = {:.6g} "
                        "at u = {:.6g}, which the data reach, and the subcharacteristic "
                        "condition is |F'| <= speed); give at least {:g}",
                        a_, flux_.text(), wave.speed, wave.u, rounded_up(wave.speed))};
  }

 private:
  /// Returns x rounded up to four digits.
  static double rounded_up(double x) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) - 3.0);
    return std::ceil(x / unit * (1.0 - 1e-12)) * unit;
  }

  void from_fields(double u1, double u2, double* f) const {
    f[0] = 0.5 * (u1 + u2 / a_);
    f[1] = 0.5 * (u1 - u2 / a_);
  }

  void make_initial_data(double left, double right, double jump) {
    using std::numbers::pi;
    const auto wave = [](double x) { return 0.4 + 0.3 * std::sin(pi * x); };
    initial_.push_back({"smooth", "u1 = 0.4 + 0.3 sin(pi x), u2 = 0.2 cos(pi x), out of equilibrium",
                        [this, wave](const position& x, std::span<double> f) {
                          from_fields(wave(x[0]), 0.2 * std::cos(pi * x[0]), f.data());
                        }});
    initial_.push_back({"smooth-consistent", "u1 = 0.4 + 0.3 sin(pi x), u2 = F(u1)",
                        [this, wave](const position& x, std::span<double> f) {
                          from_fields(wave(x[0]), flux_(wave(x[0])), f.data());
                        }});
    initial_.push_back({"riemann",
                        "u1 = left for x < jump, else right; u2 = F(u1)",
                        [this, left, right, jump](const position& x, std::span<double> f) {
                          const double u1 = x[0] < jump ? left : right;
                          from_fields(u1, flux_(u1), f.data());
                        },
                        {},
                        {jump}});
  }

  double a_;
  scalar_flux flux_;
  velocity_set velocities_;
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_relaxation;
const model_entry model_relaxation = {
    .name = "relaxation",
    .description = "u1_t + u2_x = 0, u2_t + a^2 u1_x = (F(u1) - u2)/epsilon",
    .source = "Jin, Xin (1995); Gottlieb, Grant, Hu, Shu, hyperbolic relaxation system",
    .parameters = {{.name = "speed",
                    .value = 1.0,
                    .lowest = 1e-6,
                    .highest = 1e6,
                    .doc = "a, the speed of the waves; |F'| <= a is required on the range of the data"},
                   {.name = "slope",
                    .value = 0.5,
                    .lowest = -1e6,
                    .highest = 1e6,
                    .doc = "b of the flux 'linear', F = b u (dimensionless)"},
                   {.name = "viscosity_ratio",
                    .value = 0.5,
                    .lowest = 1e-6,
                    .highest = 1e6,
                    .doc = "M of the flux 'buckley-leverett', F = u^2/(u^2 + M (1 - u)^2) (dimensionless)"},
                   {.name = "left",
                    .value = 1.0,
                    .lowest = -1e6,
                    .highest = 1e6,
                    .doc = "u1 left of the jump of the data 'riemann' (dimensionless)"},
                   {.name = "right",
                    .value = 0.0,
                    .lowest = -1e6,
                    .highest = 1e6,
                    .doc = "u1 right of it (dimensionless)"},
                   {.name = "jump",
                    .value = 0.0,
                    .lowest = -1e6,
                    .highest = 1e6,
                    .doc = "x of the jump (dimensionless)"}},
    .options = {{.name = "flux",
                 .value = "burgers",
                 .choices = scalar_flux::names(),
                 .variable = "u",
                 .doc = "F(u); 'burgers' is u^2/2"}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<relaxation_system>(config);
    }};

}  // namespace apsis
