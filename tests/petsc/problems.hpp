#pragma once

#include "support.hpp"

#include <cmath>
#include <vector>

/// Equations of the kinds that PETSc's tutorials integrate.
namespace petsc_runs {

/// Arrays of a DM, restored at the end.
template <int Components>
class points {
 public:
  using row = PetscScalar[Components];
  points(DM dm, Vec v) : dm_(dm), v_(v) { require(DMDAVecGetArray(dm, v, static_cast<void*>(&rows_))); }
  points(const points&) = delete;
  points& operator=(const points&) = delete;
  ~points() { EXPECT_EQ(DMDAVecRestoreArray(dm_, v_, static_cast<void*>(&rows_)), 0); }
  row& operator[](PetscInt i) const { return rows_[i]; }

 private:
  DM dm_;
  Vec v_;
  row* rows_ = nullptr;
};

/// The points of this process.
struct own_points {
  PetscInt begin = 0, end = 0, all = 0;
  explicit own_points(DM dm) {
    require(DMDAGetCorners(dm, &begin, nullptr, nullptr, &end, nullptr, nullptr));
    end += begin;
    require(DMDAGetInfo(dm, nullptr, &all, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
                        nullptr, nullptr, nullptr, nullptr));
  }
};

/// Calls body(dm, u) for u with ghost points.
template <class Body>
void with_ghosts(TS ts, Vec u, const Body& body) {
  DM dm = nullptr;
  Vec local = nullptr;
  require(TSGetDM(ts, &dm));
  require(DMGetLocalVector(dm, &local));
  require(DMGlobalToLocal(dm, u, INSERT_VALUES, local));
  body(dm, local);
  require(DMRestoreLocalVector(dm, &local));
}

/// u_t + u_x = q/ε, v_t = −q/ε with q = v − u² (nonlinear) or v − 2u, by upwind differences on a periodic
/// line. u + v is conserved. The limit ε → 0 is the conservation law of u + v with the flux u.
struct exchange {
  double epsilon = 1e-2;
  bool nonlinear = true;
  int calls_of_jacobian = 0;

