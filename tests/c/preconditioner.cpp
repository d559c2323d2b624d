// Krylov solves with a preconditioner in the C interface: the bits of C++, its calls, and refusals.
#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <cmath>
#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <c/ode.hpp>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/tridiagonal.hpp>

namespace c_preconditioner_test {
namespace {

using namespace c_interface;
using state = std::vector<double>;
using view = std::span<const double>;

constexpr std::size_t length = 40;
constexpr double spread = 1e5;

/// Q_i = spread (u_{i−1} − 2u_i + u_{i+1}) − u_i³ on a line with fixed ends.
struct heat {
  template <class U, class V>
  void operator()(const U& u, V& out) const {
    for (std::size_t i = 0; i < u.size(); ++i) {
      out[i] = -2.0 * spread * u[i] - u[i] * u[i] * u[i];
      if (i > 0) out[i] += spread * u[i - 1];
      if (i + 1 < u.size()) out[i] += spread * u[i + 1];
    }
  }
};

/// Solves with the matrix of 1 − γQ', without the derivative of the cubic term.
void divide(double gamma, view r, std::span<double> x) {
  eliminate(state(r.size(), 1.0 + 2.0 * gamma * spread), -gamma * spread, r, x);
}

/// The last preparation, and what the callbacks shall return.
struct record {
  double gamma = 0.0;
  std::size_t block = 0;
  std::set<std::size_t> blocks;
  int prepared = 0, solved = 0, answer = 0;
};

int value(size_t, size_t n, const double* u, double* q, void*) {
  const view in(u, n);
  std::span<double> out(q, n);
  heat{}(in, out);
  return 0;
}
int product(size_t, size_t n, const double* u, const double* x, double* jx, void*) {
  apsis::vector_field<double, heat> field{heat{}};
  field.jacobian_product({u, n}, {x, n}, {jx, n});
  return 0;
}
int curvature(size_t, size_t n, const double* u, const double* k, const double* x, double* hx, void*) {
  for (size_t i = 0; i < n; ++i) hx[i] = -6.0 * u[i] * k[i] * x[i];
  return 0;
}
int prepare(double, double gamma, size_t block, size_t, const double*, void* data) {
  auto& seen = *static_cast<record*>(data);
  seen.gamma = gamma;
  seen.block = block;
  seen.blocks.insert(block);
  ++seen.prepared;
  return 0;
}
int solve(double, double gamma, size_t block, size_t n, const double*, const double* r, double* x,
          void* data) {
  auto& seen = *static_cast<record*>(data);
  EXPECT_EQ(gamma, seen.gamma);  // the last preparation is that of this solve
  EXPECT_EQ(block, seen.block);
  ++seen.solved;
  if (seen.answer != 0) return seen.answer;
  divide(gamma, {r, n}, {x, n});
  return 0;
}

state start(std::size_t n) {
  state u(n);
  for (std::size_t i = 0; i < n; ++i) u[i] = 1.0 + 0.5 * std::sin(static_cast<double>(i));
  return u;
}

integrator of_heat(const char* name, record& data, std::size_t blocks = 1) {
  auto s = make(name, blocks * length);
  apsis_set_block_size(s.get(), length);
  apsis_set_data(s.get(), &data);
  apsis_set_rate(s.get(), value);
  apsis_set_product(s.get(), product);
  apsis_set_curvature(s.get(), curvature);
  EXPECT_EQ(apsis_set_preconditioner(s.get(), prepare, solve), APSIS_OK) << apsis_error_message();
  apsis_set_step(s.get(), 0.125);
  EXPECT_EQ(apsis_start(s.get(), 0, start(blocks * length).data()), APSIS_OK);
  return s;
}

}  // namespace

TEST(c_preconditioner, gives_the_bits_of_the_problem_in_cpp) {
  for (const char* name : {"md-imex-3-2", "ark-548-2"}) {
    record data;
    const auto s = of_heat(name, data);
    ASSERT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
    // The same formulas of derivatives: automatic ones of C++ would round otherwise.
    struct by_hand {
      apsis::vector_field<double, heat> field{heat{}};
      void value(view u, std::span<double> out) { heat{}(u, out); }
      void jacobian_product(view u, view x, std::span<double> jx) { field.jacobian_product(u, x, jx); }
      void curvature(view u, view k, view x, std::span<double> hx) {
        for (std::size_t i = 0; i < u.size(); ++i) hx[i] = -6.0 * u[i] * k[i] * x[i];
      }
    };
    apsis::newton_problem problem(apsis::no_transport{}, by_hand{});
    problem.with_preconditioner([](double, view, double gamma) {
      return [gamma](view r, std::span<double> x) { divide(gamma, r, x); };
    });
    apsis::evolution march(apsis::find_method(name), problem, apsis::step_rule<double>::fixed(0.125));
    march.start(0.0, start(length));
    march.advance(1.0);
    const double* u = apsis_state(s.get());
    EXPECT_EQ(state(u, u + length), march.u()) << name;
  }
}

TEST(c_preconditioner, is_prepared_once_for_a_step_with_one_gamma) {
  record data;
  const auto s = of_heat("ark-548-2", data);
  ASSERT_EQ(apsis_integrate(s.get(), 1), APSIS_OK) << apsis_error_message();
  EXPECT_EQ(data.prepared, 8);  // steps
  EXPECT_EQ(apsis_count(s.get(), APSIS_PREPARATIONS), data.prepared);
  EXPECT_EQ(apsis_count(s.get(), APSIS_PRECONDITIONER_SOLVES), data.solved);
}

TEST(c_preconditioner, follows_blocks_and_gammas) {
  record data;
  const auto s = of_heat("md-imex-3-2", data, 3);  // solve() compares γ and block with the preparation
  ASSERT_EQ(apsis_integrate(s.get(), 0.5), APSIS_OK) << apsis_error_message();
  EXPECT_GE(data.prepared, 4 * 3);  // steps and blocks
  EXPECT_EQ(data.blocks, (std::set<std::size_t>{0, 1, 2}));
}

TEST(c_preconditioner, may_have_no_preparation) {
  record prepared, alone;
  const auto with = of_heat("ark-548-2", prepared), without = of_heat("ark-548-2", alone);
  const auto solve_alone = [](double, double gamma, size_t, size_t n, const double*, const double* r,
                              double* x, void*) {
    divide(gamma, {r, n}, {x, n});
    return 0;
  };
  apsis_set_preconditioner(without.get(), nullptr, solve_alone);
  for (const auto* s : {&with, &without}) ASSERT_EQ(apsis_integrate(s->get(), 1), APSIS_OK);
  const double *a = apsis_state(with.get()), *b = apsis_state(without.get());
  EXPECT_EQ(state(a, a + length), state(b, b + length));
}

TEST(c_preconditioner, ends_the_run_if_it_fails) {
  record data;
  data.answer = -7;
  const auto s = of_heat("ark-548-2", data);
  EXPECT_EQ(apsis_integrate(s.get(), 1), APSIS_CALLBACK_ERROR);
  EXPECT_NE(std::string(apsis_error_message()).find("the callback 'solve' failed (it returned -7)"),
            std::string::npos)
      << apsis_error_message();
}

TEST(c_preconditioner, is_refused_with_what_excludes_it) {
  record data;
  const auto s = of_heat("ark-548-2", data);
  const std::size_t place[] = {0};
  bad_input::expect_refused({
      {[&] { rethrow(apsis_set_preconditioner(s.get(), prepare, nullptr)); },
       {"is prepared and not applied", "remove both"}},
      {[&] {
         apsis_set_sparsity(s.get(), 1, place, place);
         rethrow(apsis_integrate(s.get(), 1));
       },
       {"a preconditioner and a sparsity pattern are given"}},
      {[&] {
         apsis_set_sparsity(s.get(), 0, nullptr, nullptr);
         apsis_set_product(s.get(), nullptr);
         apsis_set_curvature(s.get(), nullptr);
         apsis_set_stage(s.get(), stage);
         rethrow(apsis_integrate(s.get(), 1));
       },
       {"a preconditioner and a stage solver are given"}},
  });
}

}  // namespace c_preconditioner_test
