// Words on lines of a width.
#include <apsis/core/word_wrap.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using apsis::word_wrap;
using testing::ElementsAre;

TEST(word_wrap, fills_lines_up_to_the_width_and_no_further) {
  EXPECT_THAT(word_wrap("one two three", 7), ElementsAre("one two", "three"));
  EXPECT_THAT(word_wrap("one two three", 6), ElementsAre("one", "two", "three"));
}

TEST(word_wrap, keeps_a_word_that_is_too_long_whole) {
  EXPECT_THAT(word_wrap("a bcdefgh i", 3), ElementsAre("a", "bcdefgh", "i"));
}

TEST(word_wrap, counts_any_blanks_between_words_as_one) {
  EXPECT_THAT(word_wrap(" one\n\ttwo  ", 20), ElementsAre("one two"));
}

TEST(word_wrap, makes_an_empty_line_of_no_words) {
  EXPECT_THAT(word_wrap("", 20), ElementsAre(""));
}
