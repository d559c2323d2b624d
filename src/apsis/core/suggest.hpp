#pragma once

#include <string>
#include <vector>

namespace apsis {

/// Returns the candidate closest to `word` in Damerau–Levenshtein distance, the first of several; "" if none
/// is close enough to have been intended: more than a third of the longer word would have to change (a swap
/// of two neighbours is always close enough), or the word has more than 64 letters. Ignores case and a common
/// prefix up to '.' or '/', or of dashes.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

/// Returns the suggestion of an input error, "did you mean 'x'? valid: a, b, c", or only "valid: …" if no
/// candidate is close.
std::string suggest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace apsis
