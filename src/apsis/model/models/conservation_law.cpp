#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/checks_of_rows.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/system_flux.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The default law: shallow water with g = 1.
const std::vector<std::string> default_variables = {"h", "q"};
const std::vector<std::string> default_flux = {"q", "q^2/h + h^2/2"};

/// Names of two groups of lists: fluxes along x, y, z, and variables whose sign changes in a mirror across x,
/// y, z.
constexpr std::array<const char*, 3> flux_lists = {"flux", "flux_y", "flux_z"};
constexpr std::array<const char*, 3> odd_lists = {"odd", "odd_y", "odd_z"};

/// Returns the fluxes along the directions of space.
std::vector<system_flux> fluxes_of(const model_config& config) {
  std::vector<system_flux> fluxes;
  const auto D = static_cast<std::size_t>(config.space_dimensions);
  for (std::size_t k = 0; k < flux_lists.size(); ++k) {
    const auto& formulas = config.lists.at(flux_lists[k]);
    if (k < D) {
      if (k > 0 && formulas.empty())
        throw input_error(
            fmt::format("model.{} is missing (space has {} dimensions); give the flux along {}, one "
                        "formula for each variable",
                        flux_lists[k], D, "xyz"[k]));
      fluxes.emplace_back(config.lists.at("variables"), formulas, config.constants,
                          fmt::format("model.{}", flux_lists[k]));
    } else if (!formulas.empty() || !config.lists.at(odd_lists[k]).empty()) {
      throw input_error(
          fmt::format("model.{} is not used (space has {} dimension{}); remove it, or give space.cells "
                      "more numbers",
                      formulas.empty() ? odd_lists[k] : flux_lists[k], D, D == 1 ? "" : "s"));
    }
  }
  return fluxes;
}

/// Returns the formulas of quantities that must be positive.
std::vector<expression> positive_quantities(const model_config& config) {
  std::vector<expression> quantities;
  for (const auto& formula : config.lists.at("positive"))
    quantities.emplace_back(formula, source_place{},
                            formula_kind{config.lists.at("variables"), false, config.constants});
  return quantities;
}

/// Returns the velocities ±a along each of D directions.
velocity_set speeds_along(int D, double a, int sets) {
  const auto directions = static_cast<std::size_t>(D);
  std::vector<aligned_vector<double>> v(directions, aligned_vector<double>(2 * directions));
  for (std::size_t k = 0; k < directions; ++k) {
    v[k][2 * k] = a;
    v[k][2 * k + 1] = -a;
  }
  return {std::move(v), std::vector<double>(2 * directions, 1.0), sets};
}

/// Relaxation of u_t + Σ_k F_k(u)_xk = 0 with n variables in D dimensions (Jin, Xin, Comm. Pure Appl. Math.
/// 48, 1995; in diagonal form Aregba-Driollet, Natalini, SIAM J. Numer. Anal. 37, 2000). With the velocities
/// ±a along each direction, f_k±,t ± a f_k±,xk = (E_k±(u) − f_k±)/ε, u = Σ f_k± and E_k± = (u/D ±
/// F_k(u)/a)/2. A row has f₁₊, f₁₋, f₂₊, … of each variable in turn. Dimensionless.
///
/// As ε → 0, u_t + Σ F_k(u)_xk = ε Σ_kl ((a² δ_kl/D − F_k'F_l') u_xl)_xk + O(ε²). This equation is stable if
/// the derivatives of all E_k± have eigenvalues ≥ 0 (Bouchut, J. Stat. Phys. 95, 1999). Equivalently, the
/// eigenvalues λ of F_k' are real and |λ| ≤ a/D, the subcharacteristic condition.
class law_model final : public relaxation_model, public checks_of_rows {
 public:
  explicit law_model(const model_config& config)
      : fluxes_(fluxes_of(config)),
        positive_(positive_quantities(config)),
        n_(fluxes_.front().size()),
        D_(config.space_dimensions),
        a_(config.parameters.at("speed")),
        margin_(config.parameters.at("speed_margin")),
        velocities_(speeds_along(D_, a_, n_)) {
    const auto& variables = fluxes_.front().variables();
    if (D_ == 1 && config.lists.at("variables") == default_variables &&
        config.lists.at("flux") == default_flux)
      make_initial_data();
    for (const auto& name : variables)
      if (name == wave_speed)
        throw input_error(
            fmt::format("model.variables has '{}' (results have a field of this name); choose "
                        "another name",
                        name));
    for (std::size_t k = 0; k < static_cast<std::size_t>(D_); ++k)
      for (const auto& name : config.lists.at(odd_lists[k])) {
        const auto found = std::find(variables.begin(), variables.end(), name);
        if (found == variables.end())
          throw input_error(fmt::format("model.{} has '{:.60}' (it is no variable of the law); {}",
                                        odd_lists[k], name, suggest(name, variables)));
        signs_[k].resize(variables.size(), 1.0);
        signs_[k][static_cast<std::size_t>(found - variables.begin())] = -1.0;
      }
  }

