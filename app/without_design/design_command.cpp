#include "../commands.hpp"

#include <apsis/core/errors.hpp>

namespace apsis::app {

/// The command of a program without the component design: it is there, and says what is missing.
void add_design(CLI::App& program, action& chosen) {
  CLI::App* command =
      program.add_subcommand("design", "Find a new method (not part of this program: built without Ipopt)");
  command->allow_extras();
  command->callback([&chosen] {
    chosen = []() -> int {
      throw input_error(
          "command line: apsis design is not part of this program (it was built without Ipopt); install "
          "coinor-libipopt-dev and build it again");
    };
  });
}

}  // namespace apsis::app
