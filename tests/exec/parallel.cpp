// Blocks of parallel loops over cells.
#include <apsis/exec/parallel.hpp>

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace parallel_test {

TEST(part_blocks, partition_the_range_into_blocks_of_limited_length) {
  for (const int n : {0, 1, 2, 7, 40, 63, 64, 65, 400, 1000, 12345})
    for (const int longest : {1, 6, 26, 64, 4096})
      for (const int parts : {1, 2, 3, 8, 64}) {
        const apsis::part_blocks blocks(n, longest, parts);
        EXPECT_EQ(blocks.begin(0), 0);
        EXPECT_EQ(blocks.begin(blocks.count()), n);
        for (int k = 0; k < blocks.count(); ++k) {
          EXPECT_LE(blocks.begin(k), blocks.end(k)) << n << " " << longest << " " << parts;
          EXPECT_LE(blocks.end(k) - blocks.begin(k), longest) << n << " " << longest << " " << parts;
        }
      }
}

TEST(part_blocks, assign_the_same_part_to_a_thread_for_any_block_length) {
  constexpr int n = 1000;
  for (const int parts : {2, 3, 8})
    for (int p = 0; p < parts; ++p)
      for (const int longest : {1, 13, 64, 512}) {
        const apsis::part_blocks blocks(n, longest, parts);
        EXPECT_EQ(blocks.begin(blocks.count() / parts * p), n * p / parts) << longest;
      }
}

TEST(part_blocks, taper_at_the_end_of_a_long_part) {
  const apsis::part_blocks blocks(1000, 100, 2);
  const int per_part = blocks.count() / 2;
  for (const int last : {per_part - 1, blocks.count() - 1})
    EXPECT_LE(blocks.end(last) - blocks.begin(last), 100 / 8 + 1);
  EXPECT_EQ(apsis::part_blocks(1000, 100, 1).count(), 10) << "one thread needs no load balance";
}

TEST(parallel_blocks, process_every_index_once_and_propagate_exceptions) {
  for (const int threads : {1, 2, 5}) {
    apsis::set_threads(threads);
    for (const int n : {0, 1, 3, 100, 999}) {
      std::vector<std::atomic<int>> seen(static_cast<std::size_t>(n));
      apsis::parallel_blocks(n, 7, [&](int begin, int end) {
        ASSERT_LT(begin, end);
        for (int k = begin; k < end; ++k) ++seen[static_cast<std::size_t>(k)];
      });
      for (const auto& count : seen) EXPECT_EQ(count, 1);
    }
    const auto fail = [](int begin, int) {
      if (begin >= 50) throw begin;
    };
    EXPECT_THROW(apsis::parallel_blocks(100, 7, fail), int);
  }
  apsis::set_threads(1);
}

TEST(loops_over, few_numbers_run_on_the_caller_alone) {
  apsis::set_threads(3);
  {
    const apsis::loops_over few(apsis::fewest_shared_numbers - 1);
    EXPECT_EQ(apsis::threads_here(), 1);
    const auto caller = std::this_thread::get_id();
    apsis::parallel_for(8, [&](int) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      EXPECT_EQ(apsis::thread_number(), 0);
    });
    {
      const apsis::loops_over inner(0);
      EXPECT_EQ(apsis::threads_here(), 1);
    }
    EXPECT_EQ(apsis::threads_here(), 1) << "the inner one must not end the outer one";
  }
  EXPECT_EQ(apsis::threads_here(), 3);
  {
    const apsis::loops_over many(apsis::fewest_shared_numbers);
    EXPECT_EQ(apsis::threads_here(), 3);
  }
  apsis::share_loops_from(0);
  {
    const apsis::loops_over nothing(0);
    EXPECT_EQ(apsis::threads_here(), 3);
  }
  apsis::share_loops_from(apsis::fewest_shared_numbers);
  apsis::set_threads(1);
}

}  // namespace parallel_test
