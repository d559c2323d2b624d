#include <apsis/run/surface_files.hpp>

#include <apsis/core/text_file.hpp>
#include <apsis/run/result_units.hpp>

namespace apsis {

void write_surfaces(const std::vector<surface_table>& surfaces, const case_config& config,
                    result_folder& folder) {
  const result_units units(config);
  for (const surface_table& surface : surfaces)
    folder.add_to_series("surfaces", surface.name + ".csv", [&](const std::string& path) {
      write_text_file(path, to_csv(units.convert(surface)),
                      "choose another folder with --out or free some space");
    });
}

}  // namespace apsis
