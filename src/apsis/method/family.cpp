#include <apsis/core/errors.hpp>
#include <apsis/method/family_registry.hpp>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Position of the letter S in the pattern "…-S" or "…-S-…".
std::size_t place_of_stages(const family_entry& family) {
  return family.pattern.find("-S") + 1;
}

std::string_view before(const family_entry& family) {
  return std::string_view(family.pattern).substr(0, place_of_stages(family));
}

std::string_view after(const family_entry& family) {
  return std::string_view(family.pattern).substr(place_of_stages(family) + 1);
}

bool has_pattern(const family_entry& family, std::string_view name) {
  return name.size() > before(family).size() + after(family).size() && name.starts_with(before(family)) &&
         name.ends_with(after(family));
}

/// Returns S of a member, 0 for any other name. Each S has one spelling: no sign, no leading zero.
std::size_t stages_of(const family_entry& family, std::string_view name) {
  if (!has_pattern(family, name)) return 0;
  for (std::size_t stages = family.lowest; stages <= family.highest; ++stages)
    if (member_name(family, stages) == name) return stages;
  return 0;
}

}  // namespace

const family_entry* try_find_family(std::string_view name) {
  for (const family_entry* family : family_entries())
    if (has_pattern(*family, name)) return family;
  return nullptr;
}

std::string member_name(const family_entry& family, std::size_t stages) {
  return fmt::format("{}{}{}", before(family), stages, after(family));
}

std::string missing_member(const family_entry& family, std::string_view name) {
  if (stages_of(family, name) != 0) return "";
  return fmt::format("{} has S from {} to {}", family.pattern, family.lowest, family.highest);
}

method make_member(const family_entry& family, std::string_view name) {
  const std::size_t stages = stages_of(family, name);
  if (stages == 0)
    throw input_error(fmt::format("no method '{}' ({}); take for example {}", name.substr(0, 60),
                                  missing_member(family, name), member_name(family, family.lowest)));
  method m = family.make(stages);
  m.name = std::string(name);
  return m;
}

}  // namespace apsis
