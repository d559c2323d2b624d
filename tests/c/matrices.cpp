// Mass matrices, sparse Jacobians and collisions that depend on time in the C interface.
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <c/ode.hpp>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace c_matrices_test {
namespace {

using namespace c_interface;
using state = std::vector<double>;
using rule = apsis::step_rule<double>;

/// Q_i = k (u_{i−1} − 2u_i + u_{i+1} − u_i³), a band, with derivatives written by hand.
struct chain {
  double k;

  static double at(std::span<const double> u, std::size_t i) { return i < u.size() ? u[i] : 0.0; }
  void value(std::span<const double> u, std::span<double> out) const {
    for (std::size_t i = 0; i < u.size(); ++i)
      out[i] = k * (at(u, i - 1) - 2 * u[i] + at(u, i + 1) - u[i] * u[i] * u[i]);
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) const {
    for (std::size_t i = 0; i < u.size(); ++i)
      jx[i] = k * (at(x, i - 1) - 2 * x[i] + at(x, i + 1) - 3 * u[i] * u[i] * x[i]);
  }
  void curvature(std::span<const double> u, std::span<const double> p, std::span<const double> x,
                 std::span<double> hx) const {
    for (std::size_t i = 0; i < u.size(); ++i) hx[i] = -6 * k * u[i] * p[i] * x[i];
  }
};

int value(size_t, size_t n, const double* u, double* q, void* data) {
  static_cast<const chain*>(data)->value({u, n}, {q, n});
  return 0;
}
int product(size_t, size_t n, const double* u, const double* x, double* jx, void* data) {
  static_cast<const chain*>(data)->jacobian_product({u, n}, {x, n}, {jx, n});
  return 0;
}
int curvature(size_t, size_t n, const double* u, const double* k, const double* x, double* hx, void* data) {
  static_cast<const chain*>(data)->curvature({u, n}, {k, n}, {x, n}, {hx, n});
  return 0;
}
int driving(double t, size_t n, const double*, double* out, void*) {
  for (size_t i = 0; i < n; ++i) out[i] = std::cos(t + static_cast<double>(i));
  return 0;
}

/// Entries of M and the places of Q', both tridiagonal.
struct matrices {
  std::vector<std::size_t> rows{}, columns{};
  std::vector<double> values{};

  explicit matrices(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i == 0 ? 0 : i - 1; j < std::min(n, i + 2); ++j) {
        rows.push_back(i);
        columns.push_back(j);
        values.push_back(i == j ? 4.0 + static_cast<double>(i) : 1.0);
      }
  }
  apsis::mass_matrix<double> mass(std::size_t n) const {
    std::vector<apsis::mass_matrix<double>::entry> entries;
    for (std::size_t k = 0; k < rows.size(); ++k) entries.push_back({rows[k], columns[k], values[k]});
    return {n, entries};
  }
};

constexpr std::size_t length = 12;

/// The measure of errors of apsis_set_tolerance(1e-4, 1e-6).
double weighted(const state& u, const state& v) {
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    largest = std::max(largest, std::abs(u[i] - v[i]) / (1e-6 + 1e-4 * std::abs(u[i])));
  return largest;
}

integrator of_chain(const char* name, chain& data, const state& u0, std::size_t block) {
  auto s = make(name, u0.size());
  apsis_set_data(s.get(), &data);
  apsis_set_transport(s.get(), driving);
  apsis_set_rate(s.get(), value);
  apsis_set_product(s.get(), product);
  apsis_set_curvature(s.get(), curvature);
  apsis_set_block_size(s.get(), block);
  EXPECT_EQ(apsis_start(s.get(), 0, u0.data()), APSIS_OK);
  return s;
}

void set_matrices(const integrator& s, const matrices& of, bool sparse) {
  EXPECT_EQ(apsis_set_mass(s.get(), of.rows.size(), of.rows.data(), of.columns.data(), of.values.data()),
            APSIS_OK);
  if (!sparse) return;
  EXPECT_EQ(apsis_set_sparsity(s.get(), of.rows.size(), of.rows.data(), of.columns.data()), APSIS_OK);
}

}  // namespace

