// A kind of integrator: a step is two steps of half its length by implicit-explicit Euler.
#include <apsis/method/certificate.hpp>
#include <apsis/method/integrator_kind_registry.hpp>

namespace apsis {
namespace planted_halves_kind {
namespace {

class halves final : public time_integrator {
 public:
  halves()
      : rows_(parse_method(R"(name = "planted-halves"
title = "two steps of half the length"
citation = "none"
kind = "imex"
[claims]
order = 1
[shu_osher]
r = "2"
P = [[], ["0"], ["0", "0"]]
W = [[], ["1"], ["0", "1"]]
d = ["0", "1/2", "1/2"]
ddot = ["0", "0", "0"]
)",
                           "planted")) {
    name = rows_.name;
    title = rows_.title;
    kind = "planted-halves";
    order = 1;
    stages = 2;
    ssp_coefficient = 2.0;
    form = rows_.coefficients<double>();
  }
  const method& starter() const override { return find_method("forward-backward-euler"); }
  amplification growth() const override { return amplification(rows_); }
  rate_errors errors_at(double z) const override { return rate_errors_at(rows_, z); }
  integrator_certificate certify() const override {
    const certificate c = apsis::certify(rows_);
    return {.facts = {{"order", c.order}, {"ssp_coefficient", ssp_coefficient}},
            .lines = {{"order", std::to_string(c.order)}},
            .failures = c.failures};
  }

 private:
  method rows_;
};

std::vector<std::string> names() {
  return {"planted-halves"};
}

std::unique_ptr<time_integrator> make(const std::string&) {
  return std::make_unique<halves>();
}

}  // namespace
}  // namespace planted_halves_kind

extern const integrator_kind_entry integrator_kind_planted_halves;
const integrator_kind_entry integrator_kind_planted_halves = {.name = "planted-halves",
                                                              .description = "two steps of half the length",
                                                              .formulas = planted_halves_kind::names,
                                                              .of_formula = planted_halves_kind::make};

}  // namespace apsis
