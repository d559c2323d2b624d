#include <apsis/run/surface_files.hpp>

#include <apsis/core/text_file.hpp>
#include <apsis/run/result_units.hpp>

namespace apsis {

void write_surfaces(const simulation& run, result_folder& folder) {
  const result_units units(run.config());
  for (const surface_table& surface : run.surfaces())
    folder.add_to_series("surfaces", surface.name + ".csv", [&](const std::string& path) {
      write_text_file(path, to_csv(units.convert(surface)),
                      "choose another folder with --out or free some space");
    });
}

}  // namespace apsis
