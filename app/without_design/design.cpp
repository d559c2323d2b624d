#include "command_registry.hpp"

#include <apsis/core/errors.hpp>

namespace apsis::app {
namespace {

int refuse() {
  throw input_error(
      "command line: apsis design is not part of this program (it was built without Ipopt); install "
      "coinor-libipopt-dev and build it again");
}

action define(CLI::App& command) {
  command.allow_extras();
  return refuse;
}

}  // namespace

/// The command of a program without the component design, which reports what is missing.
extern const command_entry command_design;
const command_entry command_design = {
    .name = "design",
    .summary = "Find a new method (not part of this program: built without Ipopt)",
    .place = 70,
    .define = define};

}  // namespace apsis::app
