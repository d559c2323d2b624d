// `apsis run --profile` lists exactly the kernels that the schedule of the method requires.
#include "program.hpp"

#include <apsis/integrate/schedule.hpp>
#include <apsis/method/method.hpp>

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace profile_test {

using namespace app_test;
using nlohmann::json;

namespace {

std::map<std::string, json> kernels_of(const std::string& formulation, const std::string& method,
                                       const std::string& threads) {
  work_folder folder;
  const outcome result = run_apsis(
      folder, {"run", "paper/bgk-mixed", "space.formulation=" + formulation, "time.method=" + method,
               "time.cfl=0.04", "time.end=0.002", "--profile", "--json", "--threads", threads});
  EXPECT_EQ(result.code, 0) << result.err;
  const json out = json::parse(result.out);
  std::map<std::string, json> kernels;
  for (const auto& kernel : out["profile"]["kernels"]) kernels[kernel["kernel"]] = kernel;
  kernels["run"] = out;
  return kernels;
}

}  // namespace

TEST(profile, counts_the_kernels_of_the_schedule) {
  constexpr double numbers = 40 * 152;  // rows of 150 velocities are padded to whole vectors
  for (const char* method : {"md-imex-3-2", "md-imex-6-3"}) {
    const apsis::schedule plan(apsis::find_method(method).coefficients<double>());
    for (const char* threads : {"1", "2"}) {
      auto points = kernels_of("finite-difference", method, threads);
      const double steps = points["run"]["steps"];
      const auto count = [&](const char* kernel) {
        return points[kernel]["numbers"].get<double>() / numbers / steps;
      };
      EXPECT_NEAR(count("edges"), plan.transport_evaluations(), 1e-9);
      EXPECT_NEAR(count("fluxes"), plan.transport_evaluations(), 1e-9);
      EXPECT_NEAR(count("equilibria"), plan.implicit_solves(), 1e-9);
      EXPECT_NEAR(count("relaxation"), plan.implicit_solves(), 1e-9);
      EXPECT_EQ(points.count("Gauss points"), 0U);

      auto averages = kernels_of("finite-volume", method, threads);
      const auto of_averages = [&](const char* kernel) {
        return averages[kernel]["numbers"].get<double>() / numbers / steps;
      };
      EXPECT_NEAR(of_averages("edges"), plan.transport_evaluations() + plan.implicit_solves(), 1e-9);
      EXPECT_NEAR(of_averages("Gauss points"), plan.implicit_solves(), 1e-9);
      EXPECT_NEAR(of_averages("equilibria"), 3 * plan.implicit_solves(), 1e-9) << "three points of a cell";
      EXPECT_GT(averages["edges"]["operations"].get<double>() / averages["edges"]["numbers"].get<double>(),
                points["edges"]["operations"].get<double>() / points["edges"]["numbers"].get<double>())
          << "both edges are more work than one";
    }
  }
}

TEST(profile, counts_walls_and_forces_where_there_are_some) {
  const auto kernels_in = [](const char* flow) {
    const work_folder folder;
    const json out =
        json::parse(run_apsis(folder, {"run", flow, "time.end=0.01", "--profile", "--json"}).out);
    std::map<std::string, json> kernels;
    for (const auto& kernel : out["profile"]["kernels"]) kernels[kernel["kernel"]] = kernel;
    return kernels;
  };
  const auto tube = kernels_in("gas/sod"), plates = kernels_in("gas/couette"),
             driven = kernels_in("gas/poiseuille");
  EXPECT_EQ(tube.count("walls"), 1U);  // both ends are open
  EXPECT_EQ(tube.count("forces"), 0U);
  EXPECT_GT(plates.at("walls")["numbers"].get<double>(), 0.0);
  EXPECT_EQ(plates.count("forces"), 0U);
  // A force acts on all numbers as often as the sweeps do.
  EXPECT_DOUBLE_EQ(driven.at("forces")["numbers"].get<double>(),
                   driven.at("fluxes")["numbers"].get<double>());
}

TEST(profile, is_a_table_after_the_summary_only_on_request) {
  work_folder folder;
  const outcome with = run_apsis(folder, {"run", "paper/bgk-mixed", "time.end=0.001", "--profile"});
  EXPECT_EQ(with.code, 0);
  EXPECT_THAT(with.out, testing::AllOf(testing::HasSubstr("of triad"), testing::HasSubstr("edges"),
                                       testing::HasSubstr("equilibria"), testing::HasSubstr("the rest")));
  const outcome without = run_apsis(folder, {"run", "paper/bgk-mixed", "time.end=0.001"});
  EXPECT_THAT(without.out, testing::Not(testing::HasSubstr("of triad")));
}

}  // namespace profile_test
