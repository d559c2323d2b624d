#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/face_value_error.hpp>
#include <apsis/boundary/prescribed_state.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/gas_model.hpp>

#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Incoming components as functions of t, x and v: f, or g and h of a reduced gas.
class given_distribution final : public incoming_boundary {
 public:
  explicit given_distribution(std::vector<face_quantity> values) : values_(std::move(values)) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<given_distribution>(*this);
    own->velocities_ = velocities;
    own->enters_ = entering_components(where, velocities);
    return own;
  }

  void incoming(const face&, double t, const position& at, const double*, double* values) const override {
    const auto n = static_cast<std::size_t>(velocities_.size());
    for (std::size_t set = 0; set < values_.size(); ++set)
      for (std::size_t j = 0; j < n; ++j) {
        if (enters_[set * n + j] == 0.0) continue;
        position v{};
        for (int k = 0; k < velocities_.dimensions(); ++k)
          v[static_cast<std::size_t>(k)] = velocities_.speeds(k)[j];
        const double f = values_[set].at(t, at, v);
        if (!(f >= 0.0 && std::isfinite(f)))
          refuse_value(values_[set],
                       fmt::format("the distribution at {} is {:g} at {}, v_x = {:.6g} (not a finite number "
                                   ">= 0); change its formula",
                                   surface_of(values_[set], "a boundary 'given'"), f,
                                   time_and_point(values_[set], t, at), v[0]));
        values[set * n + j] = f;
      }
  }

 private:
  std::vector<face_quantity> values_;
  velocity_set velocities_;
  std::vector<double> enters_;
};

/// Incoming components of a model without a velocity grid, from its most detailed variables.
class given_components final : public incoming_boundary {
 public:
  explicit given_components(prescribed_state state) : state_(std::move(state)) {}

  void incoming(const face&, double t, const position& at, const double*, double* values) const override {
    state_.write(t, at, values);
  }

 private:
  prescribed_state state_;
};

data_form detailed_form(const model& equation) {
  auto forms = equation.data_forms();
  if (forms.empty())
    throw input_error(
        "boundary 'given' cannot be used (the model has no variables that prescribe a state); choose another "
        "kind, see: apsis list boundaries");
  return std::move(forms.back());
}

}  // namespace

extern const boundary_entry boundary_given;
const boundary_entry boundary_given = {
    .name = "given",
    .description = "components that enter are given, for a gas as a function of the velocity",
    .variables =
        [](const model& equation) {
          const gas_model* of = equation.as_gas();
          if (of == nullptr) return detailed_form(equation).variables;
          auto functions = of->molecules().distribution_form().variables;
          for (auto& one : functions) one.doc = "formula >= 0 in t, x and v_x, v_y, v_z (dimensionless)";
          return functions;
        },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      if (from.equation->as_gas() != nullptr) return std::make_unique<given_distribution>(from.values);
      return std::make_unique<given_components>(
          prescribed_state(detailed_form(*from.equation), from.values, from.equation->components()));
    }};

}  // namespace apsis
