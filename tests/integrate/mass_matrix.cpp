// Systems M u' = F + G: the matrix, stages against those of M⁻¹ F and M⁻¹ G, and finite elements against
// their exact solution.
#include <apsis/integrate/mass_matrix.hpp>

#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace mass_matrix_test {
namespace {

using apsis::mass_matrix;
using apsis::newton_problem;
using apsis::no_transport;
using apsis::sparsity_pattern;
using random_input::magnitude;
using random_input::one_in;
using random_input::uniform;
using row = std::vector<double>;
using entry = mass_matrix<double>::entry;

/// Entries of an n × n matrix whose diagonal is twice the rest of its row, with rows of other units.
std::vector<entry> dominant(std::size_t n, double most_units) {
  std::vector<entry> entries;
  for (std::size_t i = 0; i < n; ++i) {
    const double unit = std::exp2(std::round(uniform(-most_units, most_units)));
    double rest = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || one_in(2)) continue;
      entries.push_back({i, j, unit * uniform(-1, 1)});
      rest += std::abs(entries.back().value);
    }
    entries.push_back({i, i, 2 * rest + unit});
  }
  return entries;
}

TEST(mass_matrix, divides_what_it_multiplies) {
  check_property("random matrices with rows of any units", [] {
    const auto n = static_cast<std::size_t>(random_input::integer(1, 30));
    const auto entries = dominant(n, 200);
    const mass_matrix<double> m(n, entries);
    row x(n), y(n), sum(n, 0.0);
    for (double& value : x) value = uniform(-1, 1);
    m.multiply(x, y);
    for (const entry& e : entries) sum[e.row] += e.value * x[e.column];
    row sizes(n);
    m.multiply_sizes(row(n, 1.0), sizes);
    for (std::size_t i = 0; i < n; ++i) RC_ASSERT(std::abs(y[i] - sum[i]) <= 1e-14 * sizes[i]);
    m.divide(y);
    // The condition number of such a matrix, once its rows are scaled, is at most 3; n² roundings.
    for (std::size_t i = 0; i < n; ++i) RC_ASSERT(std::abs(y[i] - x[i]) <= 1e-13);
  });
}

TEST(mass_matrix, adds_values_at_one_place_and_lists_it_in_a_pattern) {
  const mass_matrix<double> m(3, {{0, 0, 1}, {2, 1, 5}, {1, 1, 2}, {2, 2, 1}, {2, 2, 3}});
  EXPECT_EQ(m.columns(), (row{1, 0, 0, 0, 2, 5, 0, 0, 4}));
  EXPECT_EQ(m.places().size(), 4u);
  const sparsity_pattern pattern = sparsity_pattern(3, {{0, 2}}).joined_with(m.places());
  EXPECT_EQ(m.at(pattern), (row{1, 2, 5, 0, 4}));  // (0,0), (1,1), (2,1), (0,2), (2,2)
  EXPECT_EQ(mass_matrix<double>::full(2, row{1, 2, 0, 4}).columns(), (row{1, 0, 2, 4}));
}

TEST(mass_matrix, refuses_matrices_that_cannot_be_inverted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  bad_input::expect_refused({
      {[] { mass_matrix<double>(0, {}); }, {"0 rows"}, 2},
      {[] { mass_matrix<double>(2, {{0, 2, 1}}); }, {"row 0 and column 2", "2 rows"}, 2},
      {[nan] { mass_matrix<double>(1, {{0, 0, nan}}); }, {"row 0 and column 0", "not finite"}, 2},
      {[] { mass_matrix<double>(2, {{0, 0, 1}}); }, {"singular", "algebraic"}, 2},
      {[] { mass_matrix<double>::full(2, row{0.1, 0.3, 0.2, 0.6}); }, {"singular", "algebraic"}, 2},
      {[] { mass_matrix<double>::full(2, row{1, 2, 3}); }, {"3 numbers", "4"}, 2},
      {[] {
         newton_problem problem(no_transport{}, [](const auto& u, auto& out) { out[0] = -1.0 * u[0]; });
         problem.with_mass(mass_matrix<double>(2, {{0, 0, 1}, {1, 1, 1}}));
         row u{1};
         problem.solve_collision(0, 1, 0, u);
       },
       {"2 rows", "1 unknowns"},
       2},
  });
}

TEST(mass_matrix, the_test_of_singularity_does_not_depend_on_units) {
  // Diagonal entries from 1e-300 to 1e300 are units.
  const mass_matrix<double> m(3, {{0, 0, 1e-300}, {1, 1, 1}, {2, 2, 1e300}});
  row x{1e-300, 2, 3e300};
  m.divide(x);
  EXPECT_EQ(x, (row{1, 2, 3}));
}

