// The total variation of upwind advection does not grow in steps up to r = 1 of the method.
#include <apsis/verify/adversaries.hpp>
#include <apsis/verify/strong_stability.hpp>

#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

int main() {
  using row = std::vector<double>;
  apsis::ring_advection ring;
  const auto rows = apsis::adversarial_rows(24, 5);
  const auto variation = apsis::does_not_grow<row>("total variation", apsis::total_variation);
  const auto limit =
      apsis::largest_step(apsis::find_method("ssprk-3-3"), ring, std::span<const row>(rows), variation);
  std::printf("largest step %.5g\n", limit.kept);
  return std::abs(limit.kept - 1.0) < 1e-3 ? 0 : 1;
}
