#include <apsis/core/errors.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/model/fluid_fields.hpp>
#include <apsis/model/internal/binary_collision_stages.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/number_tuples.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The nine velocities of a square grid of 3 × 3 points. This is the smallest regular set in the plane whose
/// only invariants are mass, momentum and energy.
const std::vector<std::string> default_velocities = {"0, 0", "1, 0",  "-1, 0", "0, 1",  "0, -1",
                                                     "1, 1", "-1, 1", "1, -1", "-1, -1"};

binary_collision collision_of(const std::vector<double>& entry) {
  if (entry.size() != 4 && entry.size() != 5)
    throw input_error(
        fmt::format("model.collisions has an entry with {} numbers (it names four velocities, and a rate if "
                    "that is not 1); write "
                    "for example [1, 2, 3, 4] or [1, 2, 3, 4, 0.5]",
                    entry.size()));
  std::array<int, 4> of{};
  for (std::size_t k = 0; k < of.size(); ++k) {
    if (entry[k] != std::floor(entry[k]) || !(std::abs(entry[k]) <= 1e6))
      throw input_error(fmt::format(
          "model.collisions names velocity {:g} (they are numbered 1, 2, …); change it", entry[k]));
    of[k] = static_cast<int>(entry[k]) - 1;
  }
  return {of[0], of[1], of[2], of[3], entry.size() == 5 ? entry[4] : 1.0};
}

binary_collisions collisions_of(const model_config& config) {
  std::vector<binary_collision> collisions;
  for (const auto& entry : number_tuples(config.lists.at("collisions"), config.constants))
    collisions.push_back(collision_of(entry));
  binary_collisions all(number_tuples(config.lists.at("velocities"), config.constants),
                        std::move(collisions));
  if (all.dimensions() < config.space_dimensions)
    throw input_error(
        fmt::format("model.velocities has velocities of {} component{} (space has {} dimensions); give {}",
                    all.dimensions(), all.dimensions() == 1 ? "" : "s", config.space_dimensions,
                    config.space_dimensions));
  return all;
}

/// A gas with n velocities v_j and elastic collisions i + j ↔ k + l of rates A (Gatignol 1975; Platkowski,
/// Illner, SIAM Rev. 30, 1988): f_j,t + v_j·∇f_j = Q_j(f)/ε. Every collision adds A (f_i f_j − f_k f_l) to
/// Q_k and Q_l, and subtracts it from Q_i and Q_j. Dimensionless.
class discrete_velocity_model final : public model {
 public:
  explicit discrete_velocity_model(const model_config& config)
      : space_dimensions_(config.space_dimensions), collisions_(collisions_of(config)) {
    const auto n = static_cast<std::size_t>(collisions_.size());
    std::vector<aligned_vector<double>> coordinates(static_cast<std::size_t>(d()), aligned_vector<double>(n));
    for (std::size_t k = 0; k < coordinates.size(); ++k)
      for (std::size_t j = 0; j < n; ++j) coordinates[k][j] = collisions_.velocities()[j][k];
    velocities_ = velocity_set(std::move(coordinates), std::vector<double>(n, 1.0));
    for (const auto& one : collisions_.invariants()) physical_ += one.name.rfind("spurious", 0) == 0 ? 0 : 1;
    make_initial_data();
  }

  int components() const override { return collisions_.size(); }
  int space_dimensions() const override { return space_dimensions_; }
  const velocity_set& velocities() const override { return velocities_; }
  std::unique_ptr<point_collision> make_collision(const batch_limits&) const override {
    return make_binary_collision(collisions_);
  }
  int newton_unknowns() const override { return static_cast<int>(collisions_.reachable().cols()); }
  bool has_relaxation_time() const override { return true; }

  bool positive() const override { return true; }
  /// Q̇ is not a multiple of Q. In general the inverse of I + |b| Q'² is not nonnegative.
  bool collisions_keep_sign() const override { return false; }
  std::optional<convex_entropy> entropy() const override {
    return convex_entropy{[n = components()](const double* f) {
                            double sum = 0.0;
                            for (int j = 0; j < n; ++j) sum += f[j] > 0.0 ? f[j] * std::log(f[j]) : 0.0;
                            return sum;
                          },
                          false};
  }

  std::vector<std::string> invariants() const override {
    std::vector<std::string> names;
    for (const auto& one : collisions_.invariants()) names.push_back(one.name);
    return names;
  }
  void invariant_densities(const double* f, double* densities) const override {
    const Eigen::VectorXd all = collisions_.moments(f);
    std::copy(all.begin(), all.end(), densities);
  }
  /// Scales follow from |Σ φ_j f_j| ≤ max|φ| ρ for f ≥ 0.
  void invariant_scales(std::span<const double> densities, double* scales) const override {
    for (std::size_t k = 0; k < collisions_.invariants().size(); ++k)
      scales[k] =
          std::max(std::abs(densities[k]),
                   collisions_.invariants()[k].weights.lpNorm<Eigen::Infinity>() * std::abs(densities[0]));
  }

