// Direct and iterative linear solvers of SUNDIALS for stiff systems with known solutions.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sundials/line.hpp>
#include <sundials/support.hpp>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_spbcgs.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace sundials_solvers_test {

namespace {

using namespace sundials_test;

using matrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, decltype(&SUNMatDestroy)>;
using solver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, decltype(&SUNLinSolFree)>;

matrix owned(SUNMatrix m) {
  return {m, SUNMatDestroy};
}
solver owned(SUNLinearSolver s) {
  return {s, SUNLinSolFree};
}
using sundials_test::owned;

int robertson(double, N_Vector y, N_Vector out, void*) {
  const double* u = N_VGetArrayPointer(y);
  double* q = N_VGetArrayPointer(out);
  q[0] = -0.04 * u[0] + 1e4 * u[1] * u[2];
  q[2] = 3e7 * u[1] * u[1];
  q[1] = -q[0] - q[2];
  return 0;
}

int robertson_jacobian(double, N_Vector y, N_Vector, SUNMatrix j, void*, N_Vector, N_Vector, N_Vector) {
  const double* u = N_VGetArrayPointer(y);
  const double rows[3][3] = {
      {-0.04, 1e4 * u[2], 1e4 * u[1]}, {0.04, -1e4 * u[2] - 6e7 * u[1], -1e4 * u[1]}, {0, 6e7 * u[1], 0}};
  for (sunindextype i = 0; i < 3; ++i)
    for (sunindextype k = 0; k < 3; ++k) SM_ELEMENT_D(j, i, k) = rows[i][k];
  return 0;
}

/// The heat equation u_t = u_xx with u = 0 at the ends of [0, 1], on `points` inner points.
constexpr sunindextype points = 99;

int heat(double, N_Vector y, N_Vector out, void*) {
  const double* u = N_VGetArrayPointer(y);
  double* q = N_VGetArrayPointer(out);
  const double d = (points + 1) * (points + 1);
  for (int i = 0; i < points; ++i)
    q[i] = d * ((i > 0 ? u[i - 1] : 0.0) - 2 * u[i] + (i + 1 < points ? u[i + 1] : 0.0));
  return 0;
}

int heat_jacobian(double, N_Vector, N_Vector, SUNMatrix j, void*, N_Vector, N_Vector, N_Vector) {
  const double d = (points + 1) * (points + 1);
  for (sunindextype i = 0; i < points; ++i)
    for (sunindextype k = std::max<sunindextype>(0, i - 1); k <= std::min<sunindextype>(points - 1, i + 1);
         ++k)
      SM_ELEMENT_B(j, i, k) = i == k ? -2 * d : d;
  return 0;
}

int heat_product(N_Vector x, N_Vector jx, double t, N_Vector, N_Vector, void* data, N_Vector) {
  return heat(t, x, jx, data);
}

}  // namespace

TEST(sundials_solvers, solve_robertsons_problem_to_the_end) {
  // The solution at t = 1e11 is published by F. Mazzia, C. Magherini, Test set for initial value problem
  // solvers (2008).
  const double truth[] = {0.2083340149701255e-07, 0.8333360770334713e-13, 0.9999999791665050};
  for (const std::string name : {"extrapolated-euler-5", "imdrk-9-5-accurate", "ark-436"}) {
    const auto y = serial({1, 0, 0});
    auto s = make(name, nullptr, robertson, 0.0, y.get());
    const auto a = owned(SUNDenseMatrix(3, 3, context()));
    const auto by = owned(SUNLinSol_Dense(y.get(), a.get(), context()));
    expect_ok(apsis_sundials_set_linear_solver(s.get(), by.get(), a.get()));
    expect_ok(apsis_sundials_set_jacobian(s.get(), robertson_jacobian));
    expect_ok(apsis_sundials_set_tolerances(s.get(), 1e-6, serial({1e-14, 1e-20, 1e-8}).get()));
    expect_ok(apsis_sundials_evolve(s.get(), 1e11, y.get(), nullptr));
    // Over 1e11 time units the errors add up to some tens of tolerances.
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(values(y.get())[i] / truth[i], 1.0, 1e-4) << name << " " << i;
    EXPECT_LT(apsis_sundials_count(s.get(), APSIS_SUNDIALS_STEPS), 3000) << name;
  }
}

