// Every discretization of the registry, and transport as an interface.
#include "bgk_case.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace discretization_test {

namespace {

using apsis::cell_unknown;
using apsis::discretization_entry;
using apsis::field;
using apsis::grid;

constexpr double pi = std::numbers::pi;

/// Returns the unknowns of a function of x with one component on [0, 2].
std::vector<double> unknowns_of(const cell_unknown& unknown, int cells, double (*f)(double x)) {
  const grid mesh = grid::line(cells, 0.0, 2.0);
  std::vector<double> all(static_cast<std::size_t>(cells)), scratch(1);
  for (int cell = 0; cell < cells; ++cell)
    unknown.sample([f](const apsis::position& x, std::span<double> u) { u[0] = f(x[0]); }, {},
                   mesh.centre(cell), mesh.spacing(0), scratch, &all[static_cast<std::size_t>(cell)]);
  return all;
}

double wave(double x) {
  return 1.0 + 0.3 * std::sin(pi * x);
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0.0 : HUGE_VAL;
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k)
    largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

}  // namespace

TEST(discretization, quadrature_sample_and_second_moment_belong_to_one_functional) {
  for (const discretization_entry* entry : apsis::discretization_entries()) {
    SCOPED_TRACE(entry->name);
    const cell_unknown& unknown = entry->instance().unknown();
    // In a cell of width 0.1 around 0.35, sampling and the points of the functional give the same for x^p.
    for (int power = 0; power <= 4; ++power) {
      std::vector<double> scratch(1);
      double sampled = 0.0, sum = 0.0;
      unknown.sample([power](const apsis::position& x, std::span<double> u) { u[0] = std::pow(x[0], power); },
                     {}, {0.35, 0.0, 0.0}, 0.1, scratch, &sampled);
      for (const auto& [offset, weight] : unknown.points())
        sum += weight * std::pow(0.35 + 0.1 * offset, power);
      EXPECT_NEAR(sampled, sum, 1e-16 + 4e-16 * sum) << power;  // rounding of numbers ≤ 1
      if (power == 2) {
        EXPECT_NEAR(sampled, 0.35 * 0.35 + 0.01 * unknown.second_moment(), 1e-16);
      }
    }
  }
}

TEST(discretization, unknowns_of_a_finer_mesh_restrict_to_those_of_a_coarser_one) {
  for (const discretization_entry* entry : apsis::discretization_entries()) {
    SCOPED_TRACE(entry->name);
    const cell_unknown& unknown = entry->instance().unknown();
    ASSERT_EQ(unknown.why_not_restricted(64, 32), "");
    EXPECT_EQ(unknown.why_not_restricted(16, 32), "it is coarser");
    // Interpolation of sin(πx) with eighth order on 64 cells has an error of (π/32)⁸/2⁸ ~ 3e-11.
    EXPECT_LT(distance(unknown.restricted(unknowns_of(unknown, 64, wave), 1, 32, true),
                       unknowns_of(unknown, 32, wave)),
              1e-10);
  }
}

TEST(discretization, transport_and_collision_converge_on_its_own_unknowns) {
  const auto m = small_bgk(8, 4.0);
  const auto speeds = m->speeds(0);
  for (const discretization_entry* entry : apsis::discretization_entries()) {
    SCOPED_TRACE(entry->name);
    std::vector<double> of_transport, of_collision;
    for (const int cells : {20, 40}) {
      apsis::problem_builder builder(*m);
      builder.on(grid::line(cells, 0.0, 2.0))
          .with_discretization(entry->name)
          .with_reconstruction(apsis::find_reconstruction("upwind5").make());
      const auto problem = builder.build();
      const auto state = [&](const apsis::position& x, std::span<double> f) {
        for (std::size_t k = 0; k < f.size(); ++k)
          f[k] = wave(x[0]) * std::exp(-0.5 * speeds[k] * speeds[k]) * (1.0 + 0.1 * speeds[k]);
      };
      const field u = builder.sample(state);
      const field exact_t = builder.sample([&](const apsis::position& x, std::span<double> f) {
        for (std::size_t k = 0; k < f.size(); ++k)
          f[k] = -speeds[k] * 0.3 * pi * std::cos(pi * x[0]) * std::exp(-0.5 * speeds[k] * speeds[k]) *
                 (1.0 + 0.1 * speeds[k]);
      });
      const auto at_point = m->make_collision({1, u.stride(), false});
      const field exact_q = builder.sample([&](const apsis::position& x, std::span<double> q) {
        field row(1, u.components()), rate(1, u.components());
        state(x, {row.row(0), q.size()});
        const double epsilon = 1.0;
        at_point->evaluate({.count = 1, .pitch = row.stride(), .epsilon = &epsilon, .first_cell = 0},
                           row.row(0), rate.row(0));
        std::copy_n(rate.row(0), q.size(), q.begin());
      });
      field t(cells, u.components()), q(cells, u.components());
      const apsis::target<field, double> to_t{&t, 0.0, 1.0, true}, to_q{&q, 0.0, 1.0, true};
      problem->add_transport(0.0, u, {&to_t, 1});
      problem->add_collision(0.0, u, {&to_q, 1});
      const auto error = [&](const field& a, const field& b) {
        double largest = 0.0;
        for (int cell = 0; cell < cells; ++cell)
          for (int k = 0; k < u.components(); ++k)
            largest = std::max(largest, std::abs(a.row(cell)[k] - b.row(cell)[k]));
        return largest;
      };
      of_transport.push_back(error(t, exact_t));
      // Collisions of point values are exact up to rounding.
      of_collision.push_back(std::max(error(q, exact_q), 1e-13));
    }
    // Every discretization needs second order at least. Tests of the operators demand their own orders.
    EXPECT_GT(std::log2(of_transport[0] / of_transport[1]), 1.8);
    if (of_collision[0] > 1e-12) {
      EXPECT_GT(std::log2(of_collision[0] / of_collision[1]), 1.8);
    }
  }
}

