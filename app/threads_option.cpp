#include "threads_option.hpp"

#include <apsis/exec/parallel.hpp>

#include <fmt/format.h>

namespace apsis::app {

void add_threads(CLI::App& command, std::optional<int>& threads, const std::string& what,
                 const std::string& otherwise) {
  command
      .add_option("--threads", threads,
                  fmt::format("{}, 0 for all processors; OMP_NUM_THREADS without it, or {}; results do not "
                              "depend on it",
                              what, otherwise))
      ->check(CLI::Range(0, most_threads));
}

}  // namespace apsis::app
