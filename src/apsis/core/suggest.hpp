#pragma once

#include <string>
#include <vector>

namespace apsis {

/// The candidate nearest to `word` in Damerau–Levenshtein distance, the first of several; "" where none is
/// near enough to be what was meant: more than a third of the longer word would have to change, unless by a
/// swap of two neighbours, or the word has more than 64 letters. Case is ignored, and a common prefix up to
/// '.' or '/', or of dashes, does not count.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// "did you mean 'x'? valid: a, b, c" — the suggestion part of an input error; from "valid" on if
/// nothing is near.
std::string suggest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace apsis
