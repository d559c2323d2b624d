#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Returns the Damerau–Levenshtein distance with adjacent transpositions.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<std::size_t>> d(n + 1, std::vector<std::size_t>(m + 1));
  for (std::size_t i = 0; i <= n; ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= m; ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= n; ++i) {
    for (std::size_t j = 1; j <= m; ++j) {
      const std::size_t substitute = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitute});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[n][m];
}

std::string in_lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Removes the table, folder or dashes that both words share. "time.foo" is no closer to "time.dt" than "foo"
/// is to "dt".
std::pair<std::string, std::string> without_common_prefix(const std::string& a, const std::string& b) {
  std::size_t common = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()) && a[k] == b[k]; ++k)
    if (a[k] == '.' || a[k] == '/' || (a[k] == '-' && common == k)) common = k + 1;
  return {a.substr(common), b.substr(common)};
}

/// Returns true if at most a third of the letters of the longer word differ, or two neighbours are swapped.
bool is_close(const std::string& a, const std::string& b, std::size_t d) {
  if (3 * d <= std::max(a.size(), b.size())) return true;
  return d == 1 && a.size() > 1 && std::is_permutation(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates) {
  // A longer word is hardly a typing error, and the table of distances grows with its length.
  if (word.size() > 64) return "";
  std::string best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  for (const auto& candidate : candidates) {
    const auto [mine, other] = without_common_prefix(in_lower_case(word), in_lower_case(candidate));
    const std::size_t d = edit_distance(mine, other);
    if (d < best_distance && is_close(mine, other, d)) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

std::string suggest(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string closest = nearest_word(word, candidates);
  return (closest.empty() ? std::string() : fmt::format("did you mean '{}'? ", closest)) +
         fmt::format("valid: {}", fmt::join(candidates, ", "));
}

std::string suggest_from_list(const std::string& word, const std::vector<std::string>& candidates,
                              const std::string& command) {
  const std::string closest = nearest_word(word, candidates);
  return (closest.empty() ? std::string() : fmt::format("did you mean '{}'? ", closest)) + "see: " + command;
}

}  // namespace apsis
