#pragma once

#include <apsis/method/method.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Methods in closed form, one for each number S of stages: a file of method/families/ defines
/// `extern const family_entry family_<file>`. Members are found by name like methods of the catalogue.
struct family_entry {
  std::string pattern;      ///< name with the letter S for the number of stages: "md-imex-chain-S-2"
  std::string description;  ///< one line; r and n_F in terms of S
  std::size_t lowest,       ///< smallest S of its members
      highest;              ///< largest S
  method (*make)(std::size_t stages);  ///< everything but the name
};

/// All of them.
std::vector<const family_entry*> family_entries();

/// The family whose pattern `name` has, whatever stands for S; nullptr if there is none.
const family_entry* find_family(std::string_view name);

/// "" if the family has a member of this name, otherwise why not: "md-imex-chain-S-2 has S from 3 to 64".
std::string missing_member(const family_entry& family, std::string_view name);

/// The name of the member with S stages.
std::string member_name(const family_entry& family, std::size_t stages);

/// The member called `name`, not certified. Throws input_error if there is none.
method make_member(const family_entry& family, std::string_view name);

}  // namespace apsis
