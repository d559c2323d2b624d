// Krylov solves of stages with a user's solver of M − γG': stages of sparse factorizations, the number of its
// calls, and preconditioners that do not suffice.
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/stage_preconditioner.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>
#include <support/tridiagonal.hpp>

namespace preconditioner_test {
namespace {

using apsis::linear_solver;
using apsis::mass_matrix;
using apsis::newton_options;
using apsis::newton_problem;
using apsis::no_transport;
using apsis::shifted_solve;
using apsis::sparsity_pattern;
using random_input::magnitude;
using random_input::one_in;
using random_input::uniform;
using row = std::vector<double>;
using view = std::span<const double>;

/// Heat on a line with fixed ends and a cubic sink.
struct heat {
  double spread, sink = 1.0;
  template <class U, class V>
  void operator()(const U& u, V& out) const {
    const std::size_t n = u.size();
    for (std::size_t i = 0; i < n; ++i) {
      out[i] = -2.0 * spread * u[i] - sink * u[i] * u[i] * u[i];
      if (i > 0) out[i] += spread * u[i - 1];
      if (i + 1 < n) out[i] += spread * u[i + 1];
    }
  }
};

/// Masses of linear finite elements on n inner points.
mass_matrix<double> masses_of_elements(std::size_t n) {
  std::vector<mass_matrix<double>::entry> entries;
  for (std::size_t i = 0; i < n; ++i) {
    entries.push_back({i, i, 4.0 / 6.0});
    if (i > 0) entries.push_back({i, i - 1, 1.0 / 6.0});
    if (i + 1 < n) entries.push_back({i, i + 1, 1.0 / 6.0});
  }
  return {n, entries};
}

/// Solves M − γG' of `heat` exactly, and counts.
struct counted_elimination {
  heat g;
  bool elements = false;  ///< whether M is masses_of_elements(), not 1
  std::shared_ptr<int> prepared = std::make_shared<int>(0), solved = std::make_shared<int>(0);

