#include <apsis/model/gas_model.hpp>

#include <apsis/model/fluid_fields.hpp>
#include <apsis/model/formulas/reduction.hpp>
#include <apsis/model/gas_target.hpp>
#include <apsis/velocity/component_name.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace apsis {

gas_model::gas_model(const model_config& config, double prandtl)
    : gas_(config),
      space_dimensions_(config.space_dimensions),
      by_viscosity_(config.options.at("collision_rate") == "viscosity"),
      exponent_(1.0 - config.parameters.at("viscosity_exponent")),
      prandtl_(prandtl),
      signed_tails_(config.options.contains("tails") && config.options.at("tails") == "signed") {
  make_initial_data();
}

std::vector<model_parameter> gas_model::parameters(double degrees_of_freedom) {
  auto all = gas::parameters();
  for (auto& one : all)
    if (one.name == "degrees_of_freedom" && degrees_of_freedom > 0.0)
      one.value = one.lowest = one.highest = degrees_of_freedom;
  all.push_back({.name = "viscosity_exponent",
                 .value = 0.5,
                 .lowest = 0.0,
                 .highest = 2.0,
                 .doc = "s of the viscosity epsilon T^s with collision_rate = \"viscosity\": 0.5 for hard "
                        "spheres, 1 for Maxwell molecules, 0.81 for argon"});
  return all;
}

std::vector<model_option> gas_model::options() {
  return {{.name = "collision_rate",
           .value = "constant",
           .choices = {"constant", "viscosity"},
           .variable = "",
           .doc = "constant: C = 1, as in the paper; viscosity: C = rho T^(1 - s), so that the viscosity is "
                  "epsilon T^s with s = viscosity_exponent"}};
}

std::vector<model_option> gas_model::texts_with_tails(const std::string& usual) {
  auto all = options();
  all.push_back({.name = "tails",
                 .value = usual,
                 .choices = {"signed", "nonnegative"},
                 .variable = "",
                 .doc =
                     "signed: the target as published, which may be negative far from the bulk velocity, so "
                     "that positivity is not promised; nonnegative: where the target would make the "
                     "solution of a stage negative, it is cut off and its moments are restored, so that "
                     "positivity is promised and the gas is another one (history: cut_heat_flux or "
                     "cut_stress)"});
  return all;
}

std::string gas_model::why_signed() const {
  if (!signed_tails_) return {};
  return "positivity is not promised (the target of the model as published is negative far from the bulk "
         "velocity); model.tails = \"nonnegative\" cuts it off there";
}

/// Returns |𝒮e − 𝒮E'|/(λ_e |s|), where E' is the published target.
double gas_model::relative_change(const double* omega, const double* s, double rate_of_s, const double* e,
                                  const double* published) const {
  const int count = relaxing_count();
  std::vector<double> mine(static_cast<std::size_t>(count)), theirs(mine.size());
  relaxing_moments(e, omega, mine.data());
  relaxing_moments(published, omega, theirs.data());
  double difference = 0.0, size = 0.0;
  for (std::size_t k = 0; k + 1 < mine.size(); ++k) {  // the last number is the weight of Q̇
    difference += (mine[k] - theirs[k]) * (mine[k] - theirs[k]);
    size += s[k] * s[k];
  }
  return size > 0.0 ? std::sqrt(difference / size) / rate_of_s : 0.0;
}

velocity_lattice gas_model::lattice() const {
  velocity_lattice found;
  if (gas_.grid().is_polar()) return found;
  for (int k = 0; k < gas_.dimensions(); ++k) {
    const velocity_line& line = gas_.grid().line(k);
    found.points.push_back(line.points());
    found.spacing.push_back(line.uniform() ? line.spacing() : 0.0);
  }
  return found;
}

double gas_model::cfl_rate(std::span<const double> spacing) const {
  double rate = 0.0;
  for (std::size_t k = 0; k < spacing.size(); ++k) rate += gas_.grid().max(static_cast<int>(k)) / spacing[k];
  return rate;
}

double gas_model::rate(const double* omega) const {
  if (!by_viscosity_) return 1.0;
  return omega[0] > 0.0 ? scalar::rate_by_viscosity{prandtl_, exponent_}.of(omega[0], gas_.state(omega).T)
                        : 0.0;
}

std::vector<std::string> gas_model::invariants() const {
  return fluid_invariants(gas_.dimensions());
}

std::vector<dimension> gas_model::invariant_dimensions() const {
  std::vector<dimension> all(static_cast<std::size_t>(gas_.moment_count()), dimensions::mass_flux);
  all.front() = dimensions::density;
  all.back() = dimensions::pressure;
  return all;
}

void gas_model::invariant_scales(std::span<const double> densities, double* scales) const {
  relaxation_model::invariant_scales(densities, scales);
  const int d = gas_.dimensions();
  const double bound = std::sqrt(2.0 * scales[0] * scales[d + 1]);
  for (int k = 1; k <= d; ++k) scales[k] = std::max(scales[k], bound);
}

/// With a single degree of freedom the energy determines the pressure. The stress would be rounding errors.
bool gas_model::has_stress() const {
  return gas_.degrees_of_freedom() > 1;
}