/// A nonlinear stiff G of n unknowns with a band, and an F.
struct coupled {
  double stiffness;
  template <class Numbers, class Out>
  void operator()(const Numbers& u, Out& out) const {
    const std::size_t n = u.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto left = u[i == 0 ? i : i - 1], right = u[i + 1 == n ? i : i + 1];
      out[i] = stiffness * (left - 2.0 * u[i] + right - u[i] * u[i] * u[i]);
    }
  }
};
constexpr auto driving = [](double t, const row& u, row& out) {
  for (std::size_t i = 0; i < u.size(); ++i) out[i] = std::cos(t + static_cast<double>(i));
};

/// The field M⁻¹ g with derivatives by the chain rule, as a user without with_mass() would write it.
class divided {
 public:
  divided(coupled g, mass_matrix<double> mass) : field_(g), mass_(std::move(mass)) {}
  void value(std::span<const double> u, std::span<double> out) {
    field_.value(u, out);
    mass_.divide(out);
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) {
    field_.jacobian_product(u, x, jx);
    mass_.divide(jx);
  }
  void curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx) {
    row jx(u.size());
    field_.curvature(u, k, x, jx, hx);
    mass_.divide(hx);
  }

 private:
  apsis::vector_field<double, coupled> field_;
  mass_matrix<double> mass_;
};

TEST(mass_matrix, stages_are_those_of_the_divided_system) {
  check_property("random matrix, state and stage, every linear solver", [] {
    const auto n = static_cast<std::size_t>(random_input::integer(2, 8));
    const mass_matrix<double> m(n, dominant(n, 0));
    const double stiffness = magnitude(-2, 3);
    const coupled g{stiffness};
    row u(n);
    for (double& value : u) value = uniform(0.1, 1);
    const double a = uniform(0.1, 1), b = one_in(2) ? 0.0 : -uniform(0.1, 0.5) * a * a;
    row expected = u;
    newton_problem plain(no_transport{}, divided(g, m));
    plain.solve_collision(0, a, b, expected);
    const auto require_same = [&](auto& problem) {
      row v = u;
      problem.solve_collision(0, a, b, v);
      // Both solve to their rounding errors, at most 1e3 units of a last place of a stiff stage.
      for (std::size_t i = 0; i < n; ++i) RC_ASSERT(std::abs(v[i] - expected[i]) <= 1e-11);
    };
    newton_problem dense(no_transport{}, g);
    require_same(dense.with_mass(m));
    newton_problem sparse(no_transport{}, g);
    require_same(sparse.with_mass(m).with_sparsity(sparsity_pattern::banded(n, 1, 1)));
    newton_problem first_sparse(no_transport{}, g);
    require_same(first_sparse.with_sparsity(sparsity_pattern::banded(n, 1, 1)).with_mass(m));
    if (stiffness > 10) return;  // what krylov is not for
    newton_problem krylov(no_transport{}, g, apsis::newton_options{.solver = apsis::linear_solver::krylov});
    require_same(krylov.with_mass(m));
  });
}

TEST(mass_matrix, rates_are_those_of_the_divided_system) {
  const mass_matrix<double> m(3, {{0, 0, 2}, {0, 1, 1}, {1, 1, 4}, {2, 0, 1}, {2, 2, 1}});
  newton_problem problem(driving, coupled{1});
  problem.with_mass(m);
  const row u{1, 0.5, 0.2};
  row f(3), g(3);
  driving(0.3, u, f);
  apsis::vector_field<double, coupled>(coupled{1}).value(u, g);
  const auto expect_rate = [&](row expected, const auto& add) {
    m.divide(expected);
    row rate(3, 0.0);
    const apsis::target<row, double> to{&rate, 0.0, 1.0, true};
    add(std::span(&to, 1));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rate[i], expected[i], 1e-15);  // the same operations
  };
  row sum = f;
  for (std::size_t i = 0; i < 3; ++i) sum[i] += g[i];
  expect_rate(f, [&](auto to) { problem.add_transport(0.3, u, to); });
  expect_rate(g, [&](auto to) { problem.add_collision(0.3, u, to); });
  expect_rate(sum, [&](auto to) { problem.add_transport_and_collision(0.3, u, to); });
}

/// Linear finite elements of u_t = u_xx on [0, 1], u = 0 at both ends, n inner nodes:
/// h/6 (u'_{i−1} + 4u'_i + u'_{i+1}) = (u_{i−1} − 2u_i + u_{i+1})/h.
struct elements {
  std::size_t n;
  double h() const { return 1 / static_cast<double>(n + 1); }

