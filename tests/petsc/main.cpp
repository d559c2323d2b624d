#include <apsis/apsis_petsc.h>

#include <cstdio>

#include <gtest/gtest.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (PetscInitialize(&argc, &argv, nullptr, nullptr) != 0 || TSApsisRegister() != 0) return 2;
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  // Other processes print only failures.
  if (rank != 0) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    class failures final : public testing::EmptyTestEventListener {
      void OnTestPartResult(const testing::TestPartResult& part) override {
        if (part.failed())
          std::fprintf(stderr, "%s:%d: %s\n", part.file_name(), part.line_number(), part.summary());
      }
    };
    listeners.Append(new failures);
  }
  const int failed = RUN_ALL_TESTS();
  // The option checks that a remaining object is detected.
  PetscBool leave = PETSC_FALSE;
  if (PetscOptionsHasName(nullptr, nullptr, "-leave_an_object", &leave) != 0) return 2;
  if (leave == PETSC_TRUE) {
    Vec left = nullptr;
    if (VecCreateSeq(PETSC_COMM_SELF, 3, &left) != 0) return 2;
  }
  return PetscFinalize() != 0 ? 2 : failed;
}
