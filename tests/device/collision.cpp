#include "device_case.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/device/internal/device_collision.hpp>
#include <apsis/model/nearby_maxwellian.hpp>

#include <array>

#include <gmock/gmock.h>

namespace device_collision_test {

using apsis::aligned_vector;
using apsis::equilibrium_choice;
using apsis::field;
using apsis::stage_solution;
using apsis::velocity_grid;

struct variant {
  std::vector<int> points;  ///< velocities in every direction
  double max;
  bool by_viscosity;
  equilibrium_choice choice;
  std::vector<std::string> set = {};  ///< kind of velocities in every direction; empty: even velocities
  int degrees = 0;                    ///< degrees of freedom; 0: as many as directions
  double exponent = 0.5;              ///< viscosity exponent
  std::string model = "bgk";
  std::string tails = {};  ///< option of the model, if it has one

  std::string label() const {
    std::string text = model + " " + tails + (by_viscosity ? " viscosity" : " constant");
    for (const int n : points) text += " " + std::to_string(n);
    for (const auto& name : set) text += " " + name;
    return fmt::format("{}, {} degrees of freedom, exponent {}", text, degrees, exponent);
  }
};

std::unique_ptr<apsis::model> gas(const variant& of) {
  apsis::model_config config = apsis::default_config(apsis::find_model(of.model));
  config.velocity = {of.max, of.points, of.choice, of.set};
  config.parameters["velocity_dimensions"] = static_cast<double>(of.points.size());
  if (of.degrees > 0) config.parameters["degrees_of_freedom"] = of.degrees;
  if (of.by_viscosity) config.options["collision_rate"] = "viscosity";
  config.parameters["viscosity_exponent"] = of.exponent;
  if (!of.tails.empty()) config.options["tails"] = of.tails;
  return apsis::find_model(of.model).make(config);
}

/// Returns rows of two beams whose density, velocity and temperature change from cell to cell, with
/// components in all directions. Some cells are cold, nearly empty, or near the ends of the velocities,
/// where no formula gives the equilibrium. Internal energy is usual, absent, or larger than equal
/// velocities would allow.
field beams(const apsis::model& equation, int cells) {
  field u(cells, equation.components());
  const apsis::gas& molecules = equation.as_gas()->molecules();
  const int d = molecules.dimensions(), size = molecules.grid().size();
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < size; ++k) {
      const double T = i % 7 == 3 ? 0.01 : 0.5 + 0.04 * i;
      double of_first = 0.0, of_second = 0.0;
      for (int axis = 0; axis < d; ++axis) {
        const double v = equation.speeds(axis)[static_cast<std::size_t>(k)];
        const double centre = i % 11 == 5 ? 6.0 : (0.1 * i - 1.0) / (1.0 + axis);
        of_first += (v - centre) * (v - centre);
        of_second += (v + 0.5) * (v + 0.5);
      }
      const double rho = i % 13 == 6 ? 1e-290 : 1.0 + 0.1 * i;
      const double f = rho * (std::exp(-of_first / (2.0 * T)) + 0.3 * std::exp(-of_second / T));
      u.row(i)[k] = f;
      if (molecules.reduced()) u.row(i)[size + k] = (i % 8 == 1 ? 0.0 : i % 8 == 6 ? 500.0 : 1.5 * T) * f;
    }
  return u;
}

