#include <apsis/boundary/face_value_error.hpp>
#include <apsis/boundary/heat_balance_wall.hpp>

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// A wall that radiates the heat ε σ (T_w⁴ − T_0⁴) to surroundings of temperature T_0, with the emissivity ε.
class radiating_wall final : public heat_balance_wall {
 public:
  radiating_wall(const model& equation, std::vector<face_quantity> velocity, face_quantity accommodation,
                 std::vector<face_quantity> of_radiation)
      : heat_balance_wall(equation, "radiating", std::move(velocity), std::move(accommodation)),
        of_radiation_(std::move(of_radiation)) {}

 private:
  radiation radiated(double t, const position& at) const override {
    const double emissivity = of_radiation_[0].at(t, at), sigma = of_radiation_[1].at(t, at),
                 surroundings = of_radiation_[2].at(t, at);
    if (!(emissivity >= 0.0 && emissivity <= 1.0))
      refuse_value(
          of_radiation_[0],
          fmt::format("the emissivity of {} is {:g} at {} (a number from 0 to 1 is needed); change it",
                      surface_of(of_radiation_[0], "a radiating wall"), emissivity,
                      time_and_point(of_radiation_[0], t, at)));
    for (const std::size_t k : {1U, 2U})
      if (const double value = k == 1U ? sigma : surroundings; !(value >= 0.0 && std::isfinite(value)))
        refuse_value(
            of_radiation_[k],
            fmt::format("'{}' of {} is {:g} at {} (it must not be negative); change it",
                        k == 1U ? "sigma" : "surroundings", surface_of(of_radiation_[k], "a radiating wall"),
                        value, time_and_point(of_radiation_[k], t, at)));
    return {emissivity * sigma, surroundings};
  }
  std::shared_ptr<heat_balance_wall> copy() const override { return std::make_shared<radiating_wall>(*this); }

  std::vector<face_quantity> of_radiation_;
};

constexpr dimension fourth_power_of_temperature =
    dimensions::temperature * dimensions::temperature * dimensions::temperature * dimensions::temperature;

}  // namespace

extern const boundary_entry boundary_radiating;
const boundary_entry boundary_radiating = {
    .name = "radiating",
    .description = "diffuse wall with the temperature at which it radiates the heat that it receives",
    .variables =
        [](const model& equation) {
          auto all = heat_balance_wall::variables(equation, "radiating");
          all.push_back({"emissivity", "fraction of the radiation of a black body, 0 to 1", 1, 1.0});
          all.push_back({"sigma",
                         "Stefan-Boltzmann constant (dimensionless, or 5.670374e-8 W/(m^2 K^4))",
                         1,
                         {},
                         dimensions::heat_flux / fourth_power_of_temperature});
          all.push_back({"surroundings",
                         "temperature of the surroundings, >= 0 (dimensionless)",
                         1,
                         {},
                         dimensions::temperature});
          return all;
        },
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      const auto begin = from.values.begin(), end = from.values.end();
      return std::make_unique<radiating_wall>(*from.equation, std::vector<face_quantity>(begin, end - 4),
                                              *(end - 4), std::vector<face_quantity>(end - 3, end));
    },
    .any_normal = true};

}  // namespace apsis
