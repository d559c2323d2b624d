#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace apsis {

/// Kernels timed by the profiler.
enum class kernel {
  edges,        ///< reconstruction of edge values
  fluxes,       ///< flux limiter, T(u), and adding its multiples to the accumulators
  multiples,    ///< adding multiples of u alone to the accumulators
  halo,         ///< packing rows for other processes, and waiting for theirs
  walls,        ///< rows beyond surfaces, and incoming components
  cut_cells,    ///< lines in cells that bodies cut, and T(u) there
  forces,       ///< forces and sources
  points,       ///< values at Gauss points from cell averages
  equilibria,   ///< moments and equilibria
  relaxation,   ///< convex combination with the equilibrium
  derivatives,  ///< derivatives of fluxes and boundary terms by moments, in a steady run
  correction,   ///< correction of moments: assembly, factorization and solves with J
  implicit,     ///< implicit sweeps of a steady run
  mixture,      ///< mixture of iterates
  monitor       ///< minimum, conserved sums, entropy
};
/// Number of kernels.
inline constexpr std::size_t kernel_count = static_cast<std::size_t>(kernel::monitor) + 1;
/// Returns the name of a kernel in tables, such as "Gauss points".
const char* kernel_name(kernel which);

/// Work of a kernel per number of the state.
struct kernel_work {
  double operations = 0.0,  ///< operation count (exec/counted.hpp)
      bytes = 0.0;          ///< compulsory memory traffic
};

/// Work of a kernel, summed over all threads.
struct kernel_totals {
  kernel which;    ///< the kernel
  double seconds,  ///< wall-clock time
      numbers,     ///< numbers of the state processed, with repetitions
      operations,  ///< numbers times kernel_work::operations
      bytes;       ///< numbers times kernel_work::bytes
};

/// Time and work of the kernels of this process while profiling is on. Initially off, without overhead.
namespace profile {

/// Resets all sums and starts profiling.
void start();
/// Stops profiling; the sums remain.
void stop();
/// Whether profiling is on.
bool is_on();
/// Returns the sums of the kernels that ran since start().
std::vector<kernel_totals> read();
/// Adds to the sums of a kernel, even while profiling is off. Thread-safe.
void add(kernel which, double seconds, double numbers, const kernel_work& each);

/// Times the enclosing scope as one call of a kernel on `numbers` numbers.
class section {
 public:
  /// Starts the timer if profiling is on. `threads`: how many threads the scope keeps from other work.
  section(kernel which, double numbers, const kernel_work& each, int threads = 1)
      : on_(is_on()), which_(which), threads_(threads), numbers_(numbers), each_(each) {
    if (on_) start_ = std::chrono::steady_clock::now();
  }
  ~section() {
    if (on_)
      add(which_, threads_ * std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(),
          numbers_, each_);
  }
  section(const section&) = delete;
  section& operator=(const section&) = delete;

 private:
  bool on_;
  kernel which_;
  int threads_;
  double numbers_;
  kernel_work each_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace profile
}  // namespace apsis