const std::vector<variant> variants = {
    {{40}, 8.0, false, equilibrium_choice::automatic},
    {{45}, 8.0, true, equilibrium_choice::automatic},
    {{150}, 15.0, false, equilibrium_choice::automatic},
    {{150}, 15.0, true, equilibrium_choice::formula},
    {{21}, 5.0, false, equilibrium_choice::formula},
    {{700}, 12.0, false, equilibrium_choice::automatic},
    // Fewer and more lines than a chain has. The columns end before, at and behind the end of an octet.
    {{40, 37}, 9.0, true, equilibrium_choice::automatic},
    {{13, 24}, 5.0, false, equilibrium_choice::formula},
    {{70, 5}, 5.0, true, equilibrium_choice::formula},
    {{9, 7, 10}, 5.0, true, equilibrium_choice::formula},
    {{24, 21, 26}, 8.0, false, equilibrium_choice::automatic},
    // Newton's method computes the equilibria, with even and other velocities.
    {{40}, 9.0, true, equilibrium_choice::discrete},
    {{22, 25}, 9.0, false, equilibrium_choice::discrete},
    {{16, 18, 17}, 9.0, false, equilibrium_choice::discrete},
    {{30}, 9.0, true, equilibrium_choice::automatic, {"graded"}},
    {{30}, 9.0, false, equilibrium_choice::formula, {"graded"}},
    {{20, 24}, 9.0, true, equilibrium_choice::automatic, {"graded"}},
    {{20, 24, 18}, 9.0, false, equilibrium_choice::automatic, {"graded", "uniform", "graded"}},
    // Gases with additional degrees of freedom, and with other viscosities than hard spheres.
    {{45}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.81},
    {{40}, 9.0, true, equilibrium_choice::discrete, {}, 5, 1.0},
    {{30}, 9.0, true, equilibrium_choice::automatic, {"graded"}, 3, 0.0},
    {{40, 37}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.74},
    {{22, 25}, 9.0, false, equilibrium_choice::discrete, {}, 3},
    {{20, 24}, 9.0, true, equilibrium_choice::automatic, {"graded"}, 5, 1.4},
    {{24, 21, 26}, 8.0, true, equilibrium_choice::automatic, {}, 5, 0.66},
    // The targets have a heat flux.
    {{45}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.81, "shakhov", "signed"},
    {{40}, 9.0, false, equilibrium_choice::discrete, {}, 3, 0.5, "shakhov", "nonnegative"},
    {{30}, 9.0, true, equilibrium_choice::automatic, {"graded"}, 3, 0.5, "shakhov", "signed"},
    {{40, 37}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.5, "shakhov", "signed"},
    {{22, 25}, 9.0, true, equilibrium_choice::discrete, {}, 3, 0.5, "shakhov", "nonnegative"},
    {{20, 24}, 9.0, true, equilibrium_choice::formula, {"graded"}, 3, 0.5, "shakhov", "signed"},
    {{24, 21, 26}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.5, "shakhov", "signed"},
    {{16, 18, 17}, 9.0, true, equilibrium_choice::discrete, {}, 3, 0.5, "shakhov", "nonnegative"},
    {{14, 12, 12}, 6.0, true, equilibrium_choice::automatic, {"graded"}, 3, 0.5, "shakhov", "signed"},
    // The targets have a stress.
    {{45}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.81, "es-bgk", "signed"},
    {{30}, 9.0, true, equilibrium_choice::automatic, {"graded"}, 3, 0.5, "es-bgk", "nonnegative"},
    {{40, 37}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.5, "es-bgk", "nonnegative"},
    {{20, 24}, 9.0, true, equilibrium_choice::automatic, {"graded"}, 3, 0.5, "es-bgk", "signed"},
    {{24, 21, 26}, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.5, "es-bgk", "nonnegative"},
    {{14, 12, 12}, 6.0, true, equilibrium_choice::automatic, {"graded"}, 3, 0.5, "es-bgk", "signed"},
};

TEST(device_collision, has_the_bits_of_the_host_in_every_order_of_lanes) {
  constexpr int cells = 37;
  for (const variant& of : variants) {
    const auto equation = gas(of);
    std::vector<double> epsilon;
    for (int i = 0; i < cells; ++i) epsilon.push_back(i % 5 == 0 ? 0.0 : std::pow(10.0, 2 - i % 9));
    const field u = beams(*equation, cells);
    const apsis::grid mesh = apsis::grid::line(cells, 0.0, 1.0);
    for (const auto& on : tested_devices()) {
      const auto host = apsis::make_pointwise_collision(*equation, epsilon);
      apsis::device_collision there(*on, *equation, epsilon, false, {}, stage_solution::implicit);
      for (const std::array<double, 2> step :
           {std::array{0.1, 0.0}, std::array{0.02, -0.01}, std::array{0.0, -3.0}}) {
        field here = u, away(cells, u.components(), on->memory()), back(cells, u.components());
        away.copy_rows(u);
        host->solve(0.0, step[0], step[1], here);
        there.solve(0.0, step[0], step[1], away);
        back.copy_rows(away);
        EXPECT_EQ(different_numbers(mesh, here, back), 0)
            << of.label() << ", a = " << step[0] << ", b = " << step[1];
      }
    }
  }
}

