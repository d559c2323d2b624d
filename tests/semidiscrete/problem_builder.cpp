// Problems built from C++ objects without a case: their operators, and refused inputs.
#include <apsis/semidiscrete/problem_builder.hpp>

#include "bgk_case.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/broadwell_as_general_model.hpp>

namespace problem_builder_test {

namespace {

using apsis::grid;
using apsis::position;
using apsis::problem_builder;

std::shared_ptr<const apsis::reconstruction> weno() {
  return apsis::find_reconstruction("weno5-z").make();
}

std::unique_ptr<apsis::model> made(const std::string& name) {
  const auto* entry = apsis::try_find_model(name);
  return entry->make(apsis::default_config(*entry));
}

/// The smallest model on a mesh in the plane has two directions and one component of velocity (1, 0.5).
class plane_wave final : public apsis::relaxation_model {
 public:
  int components() const override { return 1; }
  int space_dimensions() const override { return 2; }
  const apsis::velocity_set& velocities() const override {
    static const apsis::velocity_set one({{1.0}, {0.5}}, {1.0});
    return one;
  }
  int moment_count() const override { return 1; }
  void moments(const double* u, double* omega) const override { *omega = *u; }
  bool equilibrium(const double* omega, double* e) const override { return *e = *omega, true; }
  double rate(const double*) const override { return 1.0; }
  std::string why_inadmissible(const double*) const override { return ""; }
  std::vector<std::string> invariants() const override { return {"mass"}; }
  void invariant_densities(const double* u, double* densities) const override { *densities = *u; }
  std::vector<apsis::field_group> fields() const override {
    return {{{{"u", "u"}}, [](const apsis::field_point& at, double* values) { *values = *at.u; }}};
  }
  const std::vector<apsis::initial_data>& initial() const override { return none_; }

