#include <apsis/model/fluid_fields.hpp>
#include <apsis/model/gas.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace apsis {
namespace {

/// f_t + v·∇_x f = (C/ε)(M[f] − f) on a velocity grid (paper, eq. BGK, with C = 1): ω = (ρ, ρu, 𝓔), E = M.
/// With C = ρ T^{1−s} the viscosity is ε T^s. One space dimension; gas.hpp has the rows. Dimensionless.
class bgk_model final : public relaxation_model {
 public:
  explicit bgk_model(const model_config& config)
      : gas_(config),
        by_viscosity_(config.texts.at("collision_rate") == "viscosity"),
        exponent_(1.0 - config.parameters.at("viscosity_exponent")) {
    make_initial_data();
  }

  int components() const override { return gas_.velocities().components(); }
  int space_dimensions() const override { return 1; }
  const velocity_set& velocities() const override { return gas_.velocities(); }
  /// Returns the end of the velocity grid, half an interval beyond its last point.
  double reference_speed(int) const override { return gas_.grid().max(); }
  bool positive() const override { return true; }

  int moment_count() const override { return gas_.moment_count(); }
  void moments(const double* f, double* omega) const override { gas_.moments(f, 0, 1, omega); }
  void moments_of_rows(const double* f, std::ptrdiff_t pitch, int rows, double* omega) const override {
    gas_.moments(f, pitch, rows, omega);
  }
  bool equilibrium(const double* omega, double* m) const override { return gas_.equilibrium(omega, m); }
  int equilibria(const double* omega, int rows, double* m, std::ptrdiff_t pitch) const override {
    return gas_.equilibria(omega, rows, m, pitch);
  }
  double rate(const double* omega) const override {
    if (!by_viscosity_) return 1.0;
    const double T = omega[0] > 0.0 ? gas_.state(omega).T : 0.0;
    return T > 0.0 ? omega[0] * std::pow(T, exponent_) : 0.0;
  }
  double operations_of_equilibrium() const override { return gas_.operations(); }
  std::string why_inadmissible(const double* omega) const override { return gas_.why_inadmissible(omega); }

  bool has_entropy() const override { return true; }
  double entropy(const double* f) const override { return gas_.entropy(f); }

  std::vector<std::string> invariants() const override { return fluid_invariants(gas_.dimensions()); }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// Momenta cancel between particles of opposite velocities; Σ|v_k| f ≤ √(2ρ𝓔) by the Cauchy–Schwarz
  /// inequality.
  void invariant_scales(const double* densities, double* scales) const override {
    relaxation_model::invariant_scales(densities, scales);
    const int d = gas_.dimensions();
    const double bound = std::sqrt(2.0 * scales[0] * scales[d + 1]);
    for (int k = 1; k <= d; ++k) scales[k] = std::max(scales[k], bound);
  }

  std::vector<field_name> fields() const override { return fluid_fields(gas_.dimensions()); }
  void macroscopic(const double* f, double* values) const override {
    double omega[5];
    moments(f, omega);
    fluid_field_values(gas_.state(omega), gas_.dimensions(), values);
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override { return {gas_.maxwellian_form()}; }
  unsupported_initial_data check_supported(const double* f) const override { return gas_.check_supported(f); }

 private:
  /// f ← a M[ρ̃, ũ, T̃] + b M[ρ̃, −½ũ, T̃], the form of all data of the paper, with ũ along x.
  void two_beams(double a, double b, double rho, double T, std::span<double> f) const {
    aligned_vector<double> beam(f.size());
    fluid_state state;
    state.rho = rho;
    state.T = T;
    state.u[0] = 1.0;
    gas_.formula(state, a, f.data());
    state.u[0] = -0.5;
    gas_.formula(state, b, beam.data());
    for (std::size_t j = 0; j < f.size(); ++j) f[j] += beam[j];
  }

  /// f ← ρ M[1, 0, ¼]; the formula would omit values below 1e-300.
  void expansion(double rho, std::span<double> f) const {
    fluid_state state;
    state.rho = 1.0;
    state.T = 0.25;
    gas_.formula(state, rho, f.data());
  }

  void make_initial_data() {
    using std::numbers::pi;
    const auto add = [this](const char* name, const char* description, double a, double b, double k_rho,
                            double k_T) {
      initial_.push_back(
          {name, description, [this, a, b, k_rho, k_T](const position& x, std::span<double> f) {
             two_beams(a, b, 1.0 + 0.2 * std::sin(k_rho * pi * x[0]),
                       1.0 / (1.0 + 0.2 * std::sin(k_T * pi * x[0])), f);
           }});
    };
    add("mixed-v", "0.5 M[r,1,T] + 0.3 M[r,-1/2,T], r = 1 + 0.2 sin(pi x), T = 1/(1 + 0.2 sin(2 pi x))", 0.5,
        0.3, 1.0, 2.0);
    add("mixed-s", "0.5 M[r,1,T] + 0.3 M[r,-1/2,T], r = 1 + 0.2 sin(pi x), T = 1/(1 + 0.2 sin(pi x))", 0.5,
        0.3, 1.0, 1.0);
    add("accuracy", "0.7 M[r,1,T] + 0.3 M[r,-1/2,T], r = 1 + 0.2 sin(2 pi x), T = 1/(1 + 0.2 sin(pi x))", 0.7,
        0.3, 2.0, 1.0);
    const auto accuracy = initial_.back().point_value;
    initial_.push_back(
        {"expansion",
         "M[r,0,1/4], r = 1 for 1/2 <= x < 3/2 and 1e-300 elsewhere: a cold gas in empty space",
         [this](const position& x, std::span<double> f) {
           expansion(x[0] >= 0.5 && x[0] < 1.5 ? 1.0 : 1e-300, f);
         },
         {},
         {0.5, 1.5}});
    initial_.push_back({"accuracy-consistent", "the Maxwellian with the moments of 'accuracy'",
                        [this, accuracy](const position& x, std::span<double> f) {
                          double omega[5];
                          accuracy(x, f);
                          moments(f.data(), omega);
                          equilibrium(omega, f.data());
                        }});
  }

  gas gas_;
  bool by_viscosity_;
  double exponent_;
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_bgk;
const model_entry model_bgk = {
    .name = "bgk",
    .description = "f_t + v f_x = C (M[f] - f)/epsilon on a velocity grid",
    .source = "Bhatnagar, Gross, Krook (1954); Gottlieb, Grant, Hu, Shu, BGK model",
    .has_velocity_grid = true,
    .parameters =
        [] {
          auto all = gas::parameters();
          all.push_back(
              {.name = "viscosity_exponent",
               .value = 0.5,
               .lowest = 0.0,
               .highest = 2.0,
               .doc = "s of the viscosity epsilon T^s with collision_rate = \"viscosity\": 0.5 for hard "
                      "spheres, 1 for Maxwell molecules, 0.81 for argon"});
          return all;
        }(),
    .texts = {{.name = "collision_rate",
               .value = "constant",
               .choices = {"constant", "viscosity"},
               .variable = "",
               .doc =
                   "constant: C = 1, as in the paper; viscosity: C = rho T^(1 - s), so that the viscosity is "
                   "epsilon T^s with s = viscosity_exponent"}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<bgk_model>(config);
    }};

}  // namespace apsis
