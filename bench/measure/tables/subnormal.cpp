// Cost of subnormal numbers in the tails of a cold gas, and the gain from flushing them to zero.
#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace apsis::bench::subnormal_table {
namespace {

#if defined(__SSE2__)

/// Sets flush-to-zero (FTZ) and denormals-are-zero (DAZ) for this thread during its lifetime.
class flush_to_zero {
 public:
  flush_to_zero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
  ~flush_to_zero() { _mm_setcsr(before_); }
  flush_to_zero(const flush_to_zero&) = delete;
  flush_to_zero& operator=(const flush_to_zero&) = delete;

 private:
  unsigned before_;
};

struct outcome {
  double share, gain;  ///< share of subnormal values, and time without over time with flushing
};

/// Compares steps without and with flushing. Both start from a state whose tails contain subnormal numbers.
outcome compare(const std::string& discretization, int max, const settings& options) {
  const std::vector<std::string> grid = {fmt::format("velocity.max={}", max),
                                         fmt::format("velocity.points={}", 10 * max)};
  mixed_step plain(discretization, "md-imex-3-2", 40, grid), flushed(discretization, "md-imex-3-2", 40, grid);
  const int warm_up = options.quick ? 2 : 100, turns = options.quick ? 1 : 5 * options.repeats;
  plain.take(warm_up);
  flushed.take(warm_up);
  const int steps = plain.steps_in(options.quick ? 0.002 : 0.02);
  const auto seconds = in_turns({[&] { plain.take(steps); },
                                 [&] {
                                   const flush_to_zero now;
                                   flushed.take(steps);
                                 }},
                                turns);
  return {plain.subnormal_share(), median_ratio(seconds, 0, 1)};
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Subnormal numbers";
  result.note =
      "The table shows the share of subnormal values of f after some steps. The steps are those of the "
      "mixed-regime problem (40 cells, spacing 0.2, md-imex-3-2, one thread). The time of a step is "
      "relative to a step with flush-to-zero. Times are medians over the turns.";
  result.columns = {"v_max", "finite volumes: subnormal", "time", "finite differences: subnormal", "time"};
  for (const int max : {15, 60, 120}) {
    const auto fv = compare("finite-volume", max, options), fd = compare("finite-difference", max, options);
    result.rows.push_back({max, fmt::format("{:.1f} %", 100.0 * fv.share), fmt::format("{:.2f}", fv.gain),
                           fmt::format("{:.1f} %", 100.0 * fd.share), fmt::format("{:.2f}", fd.gain)});
  }
  return result;
}

#else

result_table measure(const settings&) {
  result_table result;
  result.title = "Subnormal numbers";
  result.note =
      "Subnormal numbers are measured on x86 only, because its control register can flush them to zero.";
  return result;
}

#endif

const registered here({"subnormal", "gain from flushing subnormal numbers to zero", measure});

}  // namespace
}  // namespace apsis::bench::subnormal_table
