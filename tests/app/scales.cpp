// The command `apsis scales`, and reports and files in SI units.
#include "program.hpp"

#include <apsis/output/hdf5_file.hpp>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace scales_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

namespace {

TEST(scales, prints_a_gas_and_every_knudsen_number) {
  const work_folder folder;
  const outcome text = run_apsis(folder, {"scales", "gas/micro-channel", "gas.pressure=1 Pa"});
  EXPECT_EQ(text.code, 0) << text.err;
  for (const char* line :
       {"gas                   argon\n", "pressure              1 Pa\n", "viscosity_exponent    0.81\n",
        "Kn, mean-speed        911.4", "lambda = mu sqrt(8 R T/pi)/p\n"})
    EXPECT_THAT(text.out, HasSubstr(line));
  const json numbers = json::parse(run_apsis(folder, {"scales", "gas/micro-channel", "--json"}).out);
  EXPECT_EQ(numbers["gas"], "argon");
  EXPECT_EQ(numbers["pressure"]["unit"], "Pa");
  EXPECT_EQ(numbers["pressure"]["value"], 2000.0);
  EXPECT_NEAR(
      numbers["knudsen_equivalent"]["value"].get<double>() * numbers["rarefaction"]["value"].get<double>(),
      1.0, 1e-14);
}

TEST(scales, of_a_case_without_a_gas_are_the_knudsen_numbers) {
  const work_folder folder;
  const json numbers =
      json::parse(run_apsis(folder, {"scales", "gas/sod", "model.rarefaction=4", "--json"}).out);
  EXPECT_NEAR(numbers["epsilon"].get<double>(), 0.25 / std::sqrt(2.0), 1e-16);
  EXPECT_FALSE(numbers.contains("gas"));
}

TEST(scales, results_in_si_units_name_their_units) {
  const work_folder folder;
  const std::vector<std::string> arguments = {
      "run", "gas/micro-channel", "time.end=0.2 ns", "output.every=0.05 ns", "velocity.points=16", "--out",
      "r"};
  const outcome text = run_apsis(folder, arguments);
  ASSERT_EQ(text.code, 0) << text.err;
  for (const char* said :
       {"complete at t = 2e-10 s after", "e-11 s\n", " Pa, energy ", " W/m^2\n", "kg/(m^2 s), momentum ",
        "  Kn, vhs               0.276223", "  gas                   argon\n"})
    EXPECT_THAT(text.out, HasSubstr(said));
  const json manifest = json::parse(read(folder.path() / "r/manifest.json"));
  EXPECT_EQ(manifest["units"]["t"], "s");
  EXPECT_EQ(manifest["units"]["heat_flux"], "W/m^2");
  EXPECT_EQ(manifest["units"]["flux_left_momentum"], "Pa");
  EXPECT_EQ(manifest["scales"]["gas"], "argon");
  EXPECT_NEAR(manifest["result"]["t"].get<double>(), 2e-10, 1e-24);
  EXPECT_EQ(manifest["case"]["gas"]["pressure"], "2 kPa");
  const auto solution = apsis::hdf5_file::open((folder.path() / "r/solution.h5").string());
  EXPECT_NEAR(solution.read("x").back(), 9.75e-6, 1e-18);
  EXPECT_NEAR(solution.read("snapshots/t").back(), 2e-10, 1e-24);
  EXPECT_NEAR(solution.read_attribute("t"), 2e-10, 1e-24);
  EXPECT_NEAR(solution.read("fields/T").at(10), 325.0, 5.0);

  // A checkpoint of results in SI units continues like any other.
  std::vector<std::string> longer = arguments;
  longer[2] = "time.end=0.3 ns";
  longer.back() = "whole";
  ASSERT_EQ(run_apsis(folder, longer).code, 0);
  longer.back() = "continued";
  longer.insert(longer.end(), {"--restart", "r/checkpoint.h5"});
  const outcome continued = run_apsis(folder, longer);
  ASSERT_EQ(continued.code, 0) << continued.err;
  EXPECT_EQ(read(folder.path() / "whole/history.csv"), read(folder.path() / "continued/history.csv"));
  EXPECT_EQ(read(folder.path() / "whole/fields.csv"), read(folder.path() / "continued/fields.csv"));
}

TEST(scales, results_of_a_gas_are_dimensionless_by_default) {
  const work_folder folder;
  const outcome text = run_apsis(folder, {"run", "gas/micro-channel", "output.units=dimensionless",
                                          "time.end=0.1 ns", "velocity.points=16", "--out", "r"});
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, testing::Not(HasSubstr(" Pa, energy ")));
  const json manifest = json::parse(read(folder.path() / "r/manifest.json"));
  EXPECT_FALSE(manifest.contains("units"));
  EXPECT_TRUE(manifest.contains("scales"));
  EXPECT_NEAR(apsis::hdf5_file::open((folder.path() / "r/solution.h5").string()).read("fields/T").at(10),
              325.0 / 300.0, 0.02);
}

}  // namespace

}  // namespace scales_test