TEST(sundials_solvers, solve_the_heat_equation_by_a_band_by_gmres_and_by_bicgstab) {
  // A mode decays with its eigenvalue of the difference operator.
  const double rate = std::pow(2.0 * (points + 1) * std::sin(M_PI / (2.0 * (points + 1))), 2);
  std::vector<double> u0;
  for (int i = 0; i < points; ++i) u0.push_back(std::sin(M_PI * (i + 1) / (points + 1)));
  for (const std::string name : {"imdrk-9-5-accurate", "extrapolated-euler-5"})
    for (const std::string how : {"band", "gmres", "bicgstab", "own"}) {
      const auto y = serial(u0);
      auto s = make(name, nullptr, heat, 0.0, y.get());
      const auto a = owned(SUNBandMatrix(points, 1, 1, context()));
      const auto band = owned(SUNLinSol_Band(y.get(), a.get(), context()));
      const auto gmres = owned(SUNLinSol_SPGMR(y.get(), SUN_PREC_NONE, 60, context()));
      const auto bicgstab = owned(SUNLinSol_SPBCGS(y.get(), SUN_PREC_NONE, 400, context()));
      if (how == "band") {
        expect_ok(apsis_sundials_set_linear_solver(s.get(), band.get(), a.get()));
        expect_ok(apsis_sundials_set_jacobian(s.get(), heat_jacobian));
      } else {
        expect_ok(apsis_sundials_set_products(s.get(), nullptr, heat_product));
        if (how != "own")
          expect_ok(apsis_sundials_set_linear_solver(s.get(), how == "gmres" ? gmres.get() : bicgstab.get(),
                                                     nullptr));
      }
      expect_ok(apsis_sundials_set_tolerance(s.get(), 1e-6, 1e-8));
      expect_ok(apsis_sundials_evolve(s.get(), 0.1, y.get(), nullptr));
      for (std::size_t i = 0; i < points; i += 14)
        EXPECT_NEAR(values(y.get())[i], u0[i] * std::exp(-0.1 * rate), 2e-6) << name << " " << how;
    }
}

TEST(sundials_solvers, need_few_iterations_however_stiff_the_equation_is) {
  // (I − γJ)⁻² brings the spectrum between 1/2 and 1. By Chebyshev's bound each iteration of GMRES then
  // reduces the error by a factor of 5.8, so 1e-10 takes 13 iterations.
  for (const double dt : {1e-3, 1e-1, 1e1, 1e4}) {
    std::vector<double> u0;
    for (int i = 0; i < points; ++i)
      u0.push_back(std::sin(M_PI * (i + 1) / (points + 1)) + ((i * 7) % 5) * 0.1);
    const auto y = serial(u0);
    auto s = make("imdrk-9-5-accurate", nullptr, heat, 0.0, y.get());
    const auto a = owned(SUNBandMatrix(points, 1, 1, context()));
    const auto band = owned(SUNLinSol_Band(y.get(), a.get(), context()));
    expect_ok(apsis_sundials_set_linear_solver(s.get(), band.get(), a.get()));
    expect_ok(apsis_sundials_set_jacobian(s.get(), heat_jacobian));
    expect_ok(apsis_sundials_set_step(s.get(), dt));
    expect_ok(apsis_sundials_evolve(s.get(), dt, y.get(), nullptr));
    const auto linear = apsis_sundials_count(s.get(), APSIS_SUNDIALS_LINEAR_ITERATIONS);
    const auto newton = apsis_sundials_count(s.get(), APSIS_SUNDIALS_NEWTON_ITERATIONS);
    EXPECT_LT(static_cast<double>(linear) / static_cast<double>(newton), 13.0) << dt;
    EXPECT_LT(newton, 8 * apsis_sundials_count(s.get(), APSIS_SUNDIALS_STAGE_SOLVES)) << dt;
  }
}

}  // namespace sundials_solvers_test
