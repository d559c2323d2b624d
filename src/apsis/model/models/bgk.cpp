#include <apsis/model/fluid_fields.hpp>
#include <apsis/model/maxwellian.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {
namespace {

/// f_t + v·∇_x f = (M[f] − f)/ε on a velocity grid (paper, eq. BGK): ω = (ρ, ρu, 𝓔), E = M, C = 1. One space
/// dimension, d velocity dimensions. Dimensionless.
class bgk_model final : public relaxation_model {
 public:
  explicit bgk_model(const model_config& config)
      : grid_(static_cast<int>(config.parameters.at("velocity_dimensions")), config.velocity.points,
              config.velocity.max),
        choice_(config.velocity.equilibrium) {
    make_initial_data();
  }

  int components() const override { return grid_.size(); }
  int space_dimensions() const override { return 1; }
  const velocity_set& velocities() const override { return grid_.set(); }
  /// Returns the end of the velocity grid, half an interval beyond its last point.
  double reference_speed(int) const override { return grid_.max(); }
  bool positive() const override { return true; }

  int moment_count() const override { return grid_.dimensions() + 2; }
  void moments(const double* f, double* omega) const override { kinetic_moments(grid_, f, omega); }
  double rate(const double*) const override { return 1.0; }

  void moments_of_rows(const double* f, std::ptrdiff_t pitch, int rows, double* omega) const override {
    kinetic_moments(grid_, f, pitch, rows, omega);
  }

  /// Exists for the moments of every f ≥ 0; where the formula is undefined (empty space, T = 0 up to
  /// rounding) it is the discrete Maxwellian.
  bool equilibrium(const double* omega, double* m) const override {
    if (choice_ != equilibrium_choice::discrete) {
      const fluid_state state = to_fluid_state(omega, grid_.dimensions());
      if (state.admissible()) {
        formula_maxwellian(grid_, state, m);
        if (is_good_enough(omega, state, m)) return true;
      }
    }
    return discrete_maxwellian(grid_, omega, m);
  }

  int equilibria(const double* omega, int rows, double* m, std::ptrdiff_t pitch) const override {
    if (grid_.dimensions() != 1 || choice_ == equilibrium_choice::discrete)
      return relaxation_model::equilibria(omega, rows, m, pitch);
    std::array<line_state, most_line_states> states;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    for (int first = 0; first < rows;) {
      const int some = std::min(most_line_states, rows - first);
      const double* of = omega + first * 3;
      double* to = m + first * pitch;
      const int found = formula_maxwellians_on_line(grid_, of, some, to, pitch, states.data());
      for (int p = 0; p < found; ++p) {
        const auto& state = states[static_cast<std::size_t>(p)];
        if (!is_good_enough(of + p * 3, state, to + p * pitch) &&
            !discrete_maxwellian(grid_, of + p * 3, to + p * pitch))
          return first + p;
      }
      first += found;
      if (found == some) continue;
      if (!equilibrium(omega + first * 3, m + first * pitch)) return first;
      ++first;
    }
    return rows;
  }

  /// One addition and d + 1 multiply–adds for ω; for M two multiplications per point on a line (without the
  /// first vector), or one per point of a product of lines.
  double operations_of_equilibrium() const override {
    return 1.0 + (grid_.dimensions() + 1) + (grid_.dimensions() == 1 ? 2.0 : 1.0);
  }

  std::string why_inadmissible(const double* omega) const override { return why_unrealizable(grid_, omega); }

  bool has_entropy() const override { return true; }
  /// Σ_j f_j log f_j Δv^d (paper, remark on entropy), with 0 log 0 = 0.
  double entropy(const double* f) const override {
    return grid_.weight() * velocity_rows::entropy(f, grid_.size());
  }

  std::vector<std::string> invariants() const override { return fluid_invariants(grid_.dimensions()); }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// Momenta cancel between particles of opposite velocities; Σ|v_k| f ≤ √(2ρ𝓔) by the Cauchy–Schwarz
  /// inequality.
  void invariant_scales(const double* densities, double* scales) const override {
    relaxation_model::invariant_scales(densities, scales);
    const int d = grid_.dimensions();
    const double bound = std::sqrt(2.0 * scales[0] * scales[d + 1]);
    for (int k = 1; k <= d; ++k) scales[k] = std::max(scales[k], bound);
  }

  std::vector<field_name> fields() const override { return fluid_fields(grid_.dimensions()); }
  void macroscopic(const double* f, double* values) const override {
    double omega[5];
    moments(f, omega);
    fluid_field_values(to_fluid_state(omega, grid_.dimensions()), grid_.dimensions(), values);
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    return {{"Maxwellian",
             {{"rho", "density > 0 (dimensionless)"},
              {"u", "bulk velocity (dimensionless)", grid_.dimensions(), 0.0},
              {"T", "temperature > 0 (dimensionless)"}},
             [this](std::span<const double> given, std::span<double> f) { return maxwellian(given, f); }}};
  }

