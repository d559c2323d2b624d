#pragma once

#include <apsis/method/method.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Methods in closed form, one for each S. S is the number of stages, unless the description states another.
/// A file of method/families/ defines `extern const family_entry family_<file>`. Members are found by name
/// like methods of the catalogue.
struct family_entry {
  std::string pattern;                 ///< name with S in place of the number: "md-imex-chain-S-2"
  std::string description;             ///< one line: order, r and n_F in terms of S
  std::size_t lowest,                  ///< smallest S of its members
      highest;                         ///< largest S
  method (*make)(std::size_t number);  ///< builds a member, except for its name
};

/// Returns all families, in the order of the registry.
std::vector<const family_entry*> family_entries();

/// Returns the family whose pattern matches `name`, with any text in place of S; nullptr if there is no such
/// family.
const family_entry* try_find_family(std::string_view name);

/// Returns why the family has no member of this name, such as "md-imex-chain-S-2 has S from 3 to 64"; "" if
/// it has one.
std::string missing_member(const family_entry& family, std::string_view name);

/// Returns the name of the member with the given S.
std::string member_name(const family_entry& family, std::size_t stages);

/// Returns the member called `name`, not certified. Throws input_error for an unknown name.
method make_member(const family_entry& family, std::string_view name);

}  // namespace apsis
