#include <apsis/model/model_registry.hpp>

#include <cmath>

namespace apsis {
namespace {

/// Two beams that exchange particles: f±_t ± f±_x = (ρ/2 − f±)/ε, ρ = f₊ + f₋. Dimensionless.
class planted_exchange final : public relaxation_model {
 public:
  int components() const override { return 2; }
  int space_dimensions() const override { return 1; }
  const velocity_set& velocities() const override { return velocities_; }
  bool positive() const override { return true; }
  int moment_count() const override { return 1; }
  void moments(const double* f, double* omega) const override { *omega = f[0] + f[1]; }
  bool equilibrium(const double* omega, double* e) const override {
    e[0] = e[1] = 0.5 * *omega;
    return std::isfinite(*omega);
  }
  double rate(const double*) const override { return 1.0; }
  std::string why_inadmissible(const double*) const override { return "the density is not finite"; }
  std::vector<std::string> invariants() const override { return {"mass"}; }
  void invariant_densities(const double* f, double* densities) const override { moments(f, densities); }
  std::vector<field_group> fields() const override {
    return {{{{"rho", "density (dimensionless)"}},
             [this](const field_point& at, double* values) { moments(at.u, values); }},
            {{{"flux", "flux of particles (dimensionless)"}},
             [](const field_point& at, double* values) { *values = at.u[0] - at.u[1]; }}};
  }
  const std::vector<initial_data>& initial() const override { return initial_; }

 private:
  velocity_set velocities_{{{1.0, -1.0}}, {1.0, 1.0}};
  std::vector<initial_data> initial_ = {
      {"uniform", "f = (1, 1)", [](const position&, std::span<double> f) { f[0] = f[1] = 1.0; }}};
};

}  // namespace

extern const model_entry model_planted_exchange;
const model_entry model_planted_exchange = {
    .name = "planted-exchange",
    .description = "f+_t + f+_x = (rho/2 - f+)/epsilon, f-_t - f-_x = (rho/2 - f-)/epsilon",
    .source = "Goldstein, Quart. J. Mech. Appl. Math. 4 (1951)",
    .make = [](const model_config&) -> std::unique_ptr<model> {
      return std::make_unique<planted_exchange>();
    }};

}  // namespace apsis
