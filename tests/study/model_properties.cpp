// Properties 2–5 of the paper for every model of the registry, including models added later. States are
// random. RapidCheck shrinks a counterexample.
#include <apsis/study/model_properties.hpp>

#include <apsis/core/errors.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace model_properties_test {

namespace {

/// Returns one of the model's initial data at a random position, disturbed by up to 90 % in every component.
/// It is nonnegative if negative components are unphysical (some published data are negative nevertheless).
std::vector<double> random_state(const apsis::model& m) {
  std::vector<double> u(static_cast<std::size_t>(m.components()));
  const auto& data = m.initial()[*rc::gen::inRange<std::size_t>(0, m.initial().size())];
  data.point_value({*rc::gen::inRange(0, 2000) * 1e-3}, u);
  for (double& value : u) value *= 1.0 + 0.9e-3 * *rc::gen::inRange(-1000, 1001);
  if (m.positive())
    for (double& value : u) value = std::abs(value);
  return u;
}

/// Checks a property of every relaxation model.
template <class Property>
void check_relaxations(const Property& property) {
  for (const auto& m : apsis::all_models())
    if (m.relaxation != nullptr)
      check_property(m.entry->name,
                     [&] { property(apsis::defects_of(*m.relaxation, random_state(*m.equation))); });
}

}  // namespace

// The tolerances are those of the claim. They cover rounding errors of sums of up to a hundred terms.
// Differences divide these errors by their step of 1e-2.
TEST(models, property_3_collisions_conserve_the_moments) {
  check_relaxations([](const auto& defects) { RC_ASSERT(defects.conservation <= 1e-13); });
}
TEST(models, property_4_equilibrium_is_where_the_collision_vanishes) {
  check_relaxations([](const auto& defects) { RC_ASSERT(defects.equilibrium <= 1e-13); });
}
TEST(models, property_5_derivative_along_the_collision_is_minus_rate_times_it) {
  check_relaxations([](const auto& defects) { RC_ASSERT(defects.derivative <= 1e-11); });
}

TEST(models, property_2_backward_euler_on_the_collision_keeps_every_value_nonnegative) {
  for (const auto& m : apsis::nonnegative_models()) {
    check_property(m.entry->name, [&] {
      auto u = random_state(*m.equation);
      for (double& value : u) value = *rc::gen::inRange(0, 5) == 0 ? 0.0 : std::abs(value);
      const double lambda = std::pow(10.0, *rc::gen::inRange(-12, 13));
      try {
        for (const double v : apsis::backward_euler_on_collision(*m.equation, u, lambda)) RC_ASSERT(v >= 0.0);
      } catch (const apsis::numerical_error&) {
        RC_DISCARD("no equilibrium");
      }
    });
  }
}

TEST(model_properties, an_equilibrium_that_does_not_conserve_breaks_all_three) {
  class wrong final : public apsis::relaxation_model {
   public:
    int components() const override { return 1; }
    int space_dimensions() const override { return 0; }
    int moment_count() const override { return 1; }
    void moments(const double* u, double* omega) const override { omega[0] = u[0]; }
    bool equilibrium(const double* omega, double* e) const override {
      e[0] = 1.001 * omega[0];
      return true;
    }
    double rate(const double*) const override { return 1.0; }
    std::string why_inadmissible(const double*) const override { return ""; }
    std::vector<std::string> invariants() const override { return {}; }
    void invariant_densities(const double*, double*) const override {}
    std::vector<apsis::field_group> fields() const override { return {}; }
    const std::vector<apsis::initial_data>& initial() const override { return none_; }

   private:
    std::vector<apsis::initial_data> none_;
  };
  const auto defects = apsis::defects_of(wrong(), {1.0});
  EXPECT_GT(defects.conservation, 1e-4);
  EXPECT_GT(defects.equilibrium, 1e-4);
  EXPECT_GT(defects.derivative, 1e-4);
}

}  // namespace model_properties_test