/// Returns the number of cells that the kernel leaves to the host.
long left_to_host(const apsis::model& equation, const field& u, double a = 0.1) {
  const auto& on = tested_device();
  apsis::device_collision there(*on, equation, std::vector<double>(static_cast<std::size_t>(u.cells()), 0.1),
                                false, {}, stage_solution::implicit);
  field away(u.cells(), u.components(), on->memory());
  away.copy_rows(u);
  there.solve(0.0, a, 0.0, away);
  return there.solved_on_host();
}

/// Newton's method from a Gaussian succeeds in all other cells.
TEST(device_collision, leaves_no_cells_to_the_host_but_those_far_from_a_gaussian) {
  constexpr int cells = 29;
  for (const variant& of : {variant{{80}, 16.0, false, equilibrium_choice::automatic},
                            variant{{60}, 16.0, false, equilibrium_choice::discrete},
                            variant{{72, 70}, 16.0, true, equilibrium_choice::automatic},
                            variant{{40, 44}, 16.0, true, equilibrium_choice::automatic, {"graded"}},
                            variant{{30, 28, 26}, 13.0, false, equilibrium_choice::discrete}}) {
    const auto equation = gas(of);
    const velocity_grid& grid = equation->as_gas()->molecules().grid();
    const field u = beams(*equation, cells);
    aligned_vector<double> m(static_cast<std::size_t>(u.stride()));
    int far = 0, formulas = 0;
    for (int i = 0; i < cells; ++i) {
      std::array<double, 5> omega{};
      equation->as_gas()->moments(u.row(i), omega.data());
      const apsis::fluid_state state = apsis::to_fluid_state(omega.data(), grid.dimensions());
      const bool formula =
          of.choice == equilibrium_choice::automatic && apsis::formula_has_exact_moments(grid, state);
      formulas += formula ? 1 : 0;
      far += formula || apsis::nearby_maxwellian(grid, state, m.data()) ? 0 : 1;
    }
    EXPECT_GT(far, 0) << of.label();
    EXPECT_LT(far + formulas, cells) << of.label();
    EXPECT_EQ(left_to_host(*equation, u), far) << of.label();
  }
}

/// If a gas is not far from equilibrium, the device finds its target. The host cuts tails that would make a
/// solution negative. The ellipsoidal target has such tails only in stages with a derivative.
class device_targets : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(models, device_targets, testing::Values("shakhov", "es-bgk"));

TEST_P(device_targets, are_found_on_the_device) {
  constexpr int cells = 19;
  long published = 0, with_cuts = 0;  // numbers of cells left to the host far from equilibrium
  for (const std::vector<int>& points : {std::vector<int>{40}, {26, 24}, {20, 18, 22}}) {
    variant of{points, 9.0, true, equilibrium_choice::automatic, {}, 3, 0.81, GetParam(), "signed"};
    const auto equation = gas(of);
    const apsis::gas& molecules = equation->as_gas()->molecules();
    field u(cells, equation->components());
    for (int i = 0; i < cells; ++i) {
      apsis::fluid_state hot, cold;
      hot.rho = 0.3;
      hot.u[0] = 0.4;
      hot.T = 1.6 + 0.02 * i;
      cold.rho = 1.0;
      cold.T = 0.9;
      aligned_vector<double> other(static_cast<std::size_t>(equation->components()));
      molecules.formula(hot, 1.0, u.row(i));
      molecules.formula(cold, 1.0, other.data());
      for (std::size_t k = 0; k < other.size(); ++k) u.row(i)[k] += other[k];
    }
    EXPECT_EQ(left_to_host(*equation, u), 0) << of.label();
    of.tails = "nonnegative";
    const auto cut = gas(of);
    EXPECT_EQ(left_to_host(*cut, u), 0) << of.label();
    const field far = beams(*cut, cells);
    published += left_to_host(*equation, far);
    with_cuts += left_to_host(*cut, far);
  }
  if (GetParam() == "shakhov") {
    EXPECT_GT(with_cuts, published);
  }
}