  unsupported_initial_data check_supported(const double* f) const override {
    double omega[5];
    moments(f, omega);
    const fluid_state s = to_fluid_state(omega, grid_.dimensions());
    if (!s.admissible())
      return {"model.initial", fmt::format("the initial data have no Maxwellian (density {:.6g}, temperature "
                                           "{:.6g}); change them",
                                           s.rho, s.T)};
    const double width = std::sqrt(s.T);
    double speed = 0.0;
    for (int k = 0; k < grid_.dimensions(); ++k) speed = std::max(speed, std::abs(s.u[k]));
    // Mass fraction of the local Maxwellian beyond the grid; 1e-8 is below the accuracy of the cases.
    const double beyond = 0.5 * std::erfc((grid_.max() - speed) / (std::numbers::sqrt2 * width));
    if (beyond > 1e-8)
      return {
          "velocity.max",
          fmt::format(
              "velocity.max = {:g} is too small for the data (a fraction {:.2g} of the mass of u = {:.3g}, "
              "T = {:.3g} lies beyond it); give at least {:.1f}",
              grid_.max(), beyond, s.u[0], s.T, speed + 6.0 * width)};
    const double widest = choice_ == equilibrium_choice::formula ? 1.0 : 2.0;
    if (grid_.spacing() > widest * width)
      return {
          "velocity.points",
          fmt::format(
              "velocity.points = {} is too few for the data (the spacing {:.3g} is more than {:g} times the "
              "thermal speed sqrt(T) = {:.3g}); give at least {:.0f}",
              grid_.points(), grid_.spacing(), widest, width,
              std::ceil(2.0 * grid_.max() / (widest * width)))};
    return {};
  }

 private:
  /// Four roundings, the contribution of an equilibrium to the rounding_bound of a step. A larger defect
  /// would have the same sign in every step; Newton's method reduces it.
  static constexpr double round_off = 4.5e-16;

  /// Whether the Maxwellian m of the formula has the moments ω of its state.
  template <class State>
  bool is_good_enough(const double* omega, const State& state, const double* m) const {
    if (choice_ == equilibrium_choice::formula || formula_has_exact_moments(grid_, state)) return true;
    // The midpoint rule is spectrally accurate: either the defect is round-off or the grid is too coarse.
    return moment_defect(grid_, m, omega, to_fluid_state(omega, grid_.dimensions())) <= round_off;
  }

  /// f ← the equilibrium of (ρ, u, T), whose discrete moments are those of the state to rounding.
  std::string maxwellian(std::span<const double> given, std::span<double> f) const {
    const auto d = static_cast<std::size_t>(grid_.dimensions());
    const double rho = given[0], T = given[d + 1];
    if (!(rho > 0.0)) return fmt::format("density {:.6g} is not positive", rho);
    if (!(T > 0.0)) return fmt::format("temperature {:.6g} is not positive", T);
    double omega[5];
    double square = 0.0;
    omega[0] = rho;
    for (std::size_t k = 1; k <= d; ++k) {
      omega[k] = rho * given[k];
      square += given[k] * given[k];
    }
    omega[d + 1] = 0.5 * rho * (square + static_cast<double>(d) * T);
    return equilibrium(omega, f.data()) ? "" : why_inadmissible(omega);
  }

  /// f ← a M[ρ̃, ũ, T̃] + b M[ρ̃, −½ũ, T̃], the form of all data of the paper, with ũ along x.
  void two_beams(double a, double b, double rho, double T, std::span<double> f) const {
    aligned_vector<double> beam(f.size());
    fluid_state state;
    state.rho = rho;
    state.T = T;
    state.u[0] = 1.0;
    formula_maxwellian(grid_, state, beam.data());
    for (std::size_t j = 0; j < f.size(); ++j) f[j] = a * beam[j];
    state.u[0] = -0.5;
    formula_maxwellian(grid_, state, beam.data());
    for (std::size_t j = 0; j < f.size(); ++j) f[j] += b * beam[j];
  }

  /// f ← ρ M[1, 0, ¼]; the formula would omit values below 1e-300.
  void expansion(double rho, std::span<double> f) const {
    fluid_state state;
    state.rho = 1.0;
    state.T = 0.25;
    formula_maxwellian(grid_, state, f.data());
    for (double& value : f) value *= rho;
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

  velocity_grid grid_;
  equilibrium_choice choice_;
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_bgk;
const model_entry model_bgk = {
    .name = "bgk",
    .description = "f_t + v f_x = (M[f] - f)/epsilon on a velocity grid",
    .source = "Bhatnagar, Gross, Krook (1954); Gottlieb, Grant, Hu, Shu, BGK model",
    .has_velocity_grid = true,
    .parameters = {{.name = "velocity_dimensions",
                    .value = 1.0,
                    .lowest = 1.0,
                    .highest = 3.0,
                    .doc = "number of velocity dimensions (an integer)",
                    .integer = true}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<bgk_model>(config);
    }};

}  // namespace apsis