  shifted_solve<double> operator()(double, view v, double gamma) const {
    ++*prepared;
    row diagonal;
    for (const double x : v)
      diagonal.push_back((elements ? 4.0 / 6.0 : 1.0) + gamma * (2.0 * g.spread + 3.0 * g.sink * x * x));
    const double other = (elements ? 1.0 / 6.0 : 0.0) - gamma * g.spread;
    return [diagonal, other, count = solved](view r, std::span<double> x) {
      ++*count;
      eliminate(diagonal, other, r, x);
    };
  }
};

TEST(preconditioner, krylov_solves_the_stages_of_sparse_factorizations) {
  check_property("random stage of 2 to 300 unknowns, with and without masses", [] {
    const auto n = static_cast<std::size_t>(uniform(2, 300));
    const double a = uniform(0.1, 1), b = one_in(2) ? 0.0 : -uniform(0.25, 1) * a * a;
    const heat g{magnitude(0, 4)};
    const bool elements = one_in(2);
    newton_problem sparse(no_transport{}, g), krylov(no_transport{}, g);
    sparse.with_sparsity(sparsity_pattern::banded(n, 1, 1));
    krylov.with_preconditioner(counted_elimination{g, elements});
    if (elements) {
      sparse.with_mass(masses_of_elements(n));
      krylov.with_mass(masses_of_elements(n));
    }
    row u(n);
    for (double& x : u) x = uniform(-1, 1);
    row v = u, w = u;
    sparse.solve_collision(0, a, b, v);
    krylov.solve_collision(0, a, b, w);
    // A residual with (Δt λ)² ≤ 1.6e9 has rounding errors of 4e-7. Smooth components lose at most 2e-8 by
    // them: the spread divides by at least 1 for a G' whose smallest eigenvalue is that of one half wave.
    for (std::size_t i = 0; i < n; ++i) RC_ASSERT(std::abs(v[i] - w[i]) <= (b == 0.0 ? 1e-11 : 2e-8));
  });
}

TEST(preconditioner, iterations_do_not_grow_with_stiffness) {
  const std::size_t n = 400;
  for (const double b : {0.0, -0.25})
    for (const double spread : {1e0, 1e2, 1e4, 1e6}) {
      const heat g{spread};
      const counted_elimination inverse{g};
      newton_problem problem(no_transport{}, g);
      problem.with_preconditioner(inverse);
      row u(n, 1.0);
      problem.solve_collision(0, 1.0, b, u);
      // All eigenvalues of the preconditioned matrix lie in [1/2, 1]: some ten iterations give six digits. A
      // restart applies it once more.
      const int systems = problem.report().iterations;
      EXPECT_LE(*inverse.solved, (b == 0.0 ? 12 : 24) * systems) << spread;
      EXPECT_LE(systems, 12) << spread;
      // Far from equilibrium a stage with b < 0 begins with an implicit Euler step, which has another γ.
      EXPECT_LE(*inverse.prepared, b == 0.0 ? 1 : 2) << spread;
    }
}

TEST(preconditioner, stiff_stages_need_it) {
  const heat g{1e6};
  row u(2000);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(static_cast<double>(i * i));
  newton_problem without(no_transport{}, g, newton_options{linear_solver::krylov});
  bad_input::expect_refused(
      {{[&] { without.solve_collision(0, 1.0, 0.0, u); },
        {"GMRES does not solve", "too stiff without a preconditioner", "with_preconditioner"},
        3}});
  newton_problem with(no_transport{}, g);
  with.with_preconditioner(counted_elimination{g});
  EXPECT_NO_THROW(with.solve_collision(0, 1.0, 0.0, u));
}

/// The number of solvers that are prepared in ten steps.
int prepared_in_ten_steps(const char* method) {
  const heat g{1e3};
  const counted_elimination inverse{g};
  newton_problem problem(no_transport{}, g);
  problem.with_preconditioner(inverse);
  row u(50, 1.0);
  apsis::with_stepper(apsis::find_integrator(method), problem, [&](auto march) {
    apsis::integrate(march, u, 0.0, 1.0, apsis::step_rule<double>::fixed(0.1));
  });
  return *inverse.prepared;
}

TEST(preconditioner, is_prepared_once_for_each_gamma_of_a_step) {
  EXPECT_EQ(prepared_in_ten_steps("ark-548-2"), 10);  // its seven implicit stages have one a
  std::vector<double> gammas;
  const auto form = apsis::find_method("md-imex-3-2").coefficients<double>();
  for (std::size_t i = 0; i < form.stages(); ++i) {
    const double d = form.D(i, i), ddot = form.ddot[i];
    if (d != 0.0 || ddot != 0.0) gammas.push_back(ddot != 0.0 ? std::sqrt(-ddot) : d);
  }
  std::sort(gammas.begin(), gammas.end());
  gammas.erase(std::unique(gammas.begin(), gammas.end()), gammas.end());
  EXPECT_EQ(prepared_in_ten_steps("md-imex-3-2"), 10 * static_cast<int>(gammas.size()));
}

TEST(preconditioner, steps_do_not_depend_on_earlier_ones) {
  const heat g{1e4, 100.0};
  const auto after = [&](int steps, row u) {
    newton_problem problem(no_transport{}, g);
    problem.with_preconditioner(counted_elimination{g});
    apsis::with_stepper(apsis::find_integrator("md-imex-3-2"), problem, [&](auto march) {
      apsis::integrate(march, u, 0.0, 0.125 * steps, apsis::step_rule<double>::fixed(0.125));
    });
    return u;
  };
  row u(60);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 1.0 + std::sin(static_cast<double>(i));
  EXPECT_EQ(after(4, u), after(2, after(2, u)));
}

TEST(preconditioner, is_renewed_where_it_does_not_suffice) {
  const heat g{1e5};
  const counted_elimination inverse{g};
  int calls = 0;
  newton_problem problem(no_transport{}, g);
  problem.with_preconditioner([&](double t, view v, double gamma) -> shifted_solve<double> {
    if (++calls > 1) return inverse(t, v, gamma);
    return [](view r, std::span<double> x) { std::copy(r.begin(), r.end(), x.begin()); };  // none
  });
  row u(1500);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(static_cast<double>(i * i));
  problem.solve_collision(0, 1.0, 0.0, u);
  EXPECT_EQ(calls, 2);
}

TEST(preconditioner, refuses_functions_that_give_no_solution) {
  const heat g{1e5};
  row u(1500);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::sin(static_cast<double>(i * i));
  const auto solve_with = [&](const apsis::shifted_solves<double>& prepare) {
    newton_problem problem(no_transport{}, g);
    problem.with_preconditioner(prepare);
    problem.solve_collision(0, 1.0, 0.0, u);
  };
  const row before = u;
  bad_input::expect_refused({
      {[&] { solve_with({}); }, {"preconditioner is empty", "give a function of t, v and γ"}, 2},
      {[&] { solve_with([](double, view, double) { return shifted_solve<double>(); }); },
       {"returned no solver"},
       2},
      {[&] {
         solve_with([](double, view, double) {
           return [](view, std::span<double> x) { std::fill(x.begin(), x.end(), std::nan("")); };
         });
       },
       {"preconditioner returned a number that is not finite"},
       3},
      {[&] {
         solve_with([](double, view, double) {
           return [](view r, std::span<double> x) { std::copy(r.begin(), r.end(), x.begin()); };
         });
       },
       {"too stiff for its preconditioner", "improve the preconditioner"},
       3},
      {[&] {
         newton_problem problem(no_transport{}, g);
         problem.with_sparsity(sparsity_pattern::banded(u.size(), 1, 1))
             .with_preconditioner(counted_elimination{g});
       },
       {"sparsity pattern and a preconditioner", "give one of them"},
       2},
      {[&] {
         newton_problem problem(no_transport{}, g);
         problem.with_preconditioner(counted_elimination{g})
             .with_sparsity(sparsity_pattern::banded(u.size(), 1, 1));
       },
       {"sparsity pattern and a preconditioner"},
       2},
  });
  EXPECT_EQ(u, before);
}

}  // namespace
}  // namespace preconditioner_test
