// A word with a single typing error gets a suggestion, and a distant word gets none.
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace suggest_test {

using apsis::nearest_word;
using apsis::suggest;

namespace {

const std::vector<std::string> functions = {"x",     "pi",   "e",    "sin",  "cos",  "tan", "asin",
                                            "acos",  "atan", "sinh", "cosh", "tanh", "exp", "log",
                                            "log10", "sqrt", "abs",  "min",  "max"};
const std::vector<std::string> keys = {"time.dt",     "time.end",       "time.method",  "time.tolerance",
                                       "space.cells", "space.boundary", "velocity.max", "velocity.points"};

/// Returns the Damerau–Levenshtein distance by its recursive definition.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  if (a.front() == b.front()) return edit_distance(a.substr(1), b.substr(1));
  std::size_t best = 1 + std::min({edit_distance(a.substr(1), b), edit_distance(a, b.substr(1)),
                                   edit_distance(a.substr(1), b.substr(1))});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
    best = std::min(best, 1 + edit_distance(a.substr(2), b.substr(2)));
  return best;
}

std::vector<std::string> slips_of(const std::string& word, std::size_t from) {
  std::vector<std::string> all;
  for (std::size_t k = from; k < word.size(); ++k) {
    all.push_back(word.substr(0, k) + word.substr(k + 1));
    all.push_back(word.substr(0, k) + "q" + word.substr(k));
    all.push_back(word.substr(0, k) + "q" + word.substr(k + 1));
    if (k + 1 < word.size()) {
      all.push_back(word);
      std::swap(all.back()[k], all.back()[k + 1]);
    }
  }
  return all;
}

}  // namespace

TEST(suggest, does_not_suggest_distant_words) {
  EXPECT_EQ(nearest_word("foo", functions), "");
  EXPECT_EQ(nearest_word("y", functions), "");
  EXPECT_EQ(nearest_word("zz", functions), "");
  EXPECT_EQ(nearest_word("time.foo", keys), "");
  EXPECT_EQ(nearest_word("time.ab", keys), "");
  EXPECT_EQ(nearest_word("paper/foo", {"paper/ode", "paper/decay"}), "");
  EXPECT_EQ(nearest_word("--ab", {"--box", "--out"}), "");
  EXPECT_EQ(nearest_word("", functions), "");
  EXPECT_EQ(nearest_word(std::string(65, 'x'), {std::string(65, 'x')}), "");
  EXPECT_EQ(suggest("foo", {"cos", "sin"}), "valid: cos, sin");
}

TEST(suggest, names_the_command_that_prints_a_long_list) {
  EXPECT_EQ(apsis::suggest_from_list("coz", {"cos", "sin"}, "apsis list x"),
            "did you mean 'cos'? see: apsis list x");
  EXPECT_EQ(apsis::suggest_from_list("foo", {"cos", "sin"}, "apsis list x"), "see: apsis list x");
}

TEST(suggest, single_slip_in_three_or_more_letters_finds_the_word_or_one_equally_close) {
  for (const auto& word : functions) {
    if (word.size() < 3) continue;
    for (const auto& slip : slips_of(word, 0)) {
      const std::string found = nearest_word(slip, functions);
      ASSERT_FALSE(found.empty()) << slip;
      EXPECT_LE(edit_distance(slip, found), 1U) << slip << " " << found;
    }
  }
  for (const auto& key : keys) {
    if (key.size() - key.find('.') < 4) continue;
    for (const auto& slip : slips_of(key, key.find('.') + 1))
      EXPECT_LE(edit_distance(slip, nearest_word(slip, keys)), 1U) << slip;
  }
}

TEST(suggest, swaps_and_case_are_ignored_in_short_words) {
  EXPECT_EQ(nearest_word("time.td", keys), "time.dt");
  EXPECT_EQ(nearest_word("ip", functions), "pi");
  EXPECT_EQ(nearest_word("X", functions), "x");
  EXPECT_EQ(nearest_word("COS", functions), "cos");
  EXPECT_EQ(nearest_word("Time.DT", keys), "time.dt");
}

TEST(suggest, suggestions_for_random_words_differ_in_at_most_a_third) {
  std::mt19937 random(3);
  int offered = 0;
  for (int k = 0; k < 4000; ++k) {
    std::string word(1 + random() % 6, ' ');
    for (char& c : word) c = "acosinqtexph"[random() % 12];
    const std::string found = nearest_word(word, functions);
    if (found.empty()) continue;
    ++offered;
    const std::size_t d = edit_distance(word, found);
    const bool swapped = d == 1 && std::is_permutation(word.begin(), word.end(), found.begin(), found.end());
    EXPECT_TRUE(3 * d <= std::max(word.size(), found.size()) || swapped) << word << " " << found;
    for (const auto& other : functions) {
      const std::size_t to_other = edit_distance(word, other);
      if (3 * to_other <= std::max(word.size(), other.size())) {
        EXPECT_LE(d, to_other) << word << " " << other;
      }
    }
  }
  EXPECT_GT(offered, 100);
}

}  // namespace suggest_test
