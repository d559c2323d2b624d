#include <apsis/model/model_registry.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The equations u₁' = u₂, u₂' = f(u₁)(g(u₁) − u₂)/ε with f = 1 + u₁², g = sin u₁ (paper, eq. vdp and its
/// first numerical test). ω = u₁, E = (u₁, g(u₁)) and C = f(u₁). As ε → 0, u₁' = g(u₁). Dimensionless.
class ode_model final : public relaxation_model {
 public:
  /// Takes the initial data "given", (u1, u2).
  ode_model(double u1, double u2) {
    const auto add = [this](const char* name, const char* description, double first, double second) {
      initial_.push_back({name, description, [first, second](const position&, std::span<double> u) {
                            u[0] = first;
                            u[1] = second;
                          }});
    };
    add("inconsistent", "u = (2, 0), far from equilibrium (paper, ODE model)", 2.0, 0.0);
    add("equilibrium", "u = (2, sin 2)", 2.0, std::sin(2.0));
    add("given", "u = (u1, u2), the parameters of the model", u1, u2);
  }

  int components() const override { return 2; }
  int space_dimensions() const override { return 0; }
  bool has_source() const override { return true; }
  void source(const double* u, double* s) const override {
    s[0] = u[1];
    s[1] = 0.0;
  }

  int moment_count() const override { return 1; }
  void moments(const double* u, double* omega) const override { omega[0] = u[0]; }
  bool equilibrium(const double* omega, double* e) const override {
    e[0] = omega[0];
    e[1] = std::sin(omega[0]);
    return std::isfinite(omega[0]);
  }
  double rate(const double* omega) const override { return 1.0 + omega[0] * omega[0]; }
  std::string why_inadmissible(const double* omega) const override {
    return fmt::format("u1 = {} is not finite", omega[0]);
  }

  std::vector<std::string> invariants() const override { return {}; }
  void invariant_densities(const double*, double*) const override {}
  std::vector<field_group> fields() const override {
    return {{{{"u1", "u1 (dimensionless)"}, {"u2", "u2 (dimensionless)"}},
             [](const field_point& at, double* values) { std::copy_n(at.u, 2, values); }}};
  }

  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    return {{"equilibrium",
             {{"u1", "u1 (dimensionless)"}},
             [this](std::span<const double> given, std::span<double> u) {
               equilibrium(given.data(), u.data());
               return std::string();
             }},
            {"state",
             {{"u1", "u1 (dimensionless)"}, {"u2", "u2 (dimensionless)"}},
             [](std::span<const double> given, std::span<double> u) {
               u[0] = given[0];
               u[1] = given[1];
               return std::string();
             }}};
  }

 private:
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_ode;
const model_entry model_ode = {
    .name = "ode",
    .description = "u1' = u2, u2' = (1 + u1^2)(sin u1 - u2)/epsilon",
    .source = "Gottlieb, Grant, Hu, Shu: SSP multi-derivative IMEX Runge-Kutta, ODE model",
    .parameters = {{.name = "u1",
                    .value = 2.0,
                    .lowest = -1e6,
                    .highest = 1e6,
                    .doc = "u1(0) of the data 'given' (dimensionless)"},
                   {.name = "u2",
                    .value = 0.0,
                    .lowest = -1e6,
                    .highest = 1e6,
                    .doc = "u2(0) of the data 'given' (dimensionless)"}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<ode_model>(config.parameters.at("u1"), config.parameters.at("u2"));
    }};

}  // namespace apsis