 private:
  std::vector<apsis::initial_data> none_;
};

}  // namespace

TEST(problem_builder, cell_averages_are_exact_between_jumps_and_point_values_are_samples) {
  const auto m = made("relaxation");
  problem_builder builder(*m);
  builder.on(grid::line(5, 0.0, 1.0));
  const auto data = [](const position& x, std::span<double> u) {
    u[0] = u[1] = x[0] < 0.5 ? x[0] * x[0] : 2.0;
  };
  const auto averages = builder.sample(data, {0.5});
  // ∫ x² over [0, 0.2] is 0.2³/3. The jump is in the middle of the third cell, [0.4, 0.6].
  EXPECT_NEAR(averages.row(0)[0], 0.04 / 3.0, 1e-16);
  EXPECT_NEAR(averages.row(2)[1], (0.125 - 0.064) / 3.0 / 0.2 + 1.0, 1e-15);
  const auto points = builder.with_discretization("finite-difference").sample(data, {0.5});
  EXPECT_EQ(points.row(0)[0], 0.1 * 0.1);
  EXPECT_EQ(points.row(2)[0], 2.0);
}

TEST(problem_builder, data_and_epsilon_are_functions_of_position_in_the_plane) {
  const plane_wave m;
  const grid mesh(2, {9, 11, 1}, {0.0, 10.0, 0.0}, {0.9, 11.1, 0.0});
  problem_builder builder(m);
  builder.on(mesh)
      .with_discretization("finite-difference")
      .with_reconstruction(weno())
      .with_epsilon([](const position& x) { return x[0] + 100.0 * x[1] + 1e4 * x[2]; });
  const auto u =
      builder.sample([](const position& x, std::span<double> value) { value[0] = x[0] - x[1] + x[2]; });
  const auto epsilon = builder.epsilon_at_centres();
  for (int cell = 0; cell < mesh.size(); ++cell) {
    EXPECT_EQ(u.row(cell)[0], mesh.centre(cell, 0) - mesh.centre(cell, 1));
    EXPECT_EQ(epsilon[static_cast<std::size_t>(cell)], mesh.centre(cell, 0) + 100.0 * mesh.centre(cell, 1));
  }
  // T(x − y) = −(1 − 0.5) away from the faces, because the reconstruction is exact for linear data.
  const auto problem = builder.build();
  apsis::field t(mesh.size(), 1);
  const apsis::target<apsis::field, double> to{&t, 0.0, 1.0, true};
  problem->add_transport(0.0, u, {&to, 1});
  EXPECT_NEAR(t.row(4 * 11 + 5)[0], -0.5, 1e-12);
  // For κ = 1, 1/Δt_FE = 1/0.1 + 0.5/0.1.
  EXPECT_NEAR(problem->forward_euler_step(0.0, u), 1.0 / 15.0, 1e-12);
}

TEST(problem_builder, refuses_inconsistent_parts) {
  const auto m = made("relaxation"), ode = made("ode");
  const auto bgk = small_bgk();
  const grid line = grid::line(9, 0.0, 1.0);
  bad_input::expect_refused({
      {[&] { problem_builder(*ode).on(line); }, {"a mesh of 1 dimensions (the model has 0)"}},
      {[&] { problem_builder(*m).on(grid(2, {9, 9, 1}, {0, 0, 0}, {1, 1, 1})); },
       {"a mesh of 2 dimensions (the model has 1)"}},
      {[&] { problem_builder(*m).build(); }, {"no mesh"}},
      {[&] { problem_builder(*m).on(line).build(); }, {"no reconstruction"}},
      {[&] { problem_builder(*m).on(grid::line(4, 0.0, 1.0)).with_reconstruction(weno()); },
       {"a mesh of 4 cells is smaller than the stencil (5 cells); give at least 5"}},
      {[&] { problem_builder(*m).with_positivity_limiter(); }, {"the positivity limiter cannot be used"}},
      {[&] { problem_builder(*m).with_boundary({0, false}, apsis::make_boundary("outflow")); },
       {"call on() first"}},
      {[&] {
         problem_builder(*m)
             .on(line)
             .with_reconstruction(weno())
             .with_boundary({0, true}, apsis::make_boundary("outflow"))
             .build();
       },
       {"only one face of direction 1 is periodic"}},
  });
  for (const double epsilon : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    bad_input::expect_refused({
        {[&] {
           problem_builder(*bgk)
               .on(line)
               .with_reconstruction(weno())
               .with_epsilon([&](const position&) { return epsilon; })
               .build();
         },
         {"a finite number >= 0 is needed"}},
    });
  const plane_wave plane;
  bad_input::expect_refused({
      {[&] {
         problem_builder(plane)
             .on(grid(2, {9, 9, 1}, {0, 0, 0}, {1, 1, 1}))
             .with_discretization("finite-volume")
             .with_reconstruction(weno())
             .build();
       },
       {"cell averages in 2 space dimensions"}},
  });
}

TEST(problem_builder, an_equation_without_space_needs_no_mesh) {
  const auto ode = made("ode");
  problem_builder builder(*ode);
  const auto problem = builder.with_epsilon([](const position&) { return 0.0; }).build();
  auto u = builder.sample([](const position&, std::span<double> value) { value[0] = 2.0, value[1] = 0.0; });
  problem->solve_collision(0.0, 1.0, 0.0, u);
  EXPECT_DOUBLE_EQ(u.row(0)[1], std::sin(2.0));  // ε = 0: the equilibrium sin u₁ of the paper's model
}

TEST(problem_builder, collisions_of_exponential_methods_are_exact_where_the_model_knows_them) {
  const auto ode = made("ode"), decay = made("decay");
  problem_builder builder(*ode);
  const auto problem =
      builder.with_epsilon([](const position&) { return 0.5; }).with_exact_collision().build();
  auto u = builder.sample([](const position&, std::span<double> value) { value[0] = 2.0, value[1] = 0.0; });
  problem->solve_collision(0.0, 0.1, 0.0, u);
  // The exact solution is that of u₂' = 5 (sin 2 − u₂)/ε after a time of 0.1.
  EXPECT_DOUBLE_EQ(u.row(0)[1], std::sin(2.0) * (1.0 - std::exp(-1.0)));
  bad_input::expect_refused({
      {[&] { problem_builder(*decay).with_exact_collision(); },
       {"methods with exact collisions cannot integrate this model (it has no collisions in closed form); "
        "choose an IMEX method"}},
  });
}

TEST(problem_builder, a_general_model_on_a_mesh_agrees_with_its_closed_form) {
  const auto closed = made("broadwell");
  const broadwell_as_general_model general;
  for (const auto unknowns : {"finite-volume", "finite-difference"}) {
    const auto solve = [&](const apsis::model& equation) {
      problem_builder builder(equation);
      builder.on(grid::line(20, -1.0, 1.0))
          .with_reconstruction(weno())
          .with_discretization(unknowns)
          .with_epsilon([](const position& x) { return 1e-3 + x[0] * x[0]; });
      const auto problem = builder.build();
      auto u = builder.sample([](const position& x, std::span<double> f) {
        f[0] = 0.7 + 0.2 * std::sin(3.0 * x[0]);
        f[1] = 0.3 + 0.1 * std::cos(2.0 * x[0]);
        f[2] = 0.4;
      });
      problem->solve_collision(0.0, 0.05, -0.001, u);
      apsis::field v = u;
      const apsis::target<apsis::field, double> to{&v, 1.0, 1e-4, true};
      problem->add_collision(0.0, u, {&to, 1});
      return v;
    };
    const auto u = solve(*closed), v = solve(general);
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < 3; ++k)
        // Newton's method leaves a residual of rounding size. Q/epsilon multiplies it by up to 1e3.
        ASSERT_NEAR(v.row(cell)[k], u.row(cell)[k], 1e-11) << cell << " " << k;
  }
}

}  // namespace problem_builder_test