  template <class Numbers, class Out>
  void operator()(const Numbers& u, Out& out) const {
    for (std::size_t i = 0; i < n; ++i) {
      auto sum = -2.0 * u[i];
      if (i > 0) sum += u[i - 1];
      if (i + 1 < n) sum += u[i + 1];
      out[i] = sum / h();
    }
  }
  mass_matrix<double> mass() const {
    std::vector<entry> entries;
    for (std::size_t i = 0; i < n; ++i) {
      entries.push_back({i, i, 4 * h() / 6});
      if (i > 0) entries.push_back({i, i - 1, h() / 6});
      if (i + 1 < n) entries.push_back({i, i + 1, h() / 6});
    }
    return {n, entries};
  }
  /// sin(kπx) decays at the rate 6/h² (1 − cos kπh)/(2 + cos kπh): insert it into the equations.
  double rate(double k) const {
    const double c = std::cos(k * std::numbers::pi * h());
    return 6 / (h() * h()) * (1 - c) / (2 + c);
  }
  row mode(double k) const {
    row u(n);
    for (std::size_t i = 0; i < n; ++i)
      u[i] = std::sin(k * std::numbers::pi * h() * static_cast<double>(i + 1));
    return u;
  }
};

TEST(mass_matrix, finite_elements_decay_as_their_modes_do) {
  // Stiffness 12/h² = 1.1e6; modes 1 and 3.
  const elements of{300};
  for (const std::string name : {"ark-548-2", "md-imex-8-3-mixed", "extrapolated-euler-5"}) {
    newton_problem problem(no_transport{}, of);
    problem.with_mass(of.mass()).with_sparsity(sparsity_pattern::banded(of.n, 1, 1));
    const apsis::component_tolerances<double> wanted(1e-6, 1e-9);
    problem.with_tolerances(wanted);
    apsis::evolution march(apsis::find_method(name), problem, apsis::step_rule<double>::unlimited(),
                           apsis::step_tolerance<row, double>{1.0, wanted, std::nullopt});
    row u = of.mode(1);
    const row third = of.mode(3);
    for (std::size_t i = 0; i < of.n; ++i) u[i] += third[i];
    const double end = 0.05;
    march.start(0, u);
    march.advance(end);
    double worst = 0;
    for (std::size_t i = 0; i < of.n; ++i)
      worst = std::max(worst, std::abs(march.u()[i] - of.mode(1)[i] * std::exp(-of.rate(1) * end) -
                                       third[i] * std::exp(-of.rate(3) * end)));
    EXPECT_LE(worst, 2e-5) << name;  // a digit less than the tolerance of a step
    EXPECT_LE(march.steps(), 400) << name;
  }
}

/// M = (2 1; 0.5 3) and G of time: u₁ is damped, u₂ driven.
constexpr auto driven = [](const auto& t, const auto& u, auto& out) {
  using std::cos, std::sin;
  const auto off = u[0] - sin(t);
  out[0] = cos(t) - off * off * off - 5.0 * off;
  out[1] = u[0] * cos(3.0 * t) - u[1] * sin(t);
};
/// M⁻¹ of the same, by hand: det M = 5.5.
constexpr auto driven_by_hand = [](const auto& t, const auto& u, auto& out) {
  driven(t, u, out);
  const auto first = out[0];
  out[0] = (3.0 * first - out[1]) / 5.5;
  out[1] = (2.0 * out[1] - 0.5 * first) / 5.5;
};
constexpr auto rotating = [](double t, const row& u, row& out) { out = {std::cos(t) * u[1], -u[0]}; };
constexpr auto rotating_by_hand = [](double t, const row& u, row& out) {
  const row f{std::cos(t) * u[1], -u[0]};
  out = {(3 * f[0] - f[1]) / 5.5, (2 * f[1] - 0.5 * f[0]) / 5.5};
};

template <class P>
row end_of(const std::string& method, P& problem) {
  row u{0.5, 1};
  apsis::with_stepper(apsis::find_integrator(method), problem, [&](auto march) {
    apsis::integrate(march, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.05));
  });
  return u;
}

template <class F>
void expect_end_by_hand(const std::string& name, F transport, F transport_by_hand) {
  newton_problem problem(transport, driven);
  newton_problem by_hand(transport_by_hand, driven_by_hand);
  problem.with_mass(mass_matrix<double>::full(2, row{2, 1, 0.5, 3}));
  const row u = end_of(name, problem), v = end_of(name, by_hand);
  // Twenty steps of at most twenty stages, each solved to a few roundings.
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(u[i], v[i], 1e-12) << name;
}

TEST(mass_matrix, every_kind_of_method_solves_the_system_divided_by_hand) {
  for (const std::string name : {"imdrk-1-2", "imdrk-9-5", "dirk-4-3"})
    expect_end_by_hand(name, no_transport{}, no_transport{});
  using function = void (*)(double, const row&, row&);
  for (const std::string name :
       {"md-imex-8-3-mixed", "md-imex-16-4-efficient", "ark-548-2", "extrapolated-euler-5", "kutta-4",
        "imex-bdf-3", "imex-dimsim-3", "two-step-10-3-mixed"})
    expect_end_by_hand<function>(name, rotating, rotating_by_hand);
}

}  // namespace
}  // namespace mass_matrix_test