TEST(c_matrices, give_the_bits_of_the_cpp_interface) {
  const matrices of(length);
  const auto transport_of_chain = [](double t, const state& u, state& out) {
    driving(t, u.size(), u.data(), out.data(), nullptr);
  };
  for (const char* name : {"md-imex-8-3-mixed", "ark-548-2", "extrapolated-euler-5"})
    for (const bool sparse : {false, true})
      for (const bool adaptive : {false, true}) {
        chain data{100};
        state u0(length, 0.5);
        apsis::newton_problem problem(transport_of_chain, data);
        problem.with_mass(of.mass(length));
        if (sparse) problem.with_sparsity(apsis::sparsity_pattern::banded(length, 1, 1));
        const auto s = of_chain(name, data, u0, length);
        set_matrices(s, of, sparse);
        const apsis::component_tolerances<double> wanted(1e-4, 1e-6);
        std::optional<apsis::step_tolerance<state, double>> tolerance;
        if (adaptive) {
          problem.with_tolerances(wanted);
          tolerance = {1.0, weighted, std::nullopt};
          EXPECT_EQ(apsis_set_tolerance(s.get(), 1e-4, 1e-6), APSIS_OK);
        } else {
          EXPECT_EQ(apsis_set_step(s.get(), 1.0 / 32), APSIS_OK);
        }
        apsis::evolution march(apsis::find_integrator(name), problem,
                               adaptive ? rule::unlimited() : rule::fixed(1.0 / 32), tolerance);
        march.start(0, u0);
        march.advance(1);
        EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
        EXPECT_EQ(unknowns_of(s, length), march.u()) << name << sparse << adaptive;
      }
}

TEST(c_matrices, one_mass_matrix_is_that_of_every_block) {
  const matrices of(4);
  chain data{100};
  state both;
  for (const double first : {0.5, 0.8}) both.insert(both.end(), 4, first);
  const auto still = [](double, size_t n, const double*, double* out, void*) {
    std::fill(out, out + n, 0.25);
    return 0;
  };
  const auto s = of_chain("md-imex-8-3-mixed", data, both, 4);
  apsis_set_transport(s.get(), still);
  set_matrices(s, of, false);
  apsis_set_step(s.get(), 0.125);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  state expected;
  for (const double first : {0.5, 0.8}) {
    const auto one = of_chain("md-imex-8-3-mixed", data, state(4, first), 4);
    apsis_set_transport(one.get(), still);
    set_matrices(one, of, false);
    apsis_set_step(one.get(), 0.125);
    EXPECT_EQ(apsis_integrate(one.get(), 1), APSIS_OK) << apsis_error_message();
    const state found = unknowns_of(one, 4);
    expected.insert(expected.end(), found.begin(), found.end());
  }
  EXPECT_EQ(unknowns_of(s, 8), expected);
}

TEST(c_matrices, explicit_methods_divide_by_the_mass) {
  const auto s = make("dop853", 1);
  apsis_set_transport(s.get(), [](double, size_t, const double* u, double* out, void*) {
    out[0] = -2 * u[0];
    return 0;
  });
  const std::size_t zero = 0;
  const double four = 4, one = 1;
  EXPECT_EQ(apsis_set_mass(s.get(), 1, &zero, &zero, &four), APSIS_OK);
  apsis_set_step(s.get(), 0.125);
  EXPECT_EQ(apsis_start(s.get(), 0, &one), APSIS_OK);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_NEAR(apsis_state(s.get())[0], std::exp(-0.5), 1e-12);  // the error of order 8 at λΔt = 0.06
}

namespace {

/// u' = −k (u − sin ωt) + ω cos ωt with the solution sin ωt.
struct driven {
  double k, omega;
};
int driven_rate(double t, size_t, size_t, const double* u, double* q, void* data) {
  const auto& of = *static_cast<const driven*>(data);
  q[0] = -of.k * (u[0] - std::sin(of.omega * t)) + of.omega * std::cos(of.omega * t);
  return 0;
}
int driven_product(double, size_t, size_t, const double*, const double* x, double* jx, void* data) {
  jx[0] = -static_cast<const driven*>(data)->k * x[0];
  return 0;
}

/// Error after equal steps to the time 1/ω.
double error_of(const char* name, driven of, int steps) {
  const auto s = make(name, 1);
  apsis_set_data(s.get(), &of);
  EXPECT_EQ(apsis_set_timed_rate(s.get(), driven_rate), APSIS_OK);
  EXPECT_EQ(apsis_set_timed_product(s.get(), driven_product), APSIS_OK);
  EXPECT_EQ(apsis_set_step(s.get(), 1 / (of.omega * steps)), APSIS_OK);
  const double u0 = 0;
  EXPECT_EQ(apsis_start(s.get(), 0, &u0), APSIS_OK);
  EXPECT_EQ(apsis_integrate(s.get(), 1 / of.omega), APSIS_OK) << apsis_error_message();
  return std::abs(apsis_state(s.get())[0] - std::sin(1.0));
}

}  // namespace

