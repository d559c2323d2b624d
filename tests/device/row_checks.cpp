#include <apsis/device/row_checks.hpp>

#include "device_case.hpp"

#include <limits>

#include <gmock/gmock.h>

namespace device_row_checks_test {

using apsis::field;
using apsis::grid;

struct variant {
  std::vector<int> points;            ///< velocities in every direction
  std::vector<std::string> set = {};  ///< kind of velocities in every direction; empty: even velocities
  int degrees = 0;                    ///< degrees of freedom; 0: as many as directions
};

std::unique_ptr<apsis::model> gas(const variant& of, const std::string& name = "bgk") {
  apsis::model_config config = apsis::default_config(apsis::find_model(name));
  config.velocity = {8.0, of.points, apsis::equilibrium_choice::automatic, of.set};
  config.parameters["velocity_dimensions"] = static_cast<double>(of.points.size());
  if (of.degrees > 0) config.parameters["degrees_of_freedom"] = of.degrees;
  return apsis::find_model(name).make(config);
}

/// Returns rows with zeros of either sign, negative and very small numbers, and numbers that are not finite.
field odd_rows(const grid& mesh, const apsis::model& equation) {
  field u = varied_rows(mesh, equation, true);
  const double infinity = std::numeric_limits<double>::infinity();
  for (int i = 0; i < mesh.size(); ++i)
    for (int k = 0; k < u.components(); ++k) {
      double& x = u.row(i)[k];
      if (i % 8 == 1 && k % 5 == 2) x = -0.0;
      if (i % 8 == 2 && k % 3 == 0) x = k % 2 == 0 ? 0.0 : -0.0;
      if (i % 8 == 3 && k % 7 == 1) x = -1e-3 * k;
      if (i % 8 == 4) x = k % 2 == 0 ? 5e-324 : 1e-310;
      if (i % 16 == 5 && k == u.components() - 1) x = std::numeric_limits<double>::quiet_NaN();
      if (i % 16 == 13 && k == 0) x = -infinity;
    }
  return u;
}

TEST(device_row_checks, have_the_bits_of_the_host) {
  // On a line the velocities leave up to seven beyond whole octets. Some lines are longer than a
  // chain of additions.
  for (const variant& of : {variant{{21}},
                            {{40}},
                            {{150}},
                            {{700}},
                            {{30}, {"graded"}},
                            {{40}, {}, 3},
                            {{30}, {"graded"}, 5},
                            {{13, 24}},
                            {{20, 11}, {"graded", "uniform"}, 3},
                            {{9, 7, 10}},
                            {{10, 8, 12}, {"graded"}, 5}}) {
    const auto equation = gas(of);
    const grid mesh = grid::line(37, 0.0, 1.0).with_solids({{.first = {9, 0, 0}, .cells = {2, 1, 1}}});
    const field u = odd_rows(mesh, *equation);
    for (const auto& on : tested_devices()) {
      const auto checks = apsis::device_row_checks::make(*on, *equation, mesh);
      ASSERT_NE(checks, nullptr);
      field away(u.cells(), u.components(), on->memory());
      away.copy_rows(u);
      checks->evaluate(away);
      bit_differences found;
      for (const auto& [begin, end] : mesh.fluid())
        for (int cell = begin; cell < end; ++cell) {
          const auto there = checks->of(cell);
          const auto here = apsis::compute_extremes(u.row(cell), u.components());
          const auto compare = [&](double host, double device, const char* name) {
            found.compare(host, device, [&] { return fmt::format("{} of cell {}", name, cell); });
          };
          compare(here.lowest, there.extremes.lowest, "minimum");
          compare(double(here.negative), double(there.extremes.negative), "negative numbers");
          if (std::isnan(here.lowest)) continue;
          std::vector<double> densities(equation->invariants().size());
          equation->invariant_densities(u.row(cell), densities.data());
          for (std::size_t k = 0; k < densities.size(); ++k)
            compare(densities[k], there.densities[k], "density");
          if (here.negative == 0)
            compare(equation->entropy()->density(u.row(cell)), there.entropy, "entropy");
        }
      EXPECT_EQ(found, 0) << equation->components() << " components";
    }
  }
}

TEST(device_row_checks, squares_have_the_bits_of_the_host) {
  for (const int points : {21, 150}) {
    const auto equation = gas({{points}});
    const grid mesh = grid::line(37, 0.0, 1.0);
    const field u = varied_rows(mesh, *equation, true), v = varied_rows(mesh, *equation, false);
    for (const auto& on : tested_devices()) {
      field there(u.cells(), u.components(), on->memory()), other = there;
      there.copy_rows(u);
      other.copy_rows(v);
      const auto squares = apsis::compute_squares(*on, there, other);
      bit_differences found;
      for (int cell = 0; cell < u.cells(); ++cell) {
        const auto here = apsis::compute_squares(u.row(cell), v.row(cell), u.components());
        const auto& away = squares[static_cast<std::size_t>(cell)];
        const auto place = [&] { return fmt::format("cell {}", cell); };
        found.compare(here.difference, away.difference, place);
        found.compare(here.size, away.size, place);
      }
      EXPECT_EQ(found, 0) << points << " velocities";
    }
  }
}

/// Where a model has no kernel, the state is copied and checked on the host.
TEST(device_row_checks, are_those_of_a_gas) {
  const grid mesh = grid::line(4, 0.0, 1.0);
  EXPECT_NE(apsis::device_row_checks::make(*tested_device(), *gas({{40}}), mesh), nullptr);
  EXPECT_EQ(apsis::device_row_checks::make(*tested_device(), *gas({{5000}}), mesh), nullptr);
  const auto broadwell =
      apsis::find_model("broadwell").make(apsis::default_config(apsis::find_model("broadwell")));
  EXPECT_EQ(apsis::device_row_checks::make(*tested_device(), *broadwell, mesh), nullptr);
}

}  // namespace device_row_checks_test