  int components() const override { return 2 * D_ * n_; }
  int space_dimensions() const override { return D_; }
  const velocity_set& velocities() const override { return velocities_; }
  std::vector<double> reflection_signs(int direction) const override {
    const auto& signs = signs_.at(static_cast<std::size_t>(direction));
    if (signs.empty())
      throw input_error(fmt::format(
          "boundary 'symmetry' cannot be used (model.{0} does not say which variables change their sign in a "
          "mirror); name them there, for example {0} = [\"q\"], or choose another kind",
          odd_lists.at(static_cast<std::size_t>(direction))));
    return signs;
  }

  int moment_count() const override { return n_; }
  void moments(const double* f, double* omega) const override {
    for (int k = 0; k < n_; ++k) {
      const double* of = f + 2 * D_ * k;
      omega[k] = of[0] + of[1];
      for (int pair = 1; pair < D_; ++pair) omega[k] += of[2 * pair] + of[2 * pair + 1];
    }
  }
  bool equilibrium(const double* omega, double* e) const override {
    return equilibria(omega, 1, e, components()) == 1;
  }
  /// Evaluates formulas for several rows together.
  int equilibria(const double* omega, int rows, double* e, std::ptrdiff_t pitch) const override {
    std::array<double, most_together * system_flux::most_variables> F;
    const double D = static_cast<double>(D_);
    for (int done = 0; done < rows; done += most_together) {
      const int count = std::min(most_together, rows - done);
      for (int direction = 0; direction < D_; ++direction) {
        fluxes_[static_cast<std::size_t>(direction)].evaluate(omega + done * n_, count, F.data());
        for (int p = 0; p < count; ++p) {
          const double *u = omega + (done + p) * n_, *flux = F.data() + p;
          double* row = e + (done + p) * pitch + 2 * direction;
          for (int k = 0; k < n_; ++k, row += 2 * D_) {
            const double share = u[k] / D, over_a = flux[k * count] / a_;
            row[0] = 0.5 * (share + over_a);
            row[1] = 0.5 * (share - over_a);
          }
        }
      }
      for (int p = 0; p < count; ++p) {
        const double* row = e + (done + p) * pitch;
        if (!std::all_of(row, row + components(), [](double value) { return std::isfinite(value); }))
          return done + p;
      }
    }
    return rows;
  }
  double rate(const double*) const override { return 1.0; }
  std::string why_inadmissible(const double* omega) const override {
    return fmt::format("the flux is not finite at {}", text_of(omega));
  }