TEST(c_matrices, collisions_of_time_have_the_order_of_the_method_at_every_scale_of_time) {
  // Methods that need dQ/dt and methods that do not.
  for (const auto& [name, order] :
       {std::pair{"imdrk-3-3", 3}, {"imdrk-9-5", 5}, {"dirk-4-3", 3}, {"ark-436", 4}})
    for (const double omega : {1.0, 1e9, 1e-9}) {
      const double coarse = error_of(name, {omega, omega}, 8), fine = error_of(name, {omega, omega}, 16);
      EXPECT_GT(std::log2(coarse / fine), order - 0.4)
          << name << " " << omega << " " << coarse << " " << fine;
    }
}

TEST(c_matrices, refuse_what_cannot_be_used) {
  chain data{1};
  const std::size_t first = 0, second = 1;
  const double zero = 0, one = 1, nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [&](const auto& change) {
    return [&data, change] {
      const auto s = of_chain("md-imex-8-3-mixed", data, state(2, 0.5), 1);
      apsis_set_step(s.get(), 0.1);
      change(s.get());
      rethrow(apsis_integrate(s.get(), 1));
    };
  };
  bad_input::expect_refused({
      {with([&](auto* s) { rethrow(apsis_set_mass(s, 1, &first, &second, &one)); }),
       {"row 0 and column 1", "1 rows"},
       2},
      {with([&](auto* s) { rethrow(apsis_set_mass(s, 1, &first, &first, &zero)); }),
       {"singular", "algebraic"},
       2},
      {with([&](auto* s) { rethrow(apsis_set_mass(s, 1, &first, &first, &nan)); }), {"not finite"}, 2},
      {with([&](auto* s) { rethrow(apsis_set_mass(s, 1, nullptr, &first, &one)); }),
       {"list of rows is NULL"},
       2},
      {with([&](auto* s) { rethrow(apsis_set_mass(s, 1, &first, &first, nullptr)); }),
       {"list of values is NULL"},
       2},
      {with([&](auto* s) { rethrow(apsis_set_sparsity(s, 1, &second, &first)); }),
       {"place (1, 0)", "1 unknowns"},
       2},
      {with([&](auto* s) {
         apsis_set_mass(s, 1, &first, &first, &one);
         apsis_set_block_size(s, 2);
       }),
       {"mass matrix of 1 unknowns", "block has 2"},
       2},
      {with([&](auto* s) {
         apsis_set_sparsity(s, 1, &first, &first);
         apsis_set_block_size(s, 2);
       }),
       {"sparsity pattern of 1 unknowns", "block has 2"},
       2},
      {with([&](auto* s) {
         apsis_set_mass(s, 1, &first, &first, &one);
         apsis_set_product(s, nullptr);
         apsis_set_stage(s, stage);
       }),
       {"mass matrix", "stage solver"},
       2},
      {with([&](auto* s) { apsis_set_timed_rate(s, driven_rate); }), {"Q(u) and Q(t, u)"}, 2},
      {with([&](auto* s) {
         apsis_set_rate(s, nullptr);
         apsis_set_timed_rate(s, driven_rate);
       }),
       {"derivatives of Q(u)", "apsis_set_timed_product"},
       2},
      {with([&](auto* s) {
         apsis_set_product(s, nullptr);
         apsis_set_timed_product(s, driven_product);
       }),
       {"derivatives of Q(t, u)", "apsis_set_timed_rate"},
       2},
  });
  const auto removed = of_chain("md-imex-8-3-mixed", data, state(2, 0.5), 1);
  EXPECT_EQ(apsis_set_mass(removed.get(), 1, &first, &first, &one), APSIS_OK);
  EXPECT_EQ(apsis_set_mass(removed.get(), 0, nullptr, nullptr, nullptr), APSIS_OK);
  apsis_set_stage(removed.get(), stage);
  apsis_set_product(removed.get(), nullptr);
}

}  // namespace c_matrices_test
