// equal_bits KIND [THREADS] integrates the line on vectors of a kind: serial, pthreads, openmp or parallel.
// It prints the bits of the result and the counters. They must not depend on kind, threads or processes.
#include <apsis/apsis_sundials.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <nvector/nvector_pthreads.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#ifdef APSIS_WITH_OPENMP
#include <nvector/nvector_openmp.h>
#endif
#ifdef APSIS_WITH_MPI
#include <mpi.h>
#include <nvector/nvector_parallel.h>
#endif

#include "../line.hpp"

namespace {

using line_test::line;

constexpr std::ptrdiff_t cells = 97;  // not a multiple of threads or processes

/// A vector, and the part of the line on this process.
struct part {
  line of;
  N_Vector y = nullptr;
};

#ifdef APSIS_WITH_MPI
part parallel_part(SUNContext context) {
  int rank = 0, size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  part made;
  made.of.cells = cells;
  made.of.begin = cells * rank / size;
  made.of.end = cells * (rank + 1) / size;
  made.of.exchange = [rank, size](const double* own, std::size_t n, double before[2], double after[2]) {
    const int left = (rank + size - 1) % size, right = (rank + 1) % size;
    MPI_Sendrecv(own + n - 2, 2, MPI_DOUBLE, right, 0, before, 2, MPI_DOUBLE, left, 0, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
    MPI_Sendrecv(own, 2, MPI_DOUBLE, left, 1, after, 2, MPI_DOUBLE, right, 1, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
  };
  made.y = N_VNew_Parallel(MPI_COMM_WORLD, static_cast<sunindextype>(2 * made.of.own()), 2 * cells, context);
  return made;
}

/// Returns the numbers of all processes on the first one.
std::vector<double> gather(const part& of) {
  int size = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  std::vector<int> counts, begins;
  for (int k = 0; k < size; ++k) {
    begins.push_back(static_cast<int>(2 * (cells * k / size)));
    counts.push_back(static_cast<int>(2 * (cells * (k + 1) / size)) - begins.back());
  }
  std::vector<double> all(2 * cells);
  MPI_Gatherv(line_test::numbers(of.y), static_cast<int>(2 * of.of.own()), MPI_DOUBLE, all.data(),
              counts.data(), begins.data(), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return all;
}
#endif

part make_part(const std::string& kind, int threads, SUNContext context) {
#ifdef APSIS_WITH_MPI
  if (kind == "parallel") return parallel_part(context);
#endif
  part made;
  made.of.cells = made.of.end = cells;
  if (kind == "serial") made.y = N_VNew_Serial(2 * cells, context);
  if (kind == "pthreads") made.y = N_VNew_Pthreads(2 * cells, threads, context);
#ifdef APSIS_WITH_OPENMP
  if (kind == "openmp") made.y = N_VNew_OpenMP(2 * cells, threads, context);
#endif
  return made;
}

void print_bits(const std::vector<double>& values) {
  for (const double value : values) {
    unsigned long long bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    std::printf("%016llx\n", bits);
  }
}

/// Prints the result of one method. Returns true if it succeeded.
bool integrate(const char* name, bool preconditioned, part& of, SUNContext context, bool prints,
               [[maybe_unused]] bool parallel) {
  apsis_method* method = nullptr;
  apsis_sundials* s = nullptr;
  line_test::start(of.of, of.y);
  bool good =
      apsis_find_method(name, &method) == APSIS_OK &&
      apsis_sundials_create(method, line_test::transport, line_test::collision, 0.0, of.y, context, &s) == 0;
  good = good && apsis_sundials_set_user_data(s, &of.of) == APSIS_OK;
  if (preconditioned)
    good = good && apsis_sundials_set_products(s, nullptr, line_test::product) == APSIS_OK &&
           apsis_sundials_set_preconditioner(s, line_test::precondition_setup, line_test::precondition) ==
               APSIS_OK;
  // There are few steps, because on a busy machine every sum over processes waits for all of them.
  good = good && apsis_sundials_set_tolerance(s, 1e-2, 1e-3) == APSIS_OK &&
         apsis_sundials_evolve(s, 0.005, of.y, nullptr) == APSIS_OK;
  if (!good) std::fprintf(stderr, "%s: %s\n", name, apsis_error_message());
#ifdef APSIS_WITH_MPI
  const auto all = parallel
                       ? gather(of)
                       : std::vector<double>(line_test::numbers(of.y), line_test::numbers(of.y) + 2 * cells);
#else
  const std::vector<double> all(line_test::numbers(of.y), line_test::numbers(of.y) + 2 * cells);
#endif
  if (prints && good) {
    std::printf("%s\n", name);
    print_bits(all);
    for (int k = 0; k < APSIS_SUNDIALS_EVENTS; ++k) std::printf("%lld\n", apsis_sundials_count(s, k));
  }
  apsis_sundials_free(s);
  apsis_free_method(method);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "serial";
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  bool parallel = false, prints = true;
  SUNContext context = nullptr;
#ifdef APSIS_WITH_MPI
  parallel = kind == "parallel";
  MPI_Comm world = MPI_COMM_WORLD;
  if (parallel) {
    int rank = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(world, &rank);
    prints = rank == 0;
  }
#endif
  // Version 7 takes a communicator. Earlier versions take a pointer to it.
#if SUNDIALS_VERSION_MAJOR >= 7
#ifdef APSIS_WITH_MPI
  SUNContext_Create(parallel ? world : SUN_COMM_NULL, &context);
#else
  SUNContext_Create(SUN_COMM_NULL, &context);
#endif
#elif defined(APSIS_WITH_MPI)
  SUNContext_Create(parallel ? static_cast<void*>(&world) : nullptr, &context);
#else
  SUNContext_Create(nullptr, &context);
#endif
  part of = make_part(kind, threads, context);
  if (of.y == nullptr) {
    std::fprintf(stderr, "equal_bits: no vectors of the kind '%s' (not built); give another\n", kind.c_str());
    return 2;
  }
  of.of.diffusion = 0.01;
  of.of.epsilon = 1e-4;
  bool good = integrate("md-imex-5-2", true, of, context, prints, parallel);
  of.of.epsilon = 1.0;
  good = integrate("ark-436", true, of, context, prints, parallel) && good;
  good = integrate("md-imex-3-2", false, of, context, prints, parallel) && good;
  N_VDestroy(of.y);
  SUNContext_Free(&context);
#ifdef APSIS_WITH_MPI
  if (parallel) MPI_Finalize();
#endif
  return good ? 0 : 1;
}
