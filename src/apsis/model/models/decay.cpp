#include <apsis/model/general_model.hpp>
#include <apsis/model/model_registry.hpp>

#include <cmath>

namespace apsis {
namespace {

/// The equation u' = −k u² (paper, numerical tests of the implicit methods: k = 10, u(0) = 10). The exact
/// solution is u₀/(1 + k u₀ t), and Q̇ = 2k²u³. Dimensionless.
class decay_model final : public general_model {
 public:
  explicit decay_model(const model_config& config) : rate_(config.parameters.at("rate")) {
    const double start = config.parameters.at("u0");
    const double k = rate_;
    initial_ = {{"start", "u(0) = u0", [start](const position&, std::span<double> u) { u[0] = start; },
                 [start, k](double t, const position&, std::span<double> u) {
                   u[0] = start / (1.0 + k * start * t);
                 }}};
  }

  int components() const override { return 1; }
  int space_dimensions() const override { return 0; }
  void collision(const number* u, number* q) const override { q[0] = -rate_ * u[0] * u[0]; }
  /// Negative solutions are admissible, so that runs show which methods violate positivity.
  bool admissible(const double* u) const override { return std::isfinite(u[0]); }
  bool positive() const override { return true; }

  std::vector<std::string> invariants() const override { return {}; }
  void invariant_densities(const double*, double*) const override {}
  std::vector<field_group> fields() const override {
    return {
        {{{"u", "u (dimensionless)"}}, [](const field_point& at, double* values) { values[0] = at.u[0]; }}};
  }
  const std::vector<initial_data>& initial() const override { return initial_; }
  std::vector<data_form> data_forms() const override {
    return {{"state", {{"u", "u (dimensionless)"}}, [](std::span<const double> given, std::span<double> u) {
               u[0] = given[0];
               return std::string();
             }}};
  }

 private:
  double rate_;
  std::vector<initial_data> initial_;
};

}  // namespace

extern const model_entry model_decay;
const model_entry model_decay = {
    .name = "decay",
    .description = "u' = -k u^2/epsilon, solved by Newton's method with automatic derivatives",
    .source = "Gottlieb, Grant, Hu, Shu, numerical tests of the implicit methods",
    .parameters =
        {{.name = "rate", .value = 10.0, .lowest = 0.0, .highest = 1e300, .doc = "k (dimensionless)"},
         {.name = "u0", .value = 10.0, .lowest = 0.0, .highest = 1e300, .doc = "u(0) (dimensionless)"}},
    .make = [](const model_config& config) -> std::unique_ptr<model> {
      return std::make_unique<decay_model>(config);
    }};

}  // namespace apsis
