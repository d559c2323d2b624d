// The temporal error of a discretised case refers to its exact solution in time.
#include <apsis/study/time_study.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/study/model_cases.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <paper/plateau_study.hpp>

namespace apsis::time_study_test {
namespace {

using namespace apsis::paper;

TEST(time_study, reference_is_what_fine_steps_of_every_method_converge_to) {
  for (const auto& model : relaxation_model_names()) {
    // First-order upwinding is linear. WENO weights that switch where data are flat would reduce the
    // order in time.
    const bool space = model != "ode";
    const time_study study(small_case(model, space ? std::vector<std::string>{"space.reconstruction=upwind1"}
                                                   : std::vector<std::string>{}),
                           0.1);
    const field exact = study.reference();
    for (const std::string name : {"md-imex-6-3", "ars-443"}) {
      const double coarse = largest_difference(study.solve(find_method(name), 128), exact);
      const double fine = largest_difference(study.solve(find_method(name), 256), exact);
      // The method has order 3. ε/C is about 20 steps, and the error at 256 steps is still three times that
      // of the reference.
      EXPECT_GT(std::log2(coarse / fine), 2.6) << model << " " << name << " " << coarse;
    }
  }
}

TEST(time_study, difference_from_a_state_with_nan_is_nan) {
  field u(2, 3);
  for (int cell = 0; cell < 2; ++cell) {
    field broken = u;
    broken.row(cell)[1] = std::nan("");
    EXPECT_TRUE(std::isnan(largest_difference(u, broken)) && std::isnan(largest_difference(broken, u)));
  }
}

TEST(time_study, epsilon_zero_keeps_equilibrium) {
  for (const auto& model : relaxation_model_names()) {
    const time_study study(small_case(model), 0.0);
    for (const double d : study.deviation(study.solve(find_method("md-imex-5-2"), 16)))
      ASSERT_LE(std::abs(d), 1e-13) << model;
  }
}

TEST(time_study, a_resolved_start_removes_the_error_of_the_layer) {
  const time_study study(load_case("paper/ode", {}), 1e-4);
  const field exact = study.reference();
  const auto moments = study.moments(exact);
  const auto error = [&](first_step first) {
    double largest = 0;
    const auto m = study.moments(study.solve(find_method("md-imex-4-2"), 512, start_data::given, first));
    for (std::size_t k = 0; k < m.size(); ++k) largest = std::max(largest, std::abs(m[k] - moments[k]));
    return largest;
  };
  EXPECT_GT(error(first_step::plain), 0.05 * 1e-4);
  EXPECT_LT(error(first_step::resolved), 0.2 * error(first_step::plain));
}

TEST(time_study, refuses_models_without_equilibrium) {
  EXPECT_THROW(time_study(load_case("paper/decay", {}), 1.0), input_error);
}

TEST(plateaus, a_wrong_prediction_is_detected) {
  // The constants of one method differ strongly from those observed for another.
  const auto second = analyse_intermediate_regime(find_method("md-imex-3-2").coefficients<double>());
  const auto seen = measured_ode_plateau(find_method("md-imex-6-3"), ode_data::inconsistent);
  EXPECT_GT(std::abs(predicted_ode_plateau(second, ode_data::inconsistent)[0] - seen[0]), 0.1);
}

}  // namespace
}  // namespace apsis::time_study_test