  static PetscErrorCode transport(TS ts, PetscReal, Vec u, Vec out, void*) {
    with_ghosts(ts, u, [out](DM dm, Vec local) {
      const own_points own(dm);
      const points<2> from(dm, local), to(dm, out);
      for (PetscInt i = own.begin; i < own.end; ++i) {
        to[i][0] = -static_cast<double>(own.all) * (from[i][0] - from[i - 1][0]);
        to[i][1] = 0;
      }
    });
    return 0;
  }
  static PetscErrorCode collision(TS, PetscReal, Vec u, Vec rate, Vec out, void* context) {
    const auto& self = *static_cast<exchange*>(context);
    PetscInt n = 0;
    const PetscScalar *from = nullptr, *dot = nullptr;
    PetscScalar* to = nullptr;
    require(VecGetLocalSize(u, &n));
    require(VecGetArrayRead(u, &from));
    require(VecGetArrayRead(rate, &dot));
    require(VecGetArray(out, &to));
    for (PetscInt i = 0; i < n; i += 2) {
      const double q = (from[i + 1] - (self.nonlinear ? from[i] * from[i] : 2 * from[i])) / self.epsilon;
      to[i] = dot[i] - q;
      to[i + 1] = dot[i + 1] + q;
    }
    require(VecRestoreArray(out, &to));
    require(VecRestoreArrayRead(rate, &dot));
    require(VecRestoreArrayRead(u, &from));
    return 0;
  }
  static PetscErrorCode jacobian(TS, PetscReal, Vec u, Vec, PetscReal shift, Mat a, Mat p, void* context) {
    auto& self = *static_cast<exchange*>(context);
    ++self.calls_of_jacobian;
    PetscInt n = 0, first = 0;
    const PetscScalar* from = nullptr;
    require(VecGetLocalSize(u, &n));
    require(VecGetOwnershipRange(u, &first, nullptr));
    require(VecGetArrayRead(u, &from));
    for (PetscInt i = 0; i < n; i += 2) {
      const PetscInt rows[] = {first + i, first + i + 1};
      const double slope = (self.nonlinear ? 2 * from[i] : 2) / self.epsilon, one = 1 / self.epsilon;
      const PetscScalar block[] = {shift + slope, -one, -slope, shift + one};
      require(MatSetValues(p, 2, rows, 2, rows, block, INSERT_VALUES));
    }
    require(VecRestoreArrayRead(u, &from));
    require(MatAssemblyBegin(p, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(p, MAT_FINAL_ASSEMBLY));
    if (a == p) return 0;
    require(MatAssemblyBegin(a, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(a, MAT_FINAL_ASSEMBLY));
    return 0;
  }

  /// Sets functions and initial values. v is in equilibrium, or 0.
  void enter(run& to, bool at_equilibrium = true, bool with_jacobian = true) {
    require(TSSetRHSFunction(to.ts(), nullptr, transport, this));
    require(TSSetIFunction(to.ts(), nullptr, collision, this));
    if (with_jacobian) require(TSSetIJacobian(to.ts(), nullptr, nullptr, jacobian, this));
    const own_points own(to.dm());
    const points<2> u(to.dm(), to.u());
    for (PetscInt i = own.begin; i < own.end; ++i) {
      u[i][0] = 1 + 0.5 * std::sin(2 * M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(own.all));
      u[i][1] = !at_equilibrium ? 0 : nonlinear ? u[i][0] * u[i][0] : 2 * u[i][0];
    }
  }
};

/// The exchange with diffusion: u_t + u_x = Du_xx + q/ε, v_t = Dv_xx − q/ε. Diffusion belongs to the
/// IFunction.
struct diffusive_exchange : exchange {
  static constexpr double diffusion = 0.05;

  static double factor(const own_points& own) {
    return diffusion * static_cast<double>(own.all) * static_cast<double>(own.all);
  }
  static PetscErrorCode collision(TS ts, PetscReal t, Vec u, Vec rate, Vec out, void* context) {
    require(exchange::collision(ts, t, u, rate, out, context));
    with_ghosts(ts, u, [out](DM dm, Vec local) {
      const own_points own(dm);
      const points<2> from(dm, local), to(dm, out);
      for (PetscInt i = own.begin; i < own.end; ++i)
        for (int c = 0; c < 2; ++c)
          to[i][c] -= factor(own) * (from[i - 1][c] - 2 * from[i][c] + from[i + 1][c]);
    });
    return 0;
  }
  static PetscErrorCode jacobian(TS ts, PetscReal t, Vec u, Vec rate, PetscReal shift, Mat a, Mat p,
                                 void* context) {
    DM dm = nullptr;
    require(TSGetDM(ts, &dm));
    const own_points own(dm);
    // The exchange sets its blocks, and the diagonal gets 2D/h² by the shift.
    require(exchange::jacobian(ts, t, u, rate, shift + 2 * factor(own), a, p, context));
    for (PetscInt i = own.begin; i < own.end; ++i)
      for (int c = 0; c < 2; ++c) {
        const MatStencil row = {0, 0, i, c}, columns[] = {{0, 0, i - 1, c}, {0, 0, i + 1, c}};
        const PetscScalar values[] = {-factor(own), -factor(own)};
        require(MatSetValuesStencil(p, 1, &row, 2, columns, values, INSERT_VALUES));
      }
    require(MatAssemblyBegin(p, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(p, MAT_FINAL_ASSEMBLY));
    return 0;
  }
  void enter(run& to) {
    exchange::enter(to, true, false);
    require(TSSetIFunction(to.ts(), nullptr, collision, static_cast<exchange*>(this)));
    require(TSSetIJacobian(to.ts(), nullptr, nullptr, jacobian, static_cast<exchange*>(this)));
  }
};

/// The Brusselator u_t = 1 − 4u + u²v + αu_xx, v_t = 3u − u²v + αv_xx with u = 1 and v = 3 at both ends. The
/// reaction is the RHSFunction, the diffusion the IFunction.
struct brusselator {
  double alpha = 1.0 / 50;

  static PetscErrorCode reaction(TS, PetscReal, Vec u, Vec out, void*) {
    PetscInt n = 0;
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    require(VecGetLocalSize(u, &n));
    require(VecGetArrayRead(u, &from));
    require(VecGetArray(out, &to));
    for (PetscInt i = 0; i < n; i += 2) {
      const double square = from[i] * from[i] * from[i + 1];
      to[i] = 1 - 4 * from[i] + square;
      to[i + 1] = 3 * from[i] - square;
    }
    require(VecRestoreArray(out, &to));
    require(VecRestoreArrayRead(u, &from));
    return 0;
  }
  double factor(const own_points& own) const {
    const auto intervals = static_cast<double>(own.all + 1);
    return alpha * intervals * intervals;
  }
  static PetscErrorCode diffusion(TS ts, PetscReal, Vec u, Vec rate, Vec out, void* context) {
    const auto& self = *static_cast<brusselator*>(context);
    with_ghosts(ts, u, [&](DM dm, Vec local) {
      const own_points own(dm);
      const points<2> from(dm, local), dot(dm, rate), to(dm, out);
      const double ends[] = {1, 3}, factor = self.factor(own);
      for (PetscInt i = own.begin; i < own.end; ++i)
        for (int c = 0; c < 2; ++c) {
          const double left = i > 0 ? from[i - 1][c] : ends[c],
                       right = i + 1 < own.all ? from[i + 1][c] : ends[c];
          to[i][c] = dot[i][c] - factor * (left - 2 * from[i][c] + right);
        }
    });
    return 0;
  }
  static PetscErrorCode jacobian(TS ts, PetscReal, Vec, Vec, PetscReal shift, Mat, Mat p, void* context) {
    const auto& self = *static_cast<brusselator*>(context);
    DM dm = nullptr;
    require(TSGetDM(ts, &dm));
    const own_points own(dm);
    const double factor = self.factor(own);
    for (PetscInt i = own.begin; i < own.end; ++i)
      for (int c = 0; c < 2; ++c) {
        MatStencil row{}, columns[3] = {};
        row.i = i;
        row.c = c;
        PetscScalar values[3] = {};
        PetscInt count = 0;
        for (PetscInt j = i - 1; j <= i + 1; ++j) {
          if (j < 0 || j >= own.all) continue;
          columns[count].i = j;
          columns[count].c = c;
          values[count++] = j == i ? shift + 2 * factor : -factor;
        }
        require(MatSetValuesStencil(p, 1, &row, count, columns, values, INSERT_VALUES));
      }
    require(MatAssemblyBegin(p, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(p, MAT_FINAL_ASSEMBLY));
    return 0;
  }
  void enter(run& to, bool with_jacobian = true) {
    require(TSSetRHSFunction(to.ts(), nullptr, reaction, this));
    require(TSSetIFunction(to.ts(), nullptr, diffusion, this));
    if (with_jacobian) require(TSSetIJacobian(to.ts(), nullptr, nullptr, jacobian, this));
    const own_points own(to.dm());
    const points<2> u(to.dm(), to.u());
    for (PetscInt i = own.begin; i < own.end; ++i) {
      u[i][0] = 1 + std::sin(2 * M_PI * static_cast<double>(i + 1) / static_cast<double>(own.all + 1));
      u[i][1] = 3;
    }
  }
};

/// The heat equation u_t = u_xx with u = 0 at both ends in central differences. u' = Au is the RHSFunction
/// with the constant RHSJacobian A. From sin πx the solution is exactly exp(λt) sin πx.
struct heat {
  Mat a = nullptr;
  double lambda = 0;

  heat() = default;
  heat(const heat&) = delete;
  heat& operator=(const heat&) = delete;
  ~heat() { EXPECT_EQ(MatDestroy(&a), 0); }
  void enter(run& to) {
    const own_points own(to.dm());
    const auto intervals = static_cast<double>(own.all + 1);
    const double factor = intervals * intervals;
    lambda = -4 * factor * std::pow(std::sin(M_PI / (2 * intervals)), 2);
    require(DMCreateMatrix(to.dm(), &a));
    const points<1> u(to.dm(), to.u());
    for (PetscInt i = own.begin; i < own.end; ++i) {
      u[i][0] = std::sin(M_PI * static_cast<double>(i + 1) / intervals);
      for (PetscInt j = i - 1; j <= i + 1; ++j)
        if (j >= 0 && j < own.all)
          require(MatSetValue(a, i, j, j == i ? -2 * factor : factor, INSERT_VALUES));
    }
    require(MatAssemblyBegin(a, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(a, MAT_FINAL_ASSEMBLY));
    require(TSSetRHSFunction(to.ts(), nullptr, TSComputeRHSFunctionLinear, nullptr));
    require(TSSetRHSJacobian(to.ts(), a, a, TSComputeRHSJacobianConstant, nullptr));
  }
};

}  // namespace petsc_runs
