#pragma once

#include "problems.hpp"

#include <array>
#include <cmath>

/// Equations in a plane.
namespace petsc_runs {

/// Returns a DM of n × n points of a periodic square with some components.
inline DM plane(int n, int components) {
  DM dm = nullptr;
  require(DMDACreate2d(processes(), DM_BOUNDARY_PERIODIC, DM_BOUNDARY_PERIODIC, DMDA_STENCIL_STAR, n, n,
                       PETSC_DECIDE, PETSC_DECIDE, components, 1, nullptr, nullptr, &dm));
  require(DMSetUp(dm));
  return dm;
}

/// Arrays of a DM of a plane, restored at the end: [j][i] is the point i of the row j.
class plane_points {
 public:
  using point = PetscScalar[2];
  plane_points(DM dm, Vec v) : dm_(dm), v_(v) { require(DMDAVecGetArray(dm, v, static_cast<void*>(&rows_))); }
  plane_points(const plane_points&) = delete;
  plane_points& operator=(const plane_points&) = delete;
  ~plane_points() { EXPECT_EQ(DMDAVecRestoreArray(dm_, v_, static_cast<void*>(&rows_)), 0); }
  point* operator[](PetscInt j) const { return rows_[j]; }

 private:
  DM dm_;
  Vec v_;
  point** rows_ = nullptr;
};

/// Calls body(i, j) for the points of this process.
template <class Body>
void for_own_points(DM dm, const Body& body) {
  PetscInt x = 0, y = 0, nx = 0, ny = 0;
  require(DMDAGetCorners(dm, &x, &y, nullptr, &nx, &ny, nullptr));
  for (PetscInt j = y; j < y + ny; ++j)
    for (PetscInt i = x; i < x + nx; ++i) body(i, j);
}

/// The Gray–Scott equations u_t = D₁Δu − uv² + F(1 − u), v_t = D₂Δv + uv² − (F + k)v on a periodic square,
/// with the coefficients of spots (J. E. Pearson, Complex patterns in a simple system, Science 261 (1993),
/// 189–192). The reaction is the RHSFunction, the diffusion in central differences the IFunction.
struct gray_scott {
  double length = 0.25, feed = 0.024, removal = 0.06;
  std::array<double, 2> diffusion = {8e-5, 4e-5};

  static PetscErrorCode reaction(TS, PetscReal, Vec u, Vec out, void* context) {
    const auto& self = *static_cast<gray_scott*>(context);
    PetscInt n = 0;
    const PetscScalar* from = nullptr;
    PetscScalar* to = nullptr;
    require(VecGetLocalSize(u, &n));
    require(VecGetArrayRead(u, &from));
    require(VecGetArray(out, &to));
    for (PetscInt i = 0; i < n; i += 2) {
      const double consumed = from[i] * from[i + 1] * from[i + 1];
      to[i] = self.feed * (1 - from[i]) - consumed;
      to[i + 1] = consumed - (self.feed + self.removal) * from[i + 1];
    }
    require(VecRestoreArray(out, &to));
    require(VecRestoreArrayRead(u, &from));
    return 0;
  }
  /// Returns D/h² of a component.
  double factor(DM dm, int component) const {
    PetscInt n = 0;
    require(DMDAGetInfo(dm, nullptr, &n, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
                        nullptr, nullptr, nullptr, nullptr));
    const double h = length / static_cast<double>(n);
    return diffusion[static_cast<std::size_t>(component)] / (h * h);
  }
  static PetscErrorCode diffuse(TS ts, PetscReal, Vec u, Vec rate, Vec out, void* context) {
    const auto& self = *static_cast<gray_scott*>(context);
    with_ghosts(ts, u, [&](DM dm, Vec local) {
      const plane_points from(dm, local), dot(dm, rate), to(dm, out);
      for_own_points(dm, [&](PetscInt i, PetscInt j) {
        for (int c = 0; c < 2; ++c)
          to[j][i][c] =
              dot[j][i][c] - self.factor(dm, c) * (from[j][i - 1][c] + from[j][i + 1][c] + from[j - 1][i][c] +
                                                   from[j + 1][i][c] - 4 * from[j][i][c]);
      });
    });
    return 0;
  }
  static PetscErrorCode jacobian(TS ts, PetscReal, Vec, Vec, PetscReal shift, Mat, Mat p, void* context) {
    const auto& self = *static_cast<gray_scott*>(context);
    DM dm = nullptr;
    require(TSGetDM(ts, &dm));
    for_own_points(dm, [&](PetscInt i, PetscInt j) {
      for (int c = 0; c < 2; ++c) {
        const double factor = self.factor(dm, c);
        const MatStencil row = {0, j, i, c};
        const MatStencil columns[] = {
            row, {0, j, i - 1, c}, {0, j, i + 1, c}, {0, j - 1, i, c}, {0, j + 1, i, c}};
        const PetscScalar values[] = {shift + 4 * factor, -factor, -factor, -factor, -factor};
        require(MatSetValuesStencil(p, 1, &row, 5, columns, values, INSERT_VALUES));
      }
    });
    require(MatAssemblyBegin(p, MAT_FINAL_ASSEMBLY));
    require(MatAssemblyEnd(p, MAT_FINAL_ASSEMBLY));
    return 0;
  }

  /// Sets functions and initial values.
  void enter(run& to) {
    require(TSSetRHSFunction(to.ts(), nullptr, reaction, this));
    require(TSSetIFunction(to.ts(), nullptr, diffuse, this));
    require(TSSetIJacobian(to.ts(), nullptr, nullptr, jacobian, this));
    PetscInt n = 0;
    require(DMDAGetInfo(to.dm(), nullptr, &n, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
                        nullptr, nullptr, nullptr, nullptr));
    const plane_points u(to.dm(), to.u());
    for_own_points(to.dm(), [&](PetscInt i, PetscInt j) {
      const double x = static_cast<double>(i) / static_cast<double>(n),
                   y = static_cast<double>(j) / static_cast<double>(n);
      u[j][i][1] = 0.3 * std::pow(std::sin(M_PI * x) * std::sin(M_PI * y), 2);
      u[j][i][0] = 1 - 2 * u[j][i][1];
    });
  }
};

}  // namespace petsc_runs