TEST(discretization, names_are_unique_and_the_default_is_first) {
  const auto names = apsis::discretization_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_EQ(names.front(), apsis::default_discretization(1).name);
  for (const int dimensions : {1, 2, 3}) {
    const apsis::discretization& chosen = apsis::default_discretization(dimensions).instance();
    EXPECT_TRUE(dimensions == 1 || chosen.why_on_a_line().empty());
  }
  EXPECT_THROW(
      {
        try {
          static_cast<void>(apsis::find_discretization("finite-volum"));
        } catch (const apsis::input_error& e) {
          EXPECT_THAT(e.what(), testing::HasSubstr("did you mean 'finite-volume'?"));
          throw;
        }
      },
      apsis::input_error);
}

namespace {

/// First-order upwind on a periodic line in plain loops. It counts its evaluations.
class plain_upwind final : public apsis::transport {
 public:
  plain_upwind(const apsis::model& m, const grid& mesh, int& evaluations)
      : model_(m), mesh_(mesh), evaluations_(evaluations) {}

  bool add_transport(double, const field& u, std::span<const apsis::target<field, double>> targets,
                     const apsis::cells_job&) const override {
    ++evaluations_;
    const field old = u;  // a target may be u
    const auto v = model_.speeds(0);
    for (int cell = 0; cell < mesh_.size(); ++cell)
      for (int k = 0; k < u.components(); ++k) {
        const double speed = v[static_cast<std::size_t>(k)];
        const int upwind = (cell + (speed > 0.0 ? mesh_.size() - 1 : 1)) % mesh_.size();
        const double change = std::abs(speed) / mesh_.spacing(0) * (old.row(upwind)[k] - old.row(cell)[k]);
        for (const auto& to : targets)
          to.acc->row(cell)[k] = to.combine(to.acc->row(cell)[k], old.row(cell)[k], change);
      }
    return false;
  }
  void combine(std::span<const apsis::linear_term<field, double>> terms, field& sum) const override {
    field total(sum.cells(), sum.components());
    for (const auto& [alpha, u] : terms)
      for (int cell = 0; cell < sum.cells(); ++cell)
        for (int k = 0; k < sum.components(); ++k) total.row(cell)[k] += alpha * u->row(cell)[k];
    sum = total;
  }
  std::span<const double> budget_rates() const override { return {}; }
  std::vector<double> observe_surfaces(double, const field&) const override { return {}; }
  void set_force(apsis::acceleration) override {
    throw apsis::input_error("a force (no such term); leave it out");
  }
  void set_rotation(int) override {
    throw apsis::input_error("axisymmetric flow (no such term); leave it out");
  }
  void set_source(apsis::source_rate) override {
    throw apsis::input_error("a source (no such term); leave it out");
  }
  void limit_for_steps(double) override {}  // it has no limiter
  void limit_for_steady_states(double) override {}
  double forward_euler_step() const override {
    double fastest = 0.0;
    for (const double v : model_.speeds(0)) fastest = std::max(fastest, std::abs(v));
    return apsis::rounding_allowance * mesh_.spacing(0) / fastest;
  }
  double growth_of_source(double, const field&) const override { return 0.0; }
  bool source_depends_on_state() const override { return false; }

 private:
  const apsis::model& model_;
  grid mesh_;
  int& evaluations_;
};

}  // namespace

TEST(transport_interface, a_problem_needs_one_call_for_one_evaluation_of_any_transport) {
  const auto m = small_bgk(12);
  const grid mesh = grid::line(40, 0.0, 2.0);
  const auto space = space_of(mesh);
  const auto q = [&] { return apsis::make_pointwise_collision(*m, std::vector<double>(40, 1e-2)); };
  int evaluations = 0;
  apsis::semidiscrete_problem plain(*m, space, std::make_unique<plain_upwind>(*m, mesh, evaluations), q());
  auto library =
      upwind_problem(*m, space, scheme("upwind1", apsis::limited_reconstruction::limits::nothing), q());
  field u = sample(mesh, m->components(), false,
                   [](double x, int k) { return (1.0 + k) * (1.2 + std::sin(pi * x)); });
  EXPECT_DOUBLE_EQ(plain.forward_euler_step(0.0, u), library.forward_euler_step(0.0, u));
  const double dt = plain.forward_euler_step(0.0, u);
  field next(40, m->components()), expected = next;
  const auto step = [&](apsis::semidiscrete_problem& problem, field& to) {
    const std::vector<apsis::target<field, double>> targets{{&to, 1.0, 0.5 * dt, true}};
    problem.add_transport_and_solve(0.0, u, targets, {0.0, dt, 0.0, &to});
  };
  step(plain, next);
  step(library, expected);
  EXPECT_EQ(evaluations, 1);
  for (int cell = 0; cell < 40; ++cell)
    for (int k = 0; k < m->components(); ++k)
      // The same sums in another order differ by a few roundings of values up to 30.
      EXPECT_NEAR(next.row(cell)[k], expected.row(cell)[k], 1e-13) << cell << ' ' << k;
  EXPECT_THROW(plain.set_force({}), apsis::input_error);
}

}  // namespace discretization_test
