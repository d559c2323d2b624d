#include <apsis/boundary/heat_balance_wall.hpp>

#include <memory>
#include <utility>

namespace apsis {
namespace {

/// A wall that exchanges no heat with the gas.
class adiabatic_wall final : public heat_balance_wall {
 public:
  using heat_balance_wall::heat_balance_wall;

 private:
  radiation radiated(double, const position&) const override { return {}; }
  std::shared_ptr<heat_balance_wall> copy() const override { return std::make_shared<adiabatic_wall>(*this); }
};

}  // namespace

extern const boundary_entry boundary_adiabatic;
const boundary_entry boundary_adiabatic = {
    .name = "adiabatic",
    .description = "diffuse wall with the temperature at which no heat crosses it",
    .variables = [](const model& equation) { return heat_balance_wall::variables(equation, "adiabatic"); },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      std::vector<face_quantity> velocity(from.values.begin(), from.values.end() - 1);
      return std::make_unique<adiabatic_wall>(*from.equation, "adiabatic", std::move(velocity),
                                              from.values.back());
    },
    .any_normal = true};

}  // namespace apsis
