// The production code agrees with the limit scheme, for every relaxation model and every IMEX method.
#include <apsis/study/limit_distance.hpp>

#include "limit_cases.hpp"

#include <apsis/integrate/stepper.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/study/limit_scheme.hpp>

#include <cmath>
#include <random>

#include <support/property.hpp>

namespace limit_distance_test {

using namespace apsis;

namespace {

// The programs sum in different order. Stages have |d| up to 2, there are four steps, and values are
// of order one.
constexpr double round_off = 1e-13;

const std::vector<double> epsilons = [] {
  auto values = geometric(1e-4, 1e-12, 9);
  values.push_back(0.0);
  return values;
}();

limit_table table_of(const std::string& model, const std::string& method, const std::string& formulation,
                     limit_start start = limit_start::given, const std::vector<std::string>& overrides = {}) {
  return limit_distance(small_case(model, method, formulation, overrides), epsilons, start);
}

constexpr auto columns = {&limit_row::moments_first, &limit_row::moments_end, &limit_row::state_first,
                          &limit_row::state_end};

}  // namespace

TEST(limit_distance, falls_at_least_linearly_to_rounding_for_all_models_and_methods_from_any_data) {
  for (const auto& model : relaxation_model_names())
    for (const auto& method : preserving_methods())
      for (const auto& formulation : formulation_names(model)) {
        SCOPED_TRACE(model + " " + method + " " + formulation);
        const limit_table table = table_of(model, method, formulation);
        EXPECT_GT(table.off_equilibrium, 1e-2);  // otherwise not tested
        // Without GSA only the moments are guaranteed to converge.
        const bool state = find_certificate(method).gsa;
        for (const auto column : columns) {
          if (!state && (column == &limit_row::state_first || column == &limit_row::state_end)) continue;
          EXPECT_LE(table.floor(column), round_off);
          EXPECT_GT(table.rows.front().*column, 1e3 * round_off);  // epsilon = 1e-4 is resolved
          const auto slope = table.slope(column);
          ASSERT_TRUE(slope.has_value());
          EXPECT_GE(*slope, 0.9);
        }
      }
}

TEST(limit_distance, is_rounding_for_one_step_at_epsilon_zero_from_rough_data) {
  // The data jump from cell to cell and in every component, so limiters are active.
  const auto models = relaxation_model_names();
  const auto methods = preserving_methods();
  check_property("production step at epsilon = 0 is a step of the limit scheme", [&] {
    const auto model = *rc::gen::elementOf(models);
    const auto method = *rc::gen::elementOf(methods);
    const auto formulation = *rc::gen::elementOf(formulation_names(model));
    std::vector<std::string> overrides = {"model.epsilon=0"};
    // Unknowns of both signs have no limiter.
    const bool limits =
        !formulation.empty() && run_setup(small_case(model, method, formulation)).equation->positive();
    if (limits) overrides.push_back(*rc::gen::element("space.limiter=none", "space.limiter=positivity"));
    const run_setup setup(small_case(model, method, formulation, overrides));
    std::mt19937 random(*rc::gen::arbitrary<unsigned>());
    const field smooth = setup.initial_state();
    field u = smooth;
    for (int i = 0; i < u.cells(); ++i) {
      const double* from = smooth.row(std::uniform_int_distribution<int>(0, u.cells() - 1)(random));
      for (int k = 0; k < u.components(); ++k)
        u.row(i)[k] = from[k] * std::uniform_real_distribution<>(0.7, 1.3)(random);
    }
    const auto problem = setup.make_problem();
    stepper<semidiscrete_problem> production(setup.integrator().starter(), *problem);
    limit_scheme scheme(small_case(model, method, formulation, overrides));
    scheme.start(values(u));
    production.step(0.0, 0.005, u);
    scheme.step(0.005);
    const auto got = scheme.moments_of(values(u)), wanted = scheme.moments();
    // Between rough data the weights of WENO slightly amplify rounding errors.
    for (std::size_t k = 0; k < got.size(); ++k) RC_ASSERT(std::abs(got[k] - wanted[k]) < 1e-12);
  });
}

TEST(limit_distance, falls_with_first_order_upwind_and_with_other_weights) {
  for (const auto& model : relaxation_model_names())
    for (const std::string scheme : {"upwind1", "weno5-js"}) {
      if (formulation_names(model).front().empty()) continue;
      SCOPED_TRACE(model + " " + scheme);
      const limit_table table = table_of(model, "md-imex-3-2", "finite-volume", limit_start::given,
                                         {"space.reconstruction=" + scheme});
      for (const auto column : columns) EXPECT_LE(table.floor(column), round_off);
    }
}

TEST(limit_distance, fits_slopes_only_where_the_distance_is_above_rounding) {
  limit_table table;
  table.dt = 1.0;
  for (const double eps : geometric(1.0, 1e-10, 11))
    table.rows.push_back({eps, 3.0 * eps * eps + 1e-16, std::max(eps, 1e-5), 0.0, 1.0});
  EXPECT_NEAR(table.slope(&limit_row::moments_first).value(), 2.0, 1e-3);
  EXPECT_FALSE(table.slope(&limit_row::state_first).has_value());
  EXPECT_NEAR(table.slope(&limit_row::state_end).value(), 0.0, 1e-12);
  EXPECT_EQ(table.floor(&limit_row::moments_end), 1e-5);
}

}  // namespace limit_distance_test
