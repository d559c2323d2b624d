// Results of runs with two and three velocity dimensions have every component of the velocity.
#include "cases.hpp"
#include "same_results.hpp"
#include "xdmf_grids.hpp"

#include <apsis/config/case.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/run/records.hpp>
#include <apsis/run/session.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/folder.hpp>

namespace several_velocity_dimensions_test {

using namespace apsis;
using shape = hdf5_file::shape;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

namespace {

constexpr int cells = 6, points = 24;
constexpr double v_max = 9.0, spacing = 2.0 * v_max / points;

case_config gas(int dimensions) {
  case_config c = small("md-imex-3-2", "finite-difference");
  c.model.parameters["velocity_dimensions"] = dimensions;
  c.space.cells = {cells};
  c.velocity = {v_max, points, equilibrium_choice::automatic};
  c.time.end = 0.01;
  return c;
}

double node(std::size_t i) {
  return -v_max + (static_cast<double>(i) + 0.5) * spacing;
}

/// A gas that moves along all axes.
struct moving_gas {
  double rho, T;
  std::array<double, 3> u;

  explicit moving_gas(double x)
      : rho(1.0 + 0.2 * std::sin(std::numbers::pi * x)),
        T(1.1 + 0.1 * std::cos(std::numbers::pi * x)),
        u{0.3 * std::cos(std::numbers::pi * x), -0.4 * std::sin(std::numbers::pi * x), 0.25} {}

  /// Returns the factor of v_k in the Maxwellian. Times ρ it is the marginal.
  double along(std::size_t k, double v) const {
    return std::exp(-0.5 * (v - u.at(k)) * (v - u.at(k)) / T) / std::sqrt(2.0 * std::numbers::pi * T);
  }
};

/// Returns the Maxwellian of the gas in every cell, the first velocity component slowest.
std::vector<double> maxwellians(int dimensions, const std::vector<double>& x) {
  std::vector<double> f;
  const std::size_t n = points, second = dimensions > 1 ? n : 1, third = dimensions > 2 ? n : 1;
  for (const double centre : x) {
    const moving_gas g(centre);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < second; ++j)
        for (std::size_t k = 0; k < third; ++k)
          f.push_back(g.rho * g.along(0, node(i)) * (dimensions > 1 ? g.along(1, node(j)) : 1.0) *
                      (dimensions > 2 ? g.along(2, node(k)) : 1.0));
  }
  return f;
}

/// Writes the results of a run that stops in this state before its first step.
std::string results_of_moving_gas(const test_folder& folder, const case_config& c) {
  simulation run(c);
  auto saved = run.save();
  saved.unknowns =
      maxwellians(static_cast<int>(c.model.parameters.at("velocity_dimensions")), run.fields().x);
  run.restore(saved);
  write_checkpoint(folder / "start.h5", make_checkpoint(run, run_records(run)));
  session_options how;
  how.out = folder / "results";
  how.restart = folder / "start.h5";
  how.stop = [] { return true; };
  run_session(c, how).run();
  return folder / "results";
}

void run_into(const std::string& folder, const case_config& c, long steps = -1,
              const std::optional<std::string>& restart = {}) {
  session_options how;
  how.out = folder;
  how.restart = restart;
  long done = 0;
  how.watch = [&done](const simulation& now) { done = now.step(); };
  how.stop = [&done, steps] { return steps >= 0 && done >= steps; };
  run_session(c, how).run();
}

}  // namespace

TEST(several_velocity_dimensions, store_every_velocity_with_its_weight) {
  for (const int d : {2, 3}) {
    const test_folder folder;
    const auto file = hdf5_file::open(results_of_moving_gas(folder, gas(d)) + "/solution.h5");
    std::uint64_t total = 1;
    for (int k = 0; k < d; ++k) total *= points;
    EXPECT_EQ(file.extents("f"), (shape{cells, total}));
    EXPECT_EQ(file.extents("v"), (shape{total, static_cast<std::uint64_t>(d)}));
    EXPECT_EQ(file.extents("v_weights"), shape{total});
    const auto v = file.read("v"), weights = file.read("v_weights");
    for (std::size_t j = 0; j < total; ++j) {
      std::size_t rest = j;
      for (auto k = static_cast<std::size_t>(d); k-- > 0; rest /= points)
        ASSERT_NEAR(v[j * static_cast<std::size_t>(d) + k], node(rest % points), 1e-14);
      ASSERT_NEAR(weights[j], std::pow(spacing, d), 1e-14);
    }
    for (const std::string axis : {"v_x", "v_y", "v_z"}) {
      ASSERT_EQ(file.has(axis), axis != "v_z" || d == 3) << axis;
      if (!file.has(axis)) continue;
      const auto nodes = file.read(axis);
      ASSERT_EQ(nodes.size(), static_cast<std::size_t>(points));
      for (std::size_t i = 0; i < nodes.size(); ++i) EXPECT_NEAR(nodes[i], node(i), 1e-14);
    }
  }
}

