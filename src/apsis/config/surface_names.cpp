#include <apsis/config/surface_names.hpp>

#include <apsis/config/case_text.hpp>
#include <apsis/config/surface_tables.hpp>

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace apsis {
namespace {

bool is_surface_name(const std::string& text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
}

}  // namespace

void check_surface_name(const case_config& config, const std::string& path, const std::string& name,
                        const std::vector<std::string>& earlier) {
  std::vector<std::string> taken(face_names.begin(), face_names.end());
  taken.insert(taken.end(), balance_terms.begin(), balance_terms.end());
  taken.emplace_back(all_surfaces);
  taken.insert(taken.end(), earlier.begin(), earlier.end());
  if (is_surface_name(name) && std::find(taken.begin(), taken.end(), name) == taken.end()) return;
  throw input_error(
      place_of(config, path + ".name"),
      fmt::format("'{}.name' = \"{}\" cannot be used ({}); choose another name", path, shown(name),
                  is_surface_name(name) ? "it is taken" : "letters, digits, - and _ only"));
}

}  // namespace apsis
