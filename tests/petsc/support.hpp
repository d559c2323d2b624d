#pragma once

#include <apsis/apsis_petsc.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <petscdm.h>
#include <petscdmda.h>

/// Runs of PETSc. Their errors fail a test or are expected.
namespace petsc_runs {

/// Throws if PETSc returns an error, which is the same on all processes.
inline void require(PetscErrorCode code) {
  if (code != 0) throw std::runtime_error("PETSc returned the error " + std::to_string(code));
}

/// Sets options of the program during the lifetime of the object.
class options {
 public:
  explicit options(const std::string& text) {
    require(PetscOptionsCreate(&now_));
    require(PetscOptionsInsertString(now_, text.c_str()));
    require(PetscOptionsPush(now_));
  }
  options(const options&) = delete;
  options& operator=(const options&) = delete;
  ~options() {
    EXPECT_EQ(PetscOptionsPop(), 0);
    EXPECT_EQ(PetscOptionsDestroy(&now_), 0);
  }

 private:
  PetscOptions now_ = nullptr;
};

/// Collects the messages of errors instead of printing them.
class error_messages {
 public:
  error_messages() { require(PetscPushErrorHandler(collect, this)); }
  error_messages(const error_messages&) = delete;
  error_messages& operator=(const error_messages&) = delete;
  ~error_messages() { EXPECT_EQ(PetscPopErrorHandler(), 0); }
  const std::string& first() const { return first_; }

 private:
  static PetscErrorCode collect(MPI_Comm, int, const char*, const char*, PetscErrorCode code,
                                PetscErrorType type, const char* message, void* to) {
    auto& first = static_cast<error_messages*>(to)->first_;
    if (type == PETSC_ERROR_INITIAL && first.empty()) first = message;
    return code;
  }
  std::string first_;
};

/// Outcome of TSSolve().
struct outcome {
  std::vector<double> u;  ///< all unknowns in the natural order, on every process
  double t = 0;
  int steps = 0, rejected = 0, newton = 0, krylov = 0;
  TSConvergedReason reason = TS_CONVERGED_ITERATING;
};

/// Returns all entries of a Vec on every process.
inline std::vector<double> gathered(Vec u) {
  VecScatter scatter = nullptr;
  Vec all = nullptr;
  require(VecScatterCreateToAll(u, &scatter, &all));
  require(VecScatterBegin(scatter, u, all, INSERT_VALUES, SCATTER_FORWARD));
  require(VecScatterEnd(scatter, u, all, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt n = 0;
  const PetscScalar* entries = nullptr;
  require(VecGetSize(all, &n));
  require(VecGetArrayRead(all, &entries));
  const std::vector<double> out(entries, entries + n);
  require(VecRestoreArrayRead(all, &entries));
  require(VecScatterDestroy(&scatter));
  require(VecDestroy(&all));
  return out;
}

/// Returns all entries of a Vec of a DMDA in the natural order, on every process.
inline std::vector<double> gathered_in_natural_order(DM dm, Vec u) {
  Vec natural = nullptr;
  require(DMDACreateNaturalVector(dm, &natural));
  require(DMDAGlobalToNaturalBegin(dm, u, INSERT_VALUES, natural));
  require(DMDAGlobalToNaturalEnd(dm, u, INSERT_VALUES, natural));
  auto out = gathered(natural);
  require(VecDestroy(&natural));
  return out;
}

/// Returns the largest difference of two solutions.
inline double distance(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// A TS on a DM, of type "apsis" unless options choose another.
class run {
 public:
  /// Takes ownership of the DM.
  explicit run(DM dm) : dm_(dm) {
    require(TSCreate(PetscObjectComm(reinterpret_cast<PetscObject>(dm)), &ts_));
    require(TSSetDM(ts_, dm_));
    require(DMCreateGlobalVector(dm_, &u_));
    require(TSSetExactFinalTime(ts_, TS_EXACTFINALTIME_MATCHSTEP));
    require(TSSetType(ts_, TSAPSIS));
  }
  run(const run&) = delete;
  run& operator=(const run&) = delete;
  ~run() {
    EXPECT_EQ(TSDestroy(&ts_), 0);
    EXPECT_EQ(VecDestroy(&u_), 0);
    EXPECT_EQ(DMDestroy(&dm_), 0);
  }
  TS ts() const { return ts_; }
  Vec u() const { return u_; }
  DM dm() const { return dm_; }

  /// Integrates to the end with the options of the program.
  outcome solve(double end, double dt) {
    require(TSSetMaxTime(ts_, end));
    require(TSSetTimeStep(ts_, dt));
    require(TSSetFromOptions(ts_));
    require(TSSolve(ts_, u_));
    return result();
  }
  /// Returns the current state as an outcome.
  outcome result() const {
    outcome out;
    PetscInt steps = 0, rejected = 0, newton = 0, krylov = 0;
    require(TSGetStepNumber(ts_, &steps));
    require(TSGetStepRejections(ts_, &rejected));
    require(TSGetSNESIterations(ts_, &newton));
    require(TSGetKSPIterations(ts_, &krylov));
    require(TSGetSolveTime(ts_, &out.t));
    require(TSGetConvergedReason(ts_, &out.reason));
    out.u = gathered_in_natural_order(dm_, u_);
    out.steps = static_cast<int>(steps);
    out.rejected = static_cast<int>(rejected);
    out.newton = static_cast<int>(newton);
    out.krylov = static_cast<int>(krylov);
    return out;
  }

 private:
  DM dm_;
  TS ts_ = nullptr;
  Vec u_ = nullptr;
};

/// Returns the text of -ts_view on this process.
inline std::string view_of(TS ts) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  PetscViewer viewer = nullptr;
  require(PetscViewerASCIIOpenWithFILE(PetscObjectComm(reinterpret_cast<PetscObject>(ts)), file, &viewer));
  require(TSView(ts, viewer));
  require(PetscViewerDestroy(&viewer));
  std::fclose(file);
  const std::string out(text, size);
  std::free(text);  // allocated by the C library
  return out;
}

/// Returns the communicator of new runs.
inline MPI_Comm& processes() {
  static MPI_Comm now = PETSC_COMM_WORLD;
  return now;
}

/// Returns body(), whose runs every process does alone, without waiting for other processes. Use: references.
template <class Body>
auto alone(const Body& body) {
  processes() = PETSC_COMM_SELF;
  auto out = body();
  processes() = PETSC_COMM_WORLD;
  return out;
}

/// Returns a DM of n points of a line with some components.
inline DM line(int n, int components, DMBoundaryType ends) {
  DM dm = nullptr;
  require(DMDACreate1d(processes(), ends, n, components, 1, nullptr, &dm));
  require(DMSetUp(dm));
  return dm;
}

}  // namespace petsc_runs
