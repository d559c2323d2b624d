#include <apsis/model/model_registry.hpp>

#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The moments ρ = f₊ + 2f₀ + f₋, m = f₊ − f₋, z = f₊ + f₋ (paper, eq. broadmoments).
struct broadwell_moments {
  double rho, m, z;
};

/// Broadwell's gas with the densities f = (f₊, f₀, f₋) of particles of speed 1, 0, −1 (paper, eq. broadwell;
/// Broadwell, Phys. Fluids 7, 1964): f_t + (f₊, 0, −f₋)_x = (q, −q, q)/ε with q = f₀² − f₊f₋. With ω = (ρ, m)
/// the right-hand side is ρ(E(ω) − f)/ε, E = ((ρ + m)², ρ² − m², (ρ − m)²)/(4ρ). Dimensionless.
class broadwell_model final : public relaxation_model {
 public:
  broadwell_model() { make_initial_data(); }

  int components() const override { return 3; }
  int space_dimensions() const override { return 1; }
  const velocity_set& velocities() const override { return velocities_; }
  bool positive() const override { return true; }

  int moment_count() const override { return 2; }
  void moments(const double* f, double* omega) const override {
    omega[0] = f[0] + 2.0 * f[1] + f[2];
    omega[1] = f[0] - f[2];
  }

  /// The equilibrium is nonnegative for every f ≥ 0, also in floating point. Sums and differences round
  /// monotonically, so that |m| ≤ max(f₊, f₋) ≤ ρ and |m/ρ| ≤ 1. Empty space is its own equilibrium.
  bool equilibrium(const double* omega, double* e) const override {
    const double rho = omega[0], m = omega[1];
    if (!std::isfinite(rho) || !std::isfinite(m) || rho < 0.0 || (rho == 0.0 && m != 0.0)) return false;
    const double velocity = rho > 0.0 ? m / rho : 0.0;
    const double ahead = 1.0 + velocity, behind = 1.0 - velocity;
    e[0] = 0.25 * rho * (ahead * ahead);
    e[1] = 0.25 * rho * (ahead * behind);
    e[2] = 0.25 * rho * (behind * behind);
    return true;
  }
  double rate(const double* omega) const override { return omega[0]; }
  std::string why_inadmissible(const double* omega) const override {
    if (!std::isfinite(omega[0]) || !std::isfinite(omega[1])) return "a moment is not finite";
    return fmt::format("density {:.6g} with momentum {:.6g}", omega[0], omega[1]);
  }

  /// The entropy is f₊ log f₊ + 2 f₀ log f₀ + f₋ log f₋ with 0 log 0 = 0. f₀ counts twice, because two of the
  /// four species of the planar gas rest in this direction. Collisions change it by q log(f₊f₋/f₀²) ≤ 0, and
  /// E is its minimum for given ω.
  std::optional<convex_entropy> entropy() const override {
    return convex_entropy{[](const double* f) {
      const auto part = [](double value) { return value > 0.0 ? value * std::log(value) : 0.0; };
      return part(f[0]) + 2.0 * part(f[1]) + part(f[2]);
    }};
  }

  /// z is not an invariant, because collisions change it.
  std::vector<std::string> invariants() const override { return {"mass", "momentum"}; }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// Momenta of opposite velocities cancel. The scale of the momentum is ρ ≥ f₊ + f₋.
  void invariant_scales(std::span<const double> densities, double* scales) const override {
    relaxation_model::invariant_scales(densities, scales);
    scales[1] = std::max(scales[0], scales[1]);
  }

