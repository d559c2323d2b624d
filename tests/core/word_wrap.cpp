// Breaking text into lines of limited width.
#include <apsis/core/word_wrap.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace word_wrap_test {

using apsis::word_wrap;
using testing::ElementsAre;

TEST(word_wrap, fills_lines_up_to_the_width) {
  EXPECT_THAT(word_wrap("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(word_wrap("one two three", 6), ElementsAre("one", "two", "three"));
}

TEST(word_wrap, does_not_break_words_longer_than_a_line) {
  EXPECT_THAT(word_wrap("a bcdefgh i", 3), ElementsAre("a", "bcdefgh", "i"));
}

TEST(word_wrap, collapses_whitespace_between_words) {
  EXPECT_THAT(word_wrap(" one\n\ttwo  ", 20), ElementsAre("one two"));
}

TEST(word_wrap, returns_one_empty_line_for_empty_text) {
  EXPECT_THAT(word_wrap("", 20), ElementsAre(""));
}

}  // namespace word_wrap_test
