#pragma once

#include <string>
#include <vector>

namespace apsis {

/// Returns the candidate closest to `word` in Damerau–Levenshtein distance, the first of several. Returns ""
/// if no candidate is close, or if `word` has more than 64 letters. A candidate is close if at most a third
/// of the letters of the longer word change, or if two neighbours are swapped. Case and a common prefix are
/// ignored; the prefix ends with '.' or '/', or consists of dashes.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

/// Returns the suggestion of an input error: "did you mean 'x'? valid: a, b, c", or only "valid: …" if no
/// candidate is close.
std::string suggest(const std::string& word, const std::vector<std::string>& candidates);

/// Returns "did you mean 'x'? see: command", or only "see: command" if no candidate is close. This is for
/// lists that are too long for a message; `command` prints the list.
std::string suggest_from_list(const std::string& word, const std::vector<std::string>& candidates,
                              const std::string& command);

}  // namespace apsis