/// A block of lanes has cells of both ranges only if it confuses them.
TEST(device_collision, leaves_cells_outside_of_the_gas_as_they_are) {
  const auto equation = gas({{13, 24}, 5.0, false, equilibrium_choice::formula});
  constexpr int cells = 21;
  const std::vector<double> epsilon(cells, 0.1);
  const std::vector<apsis::cell_range> fluid = {{1, 3}, {7, 20}};
  const field u = beams(*equation, cells);
  const auto& on = tested_device();
  apsis::device_collision there(*on, *equation, epsilon, false, fluid, stage_solution::implicit);
  const auto host = apsis::make_pointwise_collision(*equation, epsilon, false, fluid);
  field here = u, away(cells, u.components(), on->memory()), back(cells, u.components());
  away.copy_rows(u);
  host->solve(0.0, 0.1, 0.0, here);
  there.solve(0.0, 0.1, 0.0, away);
  back.copy_rows(away);
  const apsis::grid mesh = apsis::grid::line(cells, 0.0, 1.0);
  EXPECT_EQ(different_numbers(mesh, here, back), 0);
  EXPECT_EQ(there.solved_on_host(), 0);
  EXPECT_GT(different_numbers(mesh, u, back).count, 0);
}

TEST(device_collision, rates_and_times_are_those_of_the_host) {
  const auto equation = gas(variants[1]);
  const std::vector<double> epsilon(6, 0.3);
  const field u = beams(*equation, 3);
  const auto& on = tested_device();
  const std::vector<double> three(3, 0.3);
  const auto host = apsis::make_pointwise_collision(*equation, three);
  apsis::device_collision there(*on, *equation, three, false, {}, stage_solution::implicit);
  field away(3, u.components(), on->memory());
  away.copy_rows(u);
  EXPECT_EQ(there.relaxation_time(away), host->relaxation_time(u));
  EXPECT_EQ(there.forward_euler_step(away), host->forward_euler_step(u));
  for (const bool fresh : {true, false}) {
    field here = u, acc = away, back(3, u.components());
    const apsis::target<field, double> to{&here, 0.5, 0.25, fresh}, to_device{&acc, 0.5, 0.25, fresh};
    host->add_collision(0.0, u, {&to, 1});
    there.add_collision(0.0, away, {&to_device, 1});
    back.copy_rows(acc);
    EXPECT_EQ(different_numbers(apsis::grid::line(3, 0.0, 1.0), here, back), 0);
  }
}

/// The host names the cell whose row has no equilibrium.
TEST(device_collision, fails_like_the_host_where_there_is_no_equilibrium) {
  const auto equation = gas(variants[0]);
  field u = beams(*equation, 5);
  for (int k = 0; k < u.components(); ++k) u.row(3)[k] = -1.0;
  const auto& on = tested_device();
  apsis::device_collision there(*on, *equation, std::vector<double>(5, 0.1), false, {},
                                stage_solution::implicit);
  field away(5, u.components(), on->memory());
  away.copy_rows(u);
  try {
    there.solve(0.0, 0.1, 0.0, away);
    FAIL() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, 3);
  }
}

TEST(device_collision, refuses_what_it_has_no_kernel_for) {
  const auto& on = tested_device();
  const auto make = [&](const apsis::model& equation, stage_solution stages) {
    apsis::device_collision(*on, equation, {0.1}, false, {}, stages);
  };
  const auto bgk = gas(variants[0]);
  const auto broadwell =
      apsis::find_model("broadwell").make(apsis::default_config(apsis::find_model("broadwell")));
  const auto refused = [&](auto change, const std::string& reason) {
    apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
    config.velocity = {5.0, 16, equilibrium_choice::automatic};
    config.parameters["velocity_dimensions"] = 2;
    change(config);
    const auto equation = apsis::find_model("bgk").make(config);
    EXPECT_THAT([&] { make(*equation, stage_solution::implicit); },
                testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr(reason)));
  };
  refused([](auto& config) { config.velocity.points = std::vector<int>{6200, 4}; }, "too many velocities");
  refused([](auto& config) { config.velocity.points = std::vector<int>{70000, 4}; }, "too many velocities");
  EXPECT_THAT(
      [&] { make(*broadwell, stage_solution::implicit); },
      testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("kernel of its collisions is missing")));
  EXPECT_THAT([&] { make(*bgk, stage_solution::exact); },
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("exact collisions")));
}

}  // namespace device_collision_test