std::vector<field_name> gas_model::names_of_moments() const {
  const int d = gas_.dimensions();
  const std::string axes = "xyz";
  std::vector<field_name> all = fluid_fields(d);
  for (std::size_t k = 0; has_stress() && k < static_cast<std::size_t>(d); ++k)
    for (std::size_t l = k; l < static_cast<std::size_t>(d); ++l) {
      const std::string pair = d == 1 ? "" : std::string({axes[k], axes[l]});
      all.push_back({d == 1 ? "stress" : "stress_" + pair,
                     fmt::format("stress{}{} (dimensionless)", d == 1 ? "" : " ", pair),
                     dimensions::pressure});
    }
  for (int k = 0; k < d; ++k) {
    const std::string along = d == 1 ? "" : std::string(" along ") + "xyz"[k];
    all.push_back(
        {component_name("heat_flux", k, d), "heat flux" + along + " (dimensionless)", dimensions::heat_flux});
  }
  return all;
}

void gas_model::moment_fields(const double* f, double* values) const {
  double omega[5];
  moments(f, omega);
  const int d = gas_.dimensions();
  const fluid_state s = gas_.state(omega);
  fluid_field_values(s, d, values);
  values += d + 2;
  const central_moments m = compute_central_moments(gas_, f, s);
  const double p = s.rho * s.T;
  for (std::size_t k = 0; has_stress() && k < static_cast<std::size_t>(d); ++k)
    for (std::size_t l = k; l < static_cast<std::size_t>(d); ++l)
      *values++ = s.rho * m.stress[k][l] - (k == l ? p : 0.0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) *values++ = m.heat[k];
}

std::vector<field_group> gas_model::fields() const {
  std::vector<field_group> groups = {
      {names_of_moments(), [this](const field_point& at, double* values) { moment_fields(at.u, values); }},
      {{{"p", "pressure (dimensionless)", dimensions::pressure},
        {"mach", "Mach number"},
        {"distance", "distance to equilibrium, relative"}},
       [this](const field_point& at, double* values) { thermodynamics(at.u, values); }},
      {{{"knudsen", "local Knudsen number"}},
       [this](const field_point& at, double* values) { *values = local_knudsen(at); },
       true}};
  for (auto& group : flow_fields(gas_.dimensions())) groups.push_back(std::move(group));
  return groups;
}

void gas_model::thermodynamics(const double* f, double* values) const {
  const int d = gas_.dimensions();
  double omega[5];
  moments(f, omega);
  const fluid_state s = gas_.state(omega);
  const double gamma = (gas_.degrees_of_freedom() + 2.0) / gas_.degrees_of_freedom(), p = s.rho * s.T;
  double square = 0.0;
  for (int k = 0; k < d; ++k) square += s.u[k] * s.u[k];
  *values++ = p;
  *values++ = std::sqrt(square / (gamma * s.T));
  std::vector<double> e(static_cast<std::size_t>(components()));
  double difference = 0.0, all = 0.0;
  if (equilibrium(omega, e.data()))
    for (std::size_t j = 0; j < static_cast<std::size_t>(gas_.grid().size()); ++j) {
      difference += std::abs(f[j] - e[j]);
      all += f[j];
    }
  *values = all > 0.0 ? difference / all : 0.0;
}

double gas_model::local_knudsen(const field_point& at) const {
  double omega[5];
  moments(at.u, omega);
  const fluid_state s = gas_.state(omega);
  double square = 0.0;
  for (const double slope : at.gradients.front()) square += slope * slope;
  const double viscosity_over_pressure = prandtl_ * at.epsilon / rate(omega);
  const double path = viscosity_over_pressure * std::sqrt(0.5 * std::numbers::pi * s.T);
  return s.admissible() ? path * std::sqrt(square) / s.rho : std::numeric_limits<double>::quiet_NaN();
}

/// f ← a M[ρ̃, ũ, T̃] + b M[ρ̃, −½ũ, T̃] with ũ = 1 along x, the form of all data of the paper.
void gas_model::two_beams(double a, double b, double rho, double T, std::span<double> f) const {
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

/// f ← ρ M[1, 0, ¼]. The formula for density ρ would omit values below 1e-300.
void gas_model::expansion(double rho, std::span<double> f) const {
  fluid_state state;
  state.rho = 1.0;
  state.T = 0.25;
  gas_.formula(state, rho, f.data());
}

void gas_model::make_initial_data() {
  using std::numbers::pi;
  const auto add = [this](const char* name, const char* description, double a, double b, double k_rho,
                          double k_T) {
    initial_.push_back({name, description, [this, a, b, k_rho, k_T](const position& x, std::span<double> f) {
                          two_beams(a, b, 1.0 + 0.2 * std::sin(k_rho * pi * x[0]),
                                    1.0 / (1.0 + 0.2 * std::sin(k_T * pi * x[0])), f);
                        }});
  };
  add("mixed-v", "0.5 M[r,1,T] + 0.3 M[r,-1/2,T], r = 1 + 0.2 sin(pi x), T = 1/(1 + 0.2 sin(2 pi x))", 0.5,
      0.3, 1.0, 2.0);
  add("mixed-s", "0.5 M[r,1,T] + 0.3 M[r,-1/2,T], r = 1 + 0.2 sin(pi x), T = 1/(1 + 0.2 sin(pi x))", 0.5, 0.3,
      1.0, 1.0);
  add("accuracy", "0.7 M[r,1,T] + 0.3 M[r,-1/2,T], r = 1 + 0.2 sin(2 pi x), T = 1/(1 + 0.2 sin(pi x))", 0.7,
      0.3, 2.0, 1.0);
  const auto accuracy = initial_.back().point_value;
  initial_.push_back({"expansion",
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

}  // namespace apsis