  /// values ← the fields of fluid_fields().
  void fluid_moments(const double* f, double* values) const {
    fluid_state state{};
    double square = 0.0;
    for (int j = 0; j < components(); ++j) {
      state.rho += f[j];
      for (int k = 0; k < d(); ++k) state.u[k] += v(j, k) * f[j];
    }
    for (int k = 0; k < d(); ++k) state.u[k] /= state.rho;
    for (int j = 0; j < components(); ++j)
      for (int k = 0; k < d(); ++k) square += (v(j, k) - state.u[k]) * (v(j, k) - state.u[k]) * f[j];
    state.T = square / (state.rho * d());
    fluid_field_values(state, d(), values);
  }
  std::vector<field_group> fields() const override {
    field_group densities{
        {}, [n = components()](const field_point& at, double* values) { std::copy_n(at.u, n, values); }};
    for (int j = 0; j < components(); ++j)
      densities.names.push_back(
          {density_name(j), fmt::format("density of velocity {} (dimensionless)", j + 1)});
    std::vector<field_group> groups = {
        {fluid_fields(d()), [this](const field_point& at, double* values) { fluid_moments(at.u, values); }},
        densities};
    for (auto& group : flow_fields(d())) groups.push_back(std::move(group));
    return groups;
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    data_form equilibria{"equilibrium",
                         {{"rho", "density (dimensionless)"}, {"u", "bulk velocity (dimensionless)", d()}},
                         [this](std::span<const double> given, std::span<double> f) {
                           return equilibrium_of(given, f.data()) ? "" : why_no_equilibrium(given);
                         }};
    if (has_energy())
      equilibria.variables.push_back({"T",
                                      "temperature, the variance of a component of the velocity "
                                      "(dimensionless)"});
    data_form densities{"densities", {}, [](std::span<const double> given, std::span<double> f) {
                          std::copy(given.begin(), given.end(), f.begin());
                          return std::string();
                        }};
    for (int j = 0; j < components(); ++j)
      densities.variables.push_back({density_name(j), fmt::format("of velocity {} (dimensionless)", j + 1)});
    return {equilibria, densities};
  }

 private:
  int d() const { return collisions_.dimensions(); }
  double v(int j, int k) const {
    return collisions_.velocities()[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)];
  }
  static std::string density_name(int j) { return fmt::format("f_{}", j + 1); }
  bool has_energy() const {
    const auto& all = collisions_.invariants();
    return std::any_of(all.begin(), all.end(), [](const auto& one) { return one.name == "energy"; });
  }

  /// f ← the Maxwellian exp(α + β·v + γ|v|²) with the given density and bulk velocity, and with the given
  /// temperature if energy is an independent invariant. Returns false if it does not exist.
  bool equilibrium_of(std::span<const double> given, double* f) const {
    if (given[0] == 0.0) {
      std::fill_n(f, components(), 0.0);
      return true;
    }
    double square = 0.0;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(d()); ++k) square += given[k] * given[k];
    Eigen::VectorXd wanted(physical_);
    for (int k = 0; k < physical_; ++k) {
      const std::string& name = collisions_.invariants()[static_cast<std::size_t>(k)].name;
      const auto axis = name == "momentum" ? 'x' : name.back();
      wanted[k] = given[0] * (name == "mass"     ? 1.0
                              : name == "energy" ? 0.5 * (square + d() * given.back())
                                                 : given[1 + static_cast<std::size_t>(axis - 'x')]);
    }
    if (!collisions_.minimize_entropy(wanted, f)) return false;
    // Invariants do not prescribe components of the bulk velocity that are orthogonal to all v_j.
    std::array<double, 5> values{};
    fluid_moments(f, values.data());
    for (std::size_t k = 1; k <= static_cast<std::size_t>(d()); ++k)
      if (!(std::abs(values[k] - given[k]) <= 1e-9 * (1.0 + std::abs(given[k])))) return false;
    return true;
  }

  std::string why_no_equilibrium(std::span<const double> given) const {
    std::string u;
    for (int k = 0; k < d(); ++k)
      u += fmt::format("{}{:.6g}", k == 0 ? "" : ", ", given[1 + static_cast<std::size_t>(k)]);
    return fmt::format("no equilibrium of these velocities has density {:.6g}, bulk velocity ({}){}",
                       given[0], u, has_energy() ? fmt::format(" and temperature {:.6g}", given.back()) : "");
  }

  static void smooth(const position& x, std::span<double> f) {
    using std::numbers::pi;
    for (std::size_t j = 0; j < f.size(); ++j)
      f[j] = 1.0 + 0.3 * std::sin(pi * x[0] + static_cast<double>(j + 1)) * std::cos(pi * x[1]) *
                       std::cos(pi * x[2]);
  }

  void make_initial_data() {
    initial_.push_back(
        {"smooth", "f_j = 1 + 0.3 sin(pi x + j) cos(pi y) cos(pi z), out of equilibrium", smooth});
    initial_.push_back({"smooth-consistent", "the local equilibrium of 'smooth'",
                        [this](const position& x, std::span<double> f) {
                          smooth(x, f);
                          std::vector<double> e(f.size());
                          if (collisions_.minimize_entropy(collisions_.moments(f.data()), e.data()))
                            std::copy(e.begin(), e.end(), f.begin());
                        }});
  }

  int space_dimensions_;
  binary_collisions collisions_;
  velocity_set velocities_;
  int physical_ = 0;  ///< number of invariants that are not spurious
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_discrete_velocity;
const model_entry model_discrete_velocity = {
    .name = "discrete-velocity",
    .description = "n velocities: f_t + v.grad f = Q/epsilon, Q = sum over collisions A (f_i f_j - f_k f_l)",
    .source = "Gatignol (1975); Platkowski, Illner, SIAM Rev. 30 (1988)",
    .lists =
        {{.name = "velocities",
          .value = default_velocities,
          .variables = "",
          .doc = "components of the velocities, [[1, 0], [-1, 0], ...]; numbers or formulas of constants",
          .tuples = true},
         {.name = "collisions",
          .value = {},
          .variables = "",
          .doc = "pairs of velocities that become each other, numbered from 1, and their rate A if it is not "
                 "1: [[1, 2, 3, 4], [1, 2, 5, 6, 0.5]]; without collisions: all that conserve momentum and "
                 "energy",
          .tuples = true}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<discrete_velocity_model>(config);
    }};

}  // namespace apsis
