#include "command_registry.hpp"
#include "print.hpp"

namespace apsis::app {
namespace {

action define(CLI::App&) {
  return [] {
    print("planted and found\n");
    return 0;
  };
}

}  // namespace

extern const command_entry command_planted;
const command_entry command_planted = {
    .name = "planted", .summary = "Show that a command is one file", .define = define};

}  // namespace apsis::app
