#include "run_profile.hpp"

#include <apsis/exec/ceilings.hpp>
#include <apsis/exec/instruction_set.hpp>
#include <apsis/exec/parallel.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

double of_multiply_adds(const run_profile& profile, const kernel_totals& kernel) {
  return kernel.operations / kernel.seconds / profile.multiply_adds;
}

double of_triad(const run_profile& profile, const kernel_totals& kernel) {
  return kernel.bytes / kernel.seconds / profile.triad;
}

std::string percent(double fraction) {
  return fraction > 0.0 ? fmt::format("{:.0f} %", 100.0 * fraction) : "—";
}

double in_kernels(const run_profile& profile) {
  double seconds = 0.0;
  for (const auto& kernel : profile.kernels) seconds += kernel.seconds;
  return seconds;
}

}  // namespace

run_profile finish_profile(double wall_seconds, std::size_t numbers) {
  profile::stop();
  // The arrays are so long that the time of a sweep exceeds the resolution of the clock.
  const std::size_t count = std::max<std::size_t>(numbers, 4096);
  return {profile::read(), wall_seconds * threads(), multiply_adds_per_second(),
          triad_bytes_per_second(count)};
}

std::string profile_text(const run_profile& profile) {
  std::string out = fmt::format("profile ({}, {} thread{}; seconds are those of all threads)\n",
                                kernel_instruction_set(), threads(), threads() == 1 ? "" : "s");
  const auto line = [&out](const auto&... cell) {
    out += fmt::format("  {:<16}{:>10}{:>8}{:>11}{:>13}{:>12}{:>13}{:>11}\n", cell...);
  };
  line("kernel", "seconds", "share", "ns/number", "operations", "of fma", "bytes", "of triad");
  for (const auto& k : profile.kernels)
    line(kernel_name(k.which), fmt::format("{:.3f}", k.seconds), percent(k.seconds / profile.seconds),
         fmt::format("{:.2f}", 1e9 * k.seconds / k.numbers), fmt::format("{:.0f}", k.operations / k.numbers),
         percent(of_multiply_adds(profile, k)), fmt::format("{:.0f}", k.bytes / k.numbers),
         percent(of_triad(profile, k)));
  const double rest = profile.seconds - in_kernels(profile);
  line("the rest", fmt::format("{:.3f}", rest), percent(rest / profile.seconds), "", "", "", "", "");
  out += fmt::format(
      "  ceilings of a core, measured now: {:.1f} 10⁹ multiply–adds/s (one operation each), triad {:.1f} 10⁹ "
      "bytes/s\n  operations and bytes are per number; bytes are the compulsory memory traffic\n",
      1e-9 * profile.multiply_adds, 1e-9 * profile.triad);
  return out;
}

nlohmann::ordered_json to_json(const run_profile& profile) {
  nlohmann::ordered_json kernels = nlohmann::ordered_json::array();
  for (const auto& k : profile.kernels)
    kernels.push_back({{"kernel", kernel_name(k.which)},
                       {"seconds", k.seconds},
                       {"numbers", k.numbers},
                       {"operations", k.operations},
                       {"bytes", k.bytes},
                       {"of_multiply_adds", of_multiply_adds(profile, k)},
                       {"of_triad", of_triad(profile, k)}});
  return {{"thread_seconds", profile.seconds},
          {"multiply_adds_per_second", profile.multiply_adds},
          {"triad_bytes_per_second", profile.triad},
          {"kernels", kernels}};
}

}  // namespace apsis::app