  std::vector<field_group> fields() const override {
    return {{{{"rho", "density (dimensionless)"},
              {"m", "momentum (dimensionless)"},
              {"z", "momentum flux (dimensionless)"},
              {"f_plus", "density of particles of speed 1 (dimensionless)"},
              {"f_0", "density of particles at rest (dimensionless)"},
              {"f_minus", "density of particles of speed -1 (dimensionless)"}},
             [this](const field_point& at, double* values) {
               moments(at.u, values);
               values[2] = at.u[0] + at.u[2];
               std::copy_n(at.u, 3, values + 3);
             }}};
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    const data_variable rho{"rho", "density (dimensionless)"}, m{"m", "momentum (dimensionless)"};
    return {{"equilibrium",
             {rho, m},
             [this](std::span<const double> given, std::span<double> f) {
               if (!(std::abs(given[1]) <= given[0]))
                 return fmt::format("no equilibrium has density {:.6g} and momentum {:.6g}, since |m| > rho",
                                    given[0], given[1]);
               equilibrium(given.data(), f.data());
               return std::string();
             }},
            {"moments",
             {rho, m, {"z", "momentum flux (dimensionless)"}},
             [](std::span<const double> given, std::span<double> f) {
               from_moments({given[0], given[1], given[2]}, f);
               return std::string();
             }},
            {"densities of particles",
             {{"f_plus", "of speed 1 (dimensionless)"},
              {"f_0", "at rest (dimensionless)"},
              {"f_minus", "of speed -1 (dimensionless)"}},
             [](std::span<const double> given, std::span<double> f) {
               std::copy(given.begin(), given.end(), f.begin());
               return std::string();
             }}};
  }

 private:
  static void from_moments(const broadwell_moments& w, std::span<double> f) {
    f[0] = 0.5 * (w.z + w.m);
    f[1] = 0.5 * (w.rho - w.z);
    f[2] = 0.5 * (w.z - w.m);
  }

  static void smooth(const position& at, std::span<double> f) {
    using std::numbers::pi;
    const double x = at[0];
    f[0] = 1.0 + 0.2 * std::exp(0.3 * std::sin(pi * x));
    f[1] = 1.0 / (1.0 + 0.3 * std::sin(pi * x));
    f[2] = std::exp(0.2 * std::cos(2.0 * pi * x));
  }

  void add_riemann(const char* name, const char* description, double jump, const broadwell_moments& left,
                   const broadwell_moments& right) {
    initial_.push_back(
        {name,
         description,
         [=](const position& x, std::span<double> f) { from_moments(x[0] < jump ? left : right, f); },
         {},
         {jump}});
  }

  void make_initial_data() {
    initial_.push_back(
        {"smooth",
         "f = (1 + 0.2 exp(0.3 sin(pi x)), 1/(1 + 0.3 sin(pi x)), exp(0.2 cos(2 pi x))), out of "
         "equilibrium (paper)",
         smooth});
    initial_.push_back({"smooth-consistent", "the local equilibrium of 'smooth'",
                        [this](const position& x, std::span<double> f) {
                          std::array<double, 2> omega{};
                          smooth(x, f);
                          moments(f.data(), omega.data());
                          equilibrium(omega.data(), f.data());
                        }});
    add_riemann("riemann-1",
                "(rho, m, z) = (2, 1, 1) | (1, 0.13962, 1) at x = 0.2: one shock as epsilon -> 0", 0.2,
                {2.0, 1.0, 1.0}, {1.0, 0.13962, 1.0});
    add_riemann("riemann-2", "(rho, m, z) = (1, 0, 1) | (0.2, 0, 1) at x = 0; on the right f_0 = -0.4 < 0",
                0.0, {1.0, 0.0, 1.0}, {0.2, 0.0, 1.0});
  }

  /// f₀ has the weight 2: two of the four species of the planar gas rest in this direction.
  velocity_set velocities_{{{1.0, 0.0, -1.0}}, {1.0, 2.0, 1.0}};
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_broadwell;
const model_entry model_broadwell = {
    .name = "broadwell",
    .description = "f+_t + f+_x = q/epsilon, f0_t = -q/epsilon, f-_t - f-_x = q/epsilon, q = f0^2 - f+ f-",
    .source = "Broadwell (1964); Caflisch, Jin, Russo, SIAM J. Numer. Anal. 34 (1997); Gottlieb et al.",
    .make = [](const model_config&) -> std::unique_ptr<model> {
      return std::make_unique<broadwell_model>();
    }};

}  // namespace apsis
