#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace apsis {

/// The parts of a step of which a profile tells.
enum class kernel {
  edges,       ///< reconstruction of edge values
  fluxes,      ///< limiter of fluxes, T(u) and its multiples into the accumulators
  multiples,   ///< multiples of u alone into the accumulators
  points,      ///< values at the Gauss points of cell averages
  equilibria,  ///< moments and equilibria
  relaxation,  ///< the convex combination with the equilibrium
  monitor      ///< smallest value, conserved sums, entropy
};
/// Number of enumerators of kernel.
inline constexpr std::size_t kernel_count = static_cast<std::size_t>(kernel::monitor) + 1;
/// As tables call it: "Gauss points".
const char* kernel_name(kernel which);

/// What a kernel does for one number of the state.
struct work {
  double operations = 0.0,  ///< as exec/counted.hpp counts them
      bytes = 0.0;          ///< of fields that must go through memory, whatever stays in caches
};

/// What a kernel did, summed over all threads.
struct work_done {
  kernel which;    ///< whose sums these are
  double seconds,  ///< of the clock
      numbers,     ///< of the state that were treated, each time anew
      operations,  ///< numbers times work::operations
      bytes;       ///< numbers times work::bytes
};

/// Time and work of the kernels of this process while it is on. Off at the beginning, and then without a
/// cost.
namespace profile {

/// Sets all sums to 0, and on.
void start();
/// Sets off; the sums remain.
void stop();
/// Between start() and stop().
bool is_on();
/// Kernels that did something, since start().
std::vector<work_done> read();
/// Adds to the sums of a kernel, also while off. Any number of threads at once.
void add(kernel which, double seconds, double numbers, const work& each);

/// Times the rest of a block as `numbers` numbers treated by a kernel.
class section {
 public:
  /// The time begins here, if the profile is on.
  section(kernel which, double numbers, const work& each)
      : on_(is_on()), which_(which), numbers_(numbers), each_(each) {
    if (on_) start_ = std::chrono::steady_clock::now();
  }
  ~section() {
    if (on_)
      add(which_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), numbers_,
          each_);
  }
  section(const section&) = delete;
  section& operator=(const section&) = delete;

 private:
  bool on_;
  kernel which_;
  double numbers_;
  work each_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace profile
}  // namespace apsis