  std::vector<std::string> invariants() const override { return variables(); }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// f± have the size of u/D ± F/a, even if u vanishes, as does the momentum of water at rest.
  void invariant_scales(std::span<const double> densities, double* scales) const override {
    invariant_scales_of_rows(densities, 1, scales);
  }
  void invariant_scales_of_rows(std::span<const double> densities, int rows, double* scales) const override {
    const auto n = static_cast<std::size_t>(n_);
    std::array<double, most_together * system_flux::most_variables> F;
    for (std::size_t k = 0; k < densities.size(); ++k) scales[k] = std::abs(densities[k]);
    for (int done = 0; done < rows; done += most_together) {
      const int together = std::min(most_together, rows - done);
      const auto first = static_cast<std::size_t>(done) * n, count = static_cast<std::size_t>(together);
      for (const auto& flux : fluxes_) {
        flux.evaluate(densities.data() + first, together, F.data());
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t p = 0; p < count; ++p)
            if (const double size = std::abs(F[k * count + p]) / a_; std::isfinite(size))
              scales[first + p * n + k] += size;
      }
    }
  }

  std::vector<field_group> fields() const override {
    std::vector<field_name> all;
    for (const auto& name : variables()) all.push_back({name, name + " (dimensionless)"});
    return {{all, [this](const field_point& at, double* values) { moments(at.u, values); }},
            {{{wave_speed, "fastest wave of the law (dimensionless)"}},
             [this](const field_point& at, double* values) { *values = fastest_wave(at.u); }}};
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    data_form form{"equilibrium", {}, [this](std::span<const double> given, std::span<double> f) {
                     return equilibrium(given.data(), f.data()) ? "" : why_inadmissible(given.data());
                   }};
    for (const auto& name : variables())
      form.variables.push_back({name, "conserved quantity (dimensionless)"});
    form.source = {
        [this](std::span<const double> f, std::span<double> values) { moments(f.data(), values.data()); },
        [this](std::span<const double> values, std::span<const double> rates, std::span<double> f) {
          add_rates(values.data(), rates.data(), f.data());
        }};
    return {form};
  }

  std::string condition() const override {
    return positive_.empty() ? "subcharacteristic condition"
                             : "subcharacteristic condition and model.positive";
  }
  unsupported_initial_data check_supported(const double* f) const override {
    if (const auto found = check_positive(f); !found.problem.empty()) return found;
    for (std::size_t k = 0; k < fluxes_.size(); ++k)
      if (const auto found = check_waves(f, k); !found.problem.empty()) return found;
    return {};
  }
  int first_unsupported(const double* f, std::ptrdiff_t pitch, int rows) const override {
    for (int done = 0; done < rows; done += most_together) {
      const int together = std::min(most_together, rows - done),
                fit = first_unsupported_together(f + done * pitch, pitch, together);
      if (fit < together) return done + fit;
    }
    return rows;
  }

  double automatic_value(const std::string&, const std::vector<std::vector<double>>& rows) const override {
    double fastest = n_ == 1 ? fastest_between(rows) : 0.0;
    for (const auto& row : rows) {
      const double speed = fastest_wave(row.data());
      if (!std::isfinite(speed)) {
        const auto problem = check_supported(row.data());
        throw input_error(problem.problem);
      }
      fastest = std::max(fastest, speed);
    }
    if (!(fastest > 0.0))
      throw input_error(
          "model.speed cannot be chosen (every eigenvalue of F' is 0 for the initial data); give a number");
    return rounded_up(margin_ * D_ * fastest);
  }

 private:
  static constexpr const char* wave_speed = "wave_speed";
  static constexpr int most_together = 32;  ///< largest number of rows in one evaluation of formulas
  /// Allowed excess of an eigenvalue over the speed, for the error of the numerical derivative.
  static constexpr double rounding = 1e-6;
  /// Imaginary parts up to this fraction of the speed count as 0. An error δ of F' splits a double eigenvalue
  /// by √δ and a triple one by the cube root of δ.
  static constexpr double not_real = 1e-3;

  static constexpr const char* more_robust =
      "use more cells, a smaller step, or space.reconstruction = \"upwind1\", which does not overshoot";

  /// Returns x rounded up to four digits.
  static double rounded_up(double x) {
    const double digits = 3.0 - std::floor(std::log10(x)), unit = std::pow(10.0, std::abs(digits));
    const double exact = 1.0 - 1e-9;  // numbers of four digits are unchanged
    return digits > 0.0 ? std::ceil(x * unit * exact) / unit : std::ceil(x / unit * exact) * unit;
  }

  const std::vector<std::string>& variables() const { return fluxes_.front().variables(); }
  std::string text_of(const double* u) const { return fluxes_.front().text_of(u); }

  /// Returns the characteristic speeds along a direction.
  system_flux::waves speeds_of(const double* f, std::size_t direction) const {
    std::array<double, system_flux::most_variables> u{};
    moments(f, u.data());
    return fluxes_[direction].characteristic_speeds(u.data(), a_);
  }

  /// Returns the largest speed over all directions; NaN if a flux is not differentiable.
  double fastest_wave(const double* f) const {
    double fastest = 0.0;
    for (std::size_t k = 0; k < fluxes_.size(); ++k) {
      const double speed = speeds_of(f, k).speed;
      if (!(speed <= fastest)) fastest = speed;
      if (std::isnan(speed)) break;
    }
    return fastest;
  }

  /// f_k± ← (rates/D ± F_k'(u) rates/a)/2. Any other split of a source over f_k± would add a term of size ε
  /// to the law.
  void add_rates(const double* u, const double* rates, double* f) const {
    std::array<double, system_flux::most_variables> along{};
    for (std::size_t k = 0; k < fluxes_.size(); ++k) {
      fluxes_[k].derivative_along(u, rates, a_, along.data());
      for (int j = 0; j < n_; ++j) {
        double* const row = f + 2 * (D_ * j + static_cast<int>(k));
        const auto at = static_cast<std::size_t>(j);
        row[0] = 0.5 * (rates[at] / D_ + along[at] / a_);
        row[1] = 0.5 * (rates[at] / D_ - along[at] / a_);
      }
    }
  }

  /// Returns the largest finite speed of a law in one variable between its smallest and largest value. The
  /// waves of a jump take all values between its two sides. A flux that is not convex may be steeper there.
  double fastest_between(const std::vector<std::vector<double>>& rows) const {
    constexpr int intervals = 2000;
    double low = std::numeric_limits<double>::infinity(), high = -low, fastest = 0.0;
    for (const auto& row : rows) {
      double u = 0.0;
      moments(row.data(), &u);
      low = std::min(low, u);
      high = std::max(high, u);
    }
    for (int k = 0; k <= intervals; ++k) {
      const double u = low + (high - low) * k / intervals;
      for (const system_flux& flux : fluxes_)
        if (const double speed = flux.characteristic_speeds(&u).speed; std::isfinite(speed))
          fastest = std::max(fastest, speed);
    }
    return fastest;
  }

  /// Returns first_unsupported() for at most most_together rows.
  int first_unsupported_together(const double* f, std::ptrdiff_t pitch, int rows) const {
    const auto count = static_cast<std::size_t>(rows), n = static_cast<std::size_t>(n_);
    std::array<double, most_together * system_flux::most_variables> u;
    std::array<double, most_together> values;
    std::array<system_flux::waves, most_together> waves;
    for (std::size_t p = 0; p < count; ++p) {
      std::array<double, system_flux::most_variables> omega;
      moments(f + static_cast<std::ptrdiff_t>(p) * pitch, omega.data());
      for (std::size_t k = 0; k < n; ++k) u[k * count + p] = omega[k];
    }
    std::size_t first = count;
    const auto find = [&](const auto& fits) {
      for (std::size_t p = 0; p < first; ++p)
        if (!fits(p)) first = p;
    };
    for (const expression& quantity : positive_) {
      quantity.values_of_columns({u.data(), n * count}, {values.data(), count});
      find([&](std::size_t p) { return values[p] > 0.0; });
    }
    for (const system_flux& flux : fluxes_) {
      flux.characteristic_speeds(u.data(), rows, a_, waves.data());
      find([&](std::size_t p) { return is_inside_law(waves[p]); });
    }
    return static_cast<int>(first);
  }

  /// Whether a state satisfies the subcharacteristic condition and has real speeds; false for NaN.
  bool is_inside_law(const system_flux::waves& found) const {
    return found.speed * D_ <= a_ * (1.0 + rounding) && found.imaginary <= not_real * a_;
  }

  unsupported_initial_data check_positive(const double* f) const {
    if (positive_.empty()) return {};
    std::array<double, system_flux::most_variables> u{};
    moments(f, u.data());
    for (const expression& quantity : positive_) {
      const double value = quantity.value({u.data(), static_cast<std::size_t>(n_)});
      if (value > 0.0) continue;
      const std::string problem = fmt::format("{} is {:.6g} at {} (model.positive requires it to be > 0)",
                                              quantity.text(), value, text_of(u.data()));
      return {"model.positive", problem + "; change the data", problem + "; " + more_robust};
    }
    return {};
  }

  unsupported_initial_data check_waves(const double* f, std::size_t direction) const {
    const auto waves = speeds_of(f, direction);
    if (is_inside_law(waves)) return {};
    const double D = static_cast<double>(D_);
    std::array<double, system_flux::most_variables> u{};
    moments(f, u.data());
    const std::string at = text_of(u.data()), key = fmt::format("model.{}", flux_lists.at(direction));
    if (!std::isfinite(waves.speed))
      return outside_law(key, fmt::format("{} has no finite derivative at {}", key, at),
                         "its wave speeds are not defined there");
    if (waves.imaginary > not_real * a_)
      return outside_law(
          key, fmt::format("{} is not hyperbolic at {}", key, at),
          fmt::format("F' has an eigenvalue with the imaginary part {:.6g}, and perturbations of "
                      "short wavelength grow without bound",
                      waves.imaginary));
    const std::string too_small = fmt::format(
        "model.speed = {:g} is too small (an eigenvalue of F' is {:.6g} in size at {}, and the "
        "subcharacteristic condition is |lambda| <= speed{}); give at least {:g}",
        a_, waves.speed, at, D_ == 1 ? "" : fmt::format("/{} in {} dimensions", D_, D_),
        rounded_up(D * waves.speed));
    return {"model.speed", too_small, too_small + ", or use a smaller step if the solution oscillates"};
  }

  /// Returns the messages for data and for a run. The message of a run adds that the solution left the states
  /// of the law.
  unsupported_initial_data outside_law(const std::string& key, const std::string& problem,
                                       const std::string& reason) const {
    const char* const left = "the solution left the states for which the law is valid";
    return {key, fmt::format("{} ({}); change the formulas or the data", problem, reason),
            fmt::format("{} ({}: {}); {}{}", problem, reason, left, more_robust,
                        positive_.empty() ? "; name depths, densities or pressures in model.positive" : "")};
  }

  static std::array<double, 2> smooth(double x) {
    using std::numbers::pi;
    return {0.16 + 0.04 * std::sin(pi * x), 0.02 * std::cos(pi * x)};
  }

  /// Sets the data of the default law. Their speeds and depths give a near 1.
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

  std::vector<system_flux> fluxes_;   ///< flux of each direction
  std::vector<expression> positive_;  ///< quantities that must be positive
  int n_, D_;
  double a_, margin_;
  velocity_set velocities_;
  std::array<std::vector<double>, 3>
      signs_;  ///< signs of the variables in a mirror across a direction; empty if unknown
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_conservation_law;
const model_entry model_conservation_law = {
    .name = "conservation-law",
    .description =
        "u_t + F(u)_x + ... = 0 by relaxation: f+-_t +- a f+-_x = ((u/D +- F(u)/a)/2 - f+-)/epsilon in "
        "each of D directions",
    .source = "Jin, Xin (1995); Aregba-Driollet, Natalini, SIAM J. Numer. Anal. 37 (2000)",
    .parameters = {{.name = "speed",
                    .value = 1.0,
                    .lowest = 1e-6,
                    .highest = 1e6,
                    .doc =
                        "a, the speed of the waves; |lambda| <= a/D is required of every eigenvalue of F' at "
                        "every step, D being the number of dimensions",
                    .automatic = true},
                   {.name = "speed_margin",
                    .value = 2.0,
                    .lowest = 1.0,
                    .highest = 1e3,
                    .doc =
                        "speed = \"auto\" is D times the largest |lambda| of the initial data times this"}},
    .lists = {{.name = "variables",
               .value = default_variables,
               .variables = "",
               .doc = "names of the conserved quantities u; they are variables of [initial] and fields of "
                      "the results"},
              {.name = "flux",
               .value = default_flux,
               .variables = "variables",
               .doc = "F(u) along x, one formula for each variable; the default is shallow water with g = 1"},
              {.name = "flux_y",
               .value = {},
               .variables = "variables",
               .doc = "the flux along y, in two and three dimensions"},
              {.name = "flux_z", .value = {}, .variables = "variables", .doc = "the flux along z"},
              {.name = "odd",
               .value = {},
               .variables = "",
               .doc = "variables that change their sign in a mirror across x, as a momentum; the boundary "
                      "'symmetry' needs them"},
              {.name = "odd_y", .value = {}, .variables = "", .doc = "the same in a mirror across y"},
              {.name = "odd_z", .value = {}, .variables = "", .doc = "the same in a mirror across z"},
              {.name = "positive",
               .value = {},
               .variables = "variables",
               .doc =
                   "formulas of quantities that must be positive, such as a depth, a density or a pressure; "
                   "checked for the data and at every step"}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<law_model>(config);
    }};

}  // namespace apsis
