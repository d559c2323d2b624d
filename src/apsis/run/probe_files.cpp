#include <apsis/run/probe_files.hpp>

#include <apsis/core/text_file.hpp>
#include <apsis/output/probe.hpp>
#include <apsis/output/solution.hpp>

#include <fmt/format.h>

namespace apsis {
namespace {

void add_text(result_folder& folder, const std::string& series, const std::string& name,
              const std::string& text) {
  folder.add_to_series(series, name, [&text](const std::string& path) {
    write_text_file(path, text, "choose another folder with --out or free some space");
  });
}

}  // namespace

void write_probes(const case_config& config, const field_series& fields, double unit_of_length,
                  result_folder& folder) {
  for (line_probe line : config.output.probes) {
    line.scale(unit_of_length);
    add_text(folder, "probes", line.name + ".csv", to_csv(to_table(fields, line)));
  }
  for (plane_slice plane : config.output.slices) {
    plane.at *= unit_of_length;
    const field_series cut = slice_of(fields, plane);
    const std::string title = fmt::format("{} ({})", config.title, plane.name), file = plane.name + ".h5";
    folder.add_to_series("slices", file, [&](const std::string& path) { write_fields(path, title, cut); });
    add_text(folder, "slices", plane.name + ".xdmf", fields_xdmf(title, cut, file));
  }
}

}  // namespace apsis
