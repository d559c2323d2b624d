#include <apsis/run/surface_files.hpp>

#include <apsis/core/text_file.hpp>
#include <apsis/run/result_units.hpp>

namespace apsis {

void write_surfaces(const std::vector<surface_table>& surfaces, const case_config& config,
                    result_folder& folder) {
  const result_units units(config);
  for (const surface_table& one : surfaces) {
    const surface_table surface = units.convert(one);
    const auto add = [&](const char* ending, const std::string& text) {
      folder.add_to_series("surfaces", surface.name + ending, [&](const std::string& path) {
        write_text_file(path, text, "choose another folder with --out or free some space");
      });
    };
    add(".csv", to_csv(surface));
    if (config.space.cells.size() > 1) add(".vtp", to_vtp(to_polydata(surface)));
  }
}

}  // namespace apsis
