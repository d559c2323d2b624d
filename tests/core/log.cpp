// Log messages: format, verbosity levels, and atomic lines when several threads write.
#include <apsis/core/log.hpp>

#include <apsis/core/warning_record.hpp>
#include <apsis/core/warnings_once.hpp>

#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace log_test {

namespace {

using testing::internal::CaptureStderr;
using testing::internal::GetCapturedStderr;

std::vector<std::string> received;

void receive(const std::string& message) {
  received.push_back(message);
}

/// Restores full verbosity and standard error when a test ends.
struct log_of_messages : testing::Test {
  ~log_of_messages() override {
    apsis::log::set_level(apsis::log::level::info);
    apsis::log::set_warning_receiver(nullptr);
  }

  static std::string both_at(apsis::log::level lowest) {
    apsis::log::set_level(lowest);
    CaptureStderr();
    apsis::log::info("100% of {}");
    apsis::log::warning("too long (3 s); stop");
    return GetCapturedStderr();
  }
};

TEST_F(log_of_messages, prefixes_the_level_and_does_not_format_the_text) {
  EXPECT_EQ(both_at(apsis::log::level::info), "info: 100% of {}\nwarning: too long (3 s); stop\n");
}

TEST_F(log_of_messages, level_warning_hides_info_messages) {
  EXPECT_EQ(both_at(apsis::log::level::warning), "warning: too long (3 s); stop\n");
}

TEST_F(log_of_messages, level_quiet_hides_all_messages) {
  EXPECT_EQ(both_at(apsis::log::level::quiet), "");
}

TEST_F(log_of_messages, a_receiver_gets_the_warnings_that_standard_error_would_show) {
  received.clear();
  EXPECT_EQ(apsis::log::set_warning_receiver(receive), nullptr);
  const apsis::warning_record record;
  CaptureStderr();
  apsis::log::warning("first");
  apsis::log::info("no warning");
  apsis::log::set_level(apsis::log::level::quiet);
  apsis::log::warning("hidden");
  apsis::log::set_level(apsis::log::level::warning);
  EXPECT_EQ(apsis::log::set_warning_receiver(nullptr), receive);
  apsis::log::warning("second");
  EXPECT_EQ(GetCapturedStderr(), "info: no warning\nwarning: second\n");
  EXPECT_THAT(received, testing::ElementsAre("first"));
  EXPECT_THAT(record.messages(), testing::ElementsAre("first", "hidden", "second"));
}

TEST_F(log_of_messages, records_of_warnings_have_those_of_their_life_at_any_level) {
  CaptureStderr();
  apsis::log::warning("before");
  const apsis::warning_record outer;
  apsis::log::set_level(apsis::log::level::quiet);
  apsis::log::warning("first");
  {
    const apsis::warning_record inner;
    apsis::log::warning("second");
    apsis::log::info("no warning");
    EXPECT_THAT(inner.messages(), testing::ElementsAre("second"));
  }
  apsis::log::warning("third");
  EXPECT_EQ(GetCapturedStderr(), "warning: before\n");
  EXPECT_THAT(outer.messages(), testing::ElementsAre("first", "second", "third"));
}

TEST_F(log_of_messages, repeated_warnings_are_hidden_where_they_differ_in_numbers_alone) {
  CaptureStderr();
  {
    const apsis::warnings_once once;
    const apsis::warning_record record;
    apsis::log::warning("method 'md-imex-3-2' is unstable in steps of 0.1 (1.5e-3); stop");
    apsis::log::warning("method 'md-imex-3-2' is unstable in steps of 1e-05 (-2); stop");
    apsis::log::warning("method 'md-imex-6-3' is unstable in steps of 0.1 (1.5e-3); stop");
    EXPECT_EQ(record.messages().size(), 2U);
  }
  apsis::log::warning("method 'md-imex-6-3' is unstable in steps of 0.1 (1.5e-3); stop");
  EXPECT_EQ(GetCapturedStderr(),
            "warning: method 'md-imex-3-2' is unstable in steps of 0.1 (1.5e-3); stop\n"
            "warning: method 'md-imex-6-3' is unstable in steps of 0.1 (1.5e-3); stop\n"
            "warning: method 'md-imex-6-3' is unstable in steps of 0.1 (1.5e-3); stop\n");
}

TEST_F(log_of_messages, lines_of_several_threads_do_not_interleave) {
  CaptureStderr();
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([k] {
      for (int n = 0; n < 500; ++n) apsis::log::warning(std::string(50, static_cast<char>('a' + k)));
    });
  for (auto& thread : threads) thread.join();
  const std::string text = GetCapturedStderr();
  std::size_t lines = 0;
  for (std::size_t begin = 0; begin < text.size(); ++lines) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    ASSERT_EQ(line, "warning: " + std::string(50, line.back()));
    begin = end + 1;
  }
  EXPECT_EQ(lines, 2000u);
}

}  // namespace

}  // namespace log_test
