#include "commands.hpp"
#include "drawing.hpp"
#include "interrupt.hpp"

#include <apsis/core/errors.hpp>

#include <memory>

namespace apsis::app {

void add_report(CLI::App& program, action& chosen) {
  auto folders = std::make_shared<std::vector<std::string>>();
  CLI::App* command = program.add_subcommand(
      "report", "Make one page of a folder of results: summary, promises, pictures, case, manifest");
  command->add_option("DIR", *folders, "folders of apsis run, converge or reproduce; gets report.html")
      ->required();
  command->callback([folders, &chosen] {
    chosen = [folders] {
      watch_for_interrupts("the report to end");
      const int status = drawing().run("report", *folders, false);
      if (status < 0) throw io_error("the report failed (Python ended without a status); try again");
      return status;
    };
  });
}

}  // namespace apsis::app