TEST(several_velocity_dimensions, store_every_component_of_the_bulk_velocity) {
  for (const int d : {2, 3}) {
    const test_folder folder;
    const std::string results = results_of_moving_gas(folder, gas(d));
    const auto file = hdf5_file::open(results + "/solution.h5");
    EXPECT_FALSE(file.has("fields/u"));
    const auto x = file.read("x"), f = file.read("f"), weights = file.read("v_weights"), v = file.read("v");
    const std::vector<std::string> names = {"u_x", "u_y", "u_z"};
    for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
      const auto u = file.read("fields/" + names[k]);
      for (std::size_t i = 0; i < x.size(); ++i) {
        // With Δv = 3/4 and v_max = 9, truncation and aliasing are below 1e-12.
        EXPECT_NEAR(u[i], moving_gas(x[i]).u.at(k), 1e-11) << names[k] << " " << i;
        // Moments of the stored f with the stored velocities and weights are the same.
        double mass = 0.0, momentum = 0.0;
        for (std::size_t j = 0; j < weights.size(); ++j) {
          mass += weights[j] * f[i * weights.size() + j];
          momentum += weights[j] * v[j * static_cast<std::size_t>(d) + k] * f[i * weights.size() + j];
        }
        EXPECT_NEAR(momentum / mass, u[i], 1e-12) << names[k] << " " << i;
      }
    }
    const std::string header = d == 2 ? "x,rho,u_x,u_y,T,stress_xx," : "x,rho,u_x,u_y,u_z,T,stress_xx,";
    EXPECT_THAT(text_of(results + "/fields.csv"), testing::StartsWith(header));
  }
}

TEST(several_velocity_dimensions, store_marginals_of_f) {
  for (const int d : {2, 3}) {
    const test_folder folder;
    const auto file = hdf5_file::open(results_of_moving_gas(folder, gas(d)) + "/solution.h5");
    const auto x = file.read("x");
    const std::vector<std::string> names = {"v_x", "v_y", "v_z"};
    for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
      ASSERT_EQ(file.extents("marginals/" + names[k]), (shape{cells, points}));
      const auto marginal = file.read("marginals/" + names[k]);
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const moving_gas g(x[cell]);
        for (std::size_t i = 0; i < points; ++i)
          EXPECT_NEAR(marginal[cell * points + i], g.rho * g.along(k, node(i)), 1e-12) << names[k];
      }
    }
  }
}

TEST(several_velocity_dimensions, are_described_as_grids_with_monotone_axes) {
  const test_folder folder;
  for (const int d : {1, 2, 3}) {
    auto c = gas(d);
    c.output.every = 0.005;
    c.output.distribution = distribution_choice::snapshots;
    c.output.stride = 4;
    c.output.precision = precision_choice::single_precision;
    const std::string results = folder / std::to_string(d);
    run_into(results, c);
    const auto grids = checked_grids(results);
    EXPECT_EQ(of_name(grids, "fields").size(), 3U);
    const auto whole = of_name(grids, "distribution"), marginal = of_name(grids, "marginal_v_x");
    EXPECT_EQ(whole.size(), d < 3 ? 3U : 0U) << d;
    EXPECT_EQ(marginal.size(), d > 1 ? 3U : 0U) << d;
    EXPECT_EQ(of_name(grids, "marginal_v_z").size(), d > 2 ? 3U : 0U) << d;
    // The grid has two of six cells and all velocities.
    for (const auto& one : whole)
      EXPECT_EQ(one.points, (std::vector<std::size_t>{d == 1 ? 1U : 2U, d == 1 ? 2U : points, points}));
    for (const auto& one : marginal) EXPECT_THAT(one.points, ElementsAre(1, 2, points));
    EXPECT_EQ(text_of(results + "/solution.xdmf").find("too many for a grid") != std::string::npos, d == 3);
  }
}

TEST(several_velocity_dimensions, describe_no_grid_of_f_if_f_is_not_stored) {
  const test_folder folder;
  auto c = gas(2);
  c.output.distribution = distribution_choice::none;
  run_into(folder / "o", c);
  EXPECT_TRUE(of_name(checked_grids(folder / "o"), "distribution").empty());
  const auto file = hdf5_file::open(folder / "o/solution.h5");
  EXPECT_FALSE(file.has("f") || file.has("marginals"));
  EXPECT_TRUE(file.has("v") && file.has("v_x") && file.has("fields/u_y"));
}

TEST(several_velocity_dimensions, continue_from_a_checkpoint_with_all_fields) {
  const test_folder folder;
  auto c = gas(2);
  c.output.every = 0.004;
  c.output.distribution = distribution_choice::snapshots;
  run_into(folder / "whole", c);
  run_into(folder / "stopped", c, 3);
  run_into(folder / "resumed", c, -1, folder / "stopped/checkpoint.h5");
  const auto whole = hdf5_file::open(folder / "whole/solution.h5"),
             resumed = hdf5_file::open(folder / "resumed/solution.h5");
  ASSERT_EQ(whole.datasets(), resumed.datasets());
  EXPECT_TRUE(whole.has("snapshots/u_y"));
  for (const auto& name : whole.datasets())
    EXPECT_TRUE(same_bits(whole.read(name), resumed.read(name))) << name;
  EXPECT_EQ(text_of(folder / "whole/solution.xdmf"), text_of(folder / "resumed/solution.xdmf"));
  EXPECT_THAT(text_of(folder / "whole/history.csv"),
              HasSubstr(",conservation_momentum_x,conservation_momentum_y,"));
}

TEST(several_velocity_dimensions, keep_the_layout_of_one_velocity_dimension) {
  const test_folder folder;
  const std::string results = results_of_moving_gas(folder, gas(1));
  const auto file = hdf5_file::open(results + "/solution.h5");
  EXPECT_THAT(file.datasets(), ElementsAre("epsilon", "f", "fields/T", "fields/heat_flux", "fields/rho",
                                           "fields/u", "v", "x"));
  EXPECT_EQ(file.extents("v"), shape{points});
  EXPECT_THAT(text_of(results + "/solution.xdmf"),
              testing::AllOf(Not(HasSubstr("<!--")), HasSubstr("Dimensions=\"1 6 24\">solution.h5:/f<"),
                             HasSubstr("Dimensions=\"24\">solution.h5:/v<")));
}

}  // namespace several_velocity_dimensions_test
