#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/prescribed_state.hpp>
#include <apsis/core/errors.hpp>

#include <utility>

namespace apsis {
namespace {

/// Returns the preferred form of data of a model.
data_form form_of(const model& equation) {
  const auto forms = equation.data_forms();
  if (forms.empty())
    throw input_error(
        "boundary 'inflow' cannot be used (the model has no variables that prescribe a state); choose "
        "another "
        "kind, see: apsis list boundaries");
  return forms.front();
}

/// The incoming components are those of a given state; outgoing ones leave.
class inflow_boundary final : public incoming_boundary {
 public:
  explicit inflow_boundary(prescribed_state state) : state_(std::move(state)) {}

  void incoming(const face&, double t, const position& at, const double*, double* values) const override {
    state_.write(t, at, values);
  }

 private:
  prescribed_state state_;
};

}  // namespace

extern const boundary_entry boundary_inflow;
const boundary_entry boundary_inflow = {
    .name = "inflow",
    .description = "components that enter are those of a given state (a Maxwellian), the others leave",
    .variables = [](const model& equation) { return form_of(equation).variables; },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      return std::make_unique<inflow_boundary>(
          prescribed_state(form_of(*from.equation), from.values, from.equation->components()));
    }};

}  // namespace apsis
