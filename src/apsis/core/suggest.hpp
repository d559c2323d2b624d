#pragma once

#include <string>
#include <vector>

namespace apsis {

/// The candidate nearest to `word` in Damerau–Levenshtein distance, or "" when none is near enough to be
/// what was meant (more than a third of the word would have to change, at least two letters are allowed; or
/// the word has more than 64).
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// "did you mean 'x'? valid: a, b, c" — the suggestion part of an input error; from "valid" on if
/// nothing is near.
std::string suggest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace apsis
