// Texts appear on a terminal without commanding it.
#include <apsis/core/printable.hpp>

#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace printable_test {

using apsis::printable;

TEST(printable, text_is_left_alone) {
  for (const std::string text : {"", "T(u) + Q(u)/ε, Δt ≤ r Δt_FE", "a\tb\nc", "日本語 🙂 é"})
    EXPECT_EQ(printable(text), text);
}

TEST(printable, controls_become_visible) {
  EXPECT_EQ(printable("\033]0;owned\a"), "\\u001b]0;owned\\u0007");
  EXPECT_EQ(printable("good\rbad\x7f\b"), "good\\u000dbad\\u007f\\u0008");
  EXPECT_EQ(printable(std::string("\0", 1)), "\\u0000");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\u009b31m")
      << "the control sequence introducer of one character";
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "txt.exe"),
            "\\u202etxt.exe")
      << "reversed order of characters";
}

TEST(printable, bytes_that_are_not_utf8_become_visible) {
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(printable("\xff\xc3"), "\\xff\\xc3");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b") << "longer than needed";
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "half of a pair";
}

RC_GTEST_PROP(printable, output_has_no_controls_whatever_the_bytes_are, (const std::string& bytes)) {
  const std::string text = printable(bytes);
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    RC_ASSERT(c == '\n' || c == '\t' || (c >= 0x20 && c != 0x7f));
    if (c == 0xc2) RC_ASSERT(static_cast<unsigned char>(text[k + 1]) >= 0xa0);
  }
  RC_ASSERT(printable(text) == text);
}

}  // namespace printable_test
