// Blocks of the filter "lzf": blocks written by hand and damaged blocks.
#include <apsis/output/lzf_filter.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace lzf_filter_test {

using bytes = std::vector<unsigned char>;

namespace {

std::string expanded(const bytes& block, std::size_t room) {
  bytes out(room);
  out.resize(apsis::expand_lzf(block, out));
  return {out.begin(), out.end()};
}

}  // namespace

TEST(lzf, literals_and_copies_are_expanded) {
  EXPECT_EQ(expanded({2, 'a', 'b', 'c'}, 3), "abc");
  EXPECT_EQ(expanded({2, 'a', 'b', 'c', 1U << 5U, 2}, 6), "abcabc") << "three bytes, from three before";
  EXPECT_EQ(expanded({0, 'a', 7U << 5U, 3, 0}, 13), std::string(13, 'a')) << "a copy that overlaps itself";
}

TEST(lzf, damaged_blocks_are_refused) {
  EXPECT_EQ(expanded({2, 'a', 'b'}, 10), "") << "literals are missing";
  EXPECT_EQ(expanded({0, 'a', 1U << 5U}, 10), "") << "the distance is missing";
  EXPECT_EQ(expanded({0, 'a', 7U << 5U}, 10), "") << "the length is missing";
  EXPECT_EQ(expanded({0, 'a', 1U << 5U, 1}, 10), "") << "a copy from before the beginning";
  EXPECT_EQ(expanded({2, 'a', 'b', 'c'}, 2), "") << "no room";
  EXPECT_EQ(expanded({0, 'a', 7U << 5U, 3, 0}, 12), "") << "no room";
}

/// The address sanitizer finds writes beyond `out`.
RC_GTEST_PROP(lzf, any_bytes_stay_within_the_room, (const bytes& block)) {
  const auto room = *rc::gen::inRange<std::size_t>(0, 100);
  RC_ASSERT(expanded(block, room).size() <= room);
}

}  // namespace lzf_filter_test
