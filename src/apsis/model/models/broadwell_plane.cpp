#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Broadwell's gas in the plane: densities f = (f→, f←, f↑, f↓) of particles with the velocities (1, 0),
/// (−1, 0), (0, 1), (0, −1). A head-on collision turns both particles by a right angle (Broadwell, Phys.
/// Fluids 7, 1964; Platkowski, Illner, SIAM Rev. 30, 1988):
///   f_t + v·∇f = (q, q, −q, −q)/ε,   q = f↑f↓ − f→f←.
/// Let a = f→ + f← and b = f↑ + f↓. Then 4q = b² − m_y² − a² + m_x², and ρ = a + b is an invariant. Q is
/// therefore a relaxation with the rate ρ: q = ρ(E→ − f→) with ω = (ρ, m_x, m_y), 4ρE→← = (ρ ± m_x)² − m_y²
/// and 4ρE↑↓ = (ρ ± m_y)² − m_x². Data with f↑ = f↓ that do not depend on y are those of the model
/// `broadwell`. Dimensionless.
class plane_broadwell_model final : public relaxation_model {
 public:
  explicit plane_broadwell_model(const model_config& config) : dimensions_(config.space_dimensions) {
    if (dimensions_ > 2)
      throw input_error(
          "model 'broadwell-plane' cannot be used (its particles move in a plane, and space.cells has three "
          "numbers); give one or two, or describe the velocities in space by model 'discrete-velocity'");
    make_initial_data();
  }

  int components() const override { return 4; }
  int space_dimensions() const override { return dimensions_; }
  const velocity_set& velocities() const override { return velocities_; }
  bool positive() const override { return true; }

  int moment_count() const override { return 3; }
  void moments(const double* f, double* omega) const override {
    omega[0] = (f[0] + f[1]) + (f[2] + f[3]);
    omega[1] = f[0] - f[1];
    omega[2] = f[2] - f[3];
  }

  /// The equilibrium is nonnegative: both factors are, because |m_x| + |m_y| ≤ ρ, and negative rounding
  /// errors become 0. Empty space is its own equilibrium.
  bool equilibrium(const double* omega, double* e) const override {
    const double rho = omega[0];
    if (!std::isfinite(rho) || !std::isfinite(omega[1]) || !std::isfinite(omega[2]) || rho < 0.0 ||
        (rho == 0.0 && (omega[1] != 0.0 || omega[2] != 0.0)))
      return false;
    const double x = rho > 0.0 ? omega[1] / rho : 0.0, y = rho > 0.0 ? omega[2] / rho : 0.0;
    const auto part = [rho](double along, double across) {
      return std::max(0.25 * rho * ((1.0 + along + across) * (1.0 + along - across)), 0.0);
    };
    e[0] = part(x, y);
    e[1] = part(-x, y);
    e[2] = part(y, x);
    e[3] = part(-y, x);
    return true;
  }
  double rate(const double* omega) const override { return omega[0]; }
  std::string why_inadmissible(const double* omega) const override {
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite(omega[k])) return "a moment is not finite";
    return fmt::format("density {:.6g} with momentum ({:.6g}, {:.6g})", omega[0], omega[1], omega[2]);
  }

  /// The entropy is Σ f log f with 0 log 0 = 0. Collisions change it by 2q log(f→f←/(f↑f↓)) ≤ 0, and E is its
  /// minimum for given ω.
  std::optional<convex_entropy> entropy() const override {
    return convex_entropy{[](const double* f) {
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) sum += f[k] > 0.0 ? f[k] * std::log(f[k]) : 0.0;
      return sum;
    }};
  }

  std::vector<std::string> invariants() const override { return {"mass", "momentum_x", "momentum_y"}; }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  /// Momenta of opposite velocities cancel. The scale of a momentum is ρ ≥ f→ + f←.
  void invariant_scales(std::span<const double> densities, double* scales) const override {
    relaxation_model::invariant_scales(densities, scales);
    for (int k = 1; k < 3; ++k) scales[k] = std::max(scales[0], scales[k]);
  }

  std::vector<field_group> fields() const override {
    std::vector<field_name> all = {{"rho", "density (dimensionless)"},
                                   {"m_x", "momentum along x (dimensionless)"},
                                   {"m_y", "momentum along y (dimensionless)"}};
    for (const auto& [name, doc] : particles_of)
      all.push_back({name, std::string("density of particles ") + doc});
    return {{all, [this](const field_point& at, double* values) {
               moments(at.u, values);
               std::copy_n(at.u, 4, values + 3);
             }}};
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    const data_form equilibria{
        "equilibrium",
        {{"rho", "density (dimensionless)"}, {"m", "momentum (dimensionless)", 2}},
        [this](std::span<const double> given, std::span<double> f) {
          if (!(std::abs(given[1]) + std::abs(given[2]) <= given[0]))
            return fmt::format(
                "no equilibrium has density {:.6g} and momentum ({:.6g}, {:.6g}), since "
                "|m_x| + |m_y| > rho",
                given[0], given[1], given[2]);
          equilibrium(given.data(), f.data());
          return std::string();
        }};
    data_form particles{"densities of particles", {}, [](std::span<const double> given, std::span<double> f) {
                          std::copy(given.begin(), given.end(), f.begin());
                          return std::string();
                        }};
    for (const auto& [name, doc] : particles_of) particles.variables.push_back({name, doc});
    return {equilibria, particles};
  }

 private:
  struct density_name {
    const char *name, *doc;
  };
  static constexpr std::array<density_name, 4> particles_of = {
      density_name{"f_right", "of velocity (1, 0) (dimensionless)"},
      density_name{"f_left", "of velocity (-1, 0) (dimensionless)"},
      density_name{"f_up", "of velocity (0, 1) (dimensionless)"},
      density_name{"f_down", "of velocity (0, -1) (dimensionless)"}};

  static void smooth(const position& at, std::span<double> f) {
    using std::numbers::pi;
    const double x = at[0], y = at[1];
    f[0] = 1.0 + 0.2 * std::exp(0.3 * std::sin(pi * (x + y)));
    f[1] = std::exp(0.2 * std::cos(2.0 * pi * x) * std::cos(pi * y));
    f[2] = 1.0 / (1.0 + 0.3 * std::sin(pi * x) * std::cos(pi * y));
    f[3] = 1.0 + 0.3 * std::cos(pi * (x - y));
  }

  void make_initial_data() {
    initial_.push_back(
        {"smooth",
         "f_right = 1 + 0.2 exp(0.3 sin(pi (x + y))), f_left = exp(0.2 cos(2 pi x) cos(pi y)), "
         "f_up = 1/(1 + 0.3 sin(pi x) cos(pi y)), f_down = 1 + 0.3 cos(pi (x - y)), out of "
         "equilibrium",
         smooth});
    initial_.push_back({"smooth-consistent", "the local equilibrium of 'smooth'",
                        [this](const position& x, std::span<double> f) {
                          std::array<double, 3> omega{};
                          smooth(x, f);
                          moments(f.data(), omega.data());
                          equilibrium(omega.data(), f.data());
                        }});
  }

  int dimensions_;
  velocity_set velocities_{{{1.0, -1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, -1.0}}, {1.0, 1.0, 1.0, 1.0}};
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_broadwell_plane;
const model_entry model_broadwell_plane = {
    .name = "broadwell-plane",
    .description =
        "four velocities: f_t + v.grad f = (q, q, -q, -q)/epsilon, q = f_up f_down - f_right f_left",
    .source = "Broadwell (1964); Platkowski, Illner, SIAM Rev. 30 (1988)",
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<plane_broadwell_model>(config);
    }};

}  // namespace apsis
