#include "command_registry.hpp"
#include "drawing.hpp"
#include "interrupt.hpp"

#include <apsis/core/errors.hpp>

#include <memory>

namespace apsis::app {
namespace report_command {
namespace {

action define(CLI::App& command) {
  auto folders = std::make_shared<std::vector<std::string>>();
  command
      .add_option("DIR", *folders,
                  "folders of apsis run, converge or reproduce; report.html is written there")
      ->required();
  return [folders] {
    watch_for_interrupts("the end of the report");
    const int status = drawing().run("report", *folders, false);
    if (status < 0) throw io_error("the report failed (Python ended without a status); try again");
    return status;
  };
}

}  // namespace
}  // namespace report_command

extern const command_entry command_report;
const command_entry command_report = {
    .name = "report",
    .summary = "Write one page about a folder of results: summary, promises, pictures, case, manifest",
    .place = 90,
    .define = report_command::define};

}  // namespace apsis::app
