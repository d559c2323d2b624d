// Damaged and oversized cases that the tables of bad_input/ cannot contain.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace damaged_cases_test {

using testing::StartsWith;

namespace {

const std::string good = R"([model]
name = "bgk"
epsilon = 1e-2
initial = "mixed-v"
[space]
cells = 40
domain = [0.0, 2.0]
limiter = "positivity"
[velocity]
max = 15.0
points = 150
[time]
method = "md-imex-3-2"
end = 0.5
cfl = 0.04
[output]
every = 0.1
)";

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    apsis::parse_case(text, "c.toml", overrides);
  } catch (const apsis::error& e) {
    EXPECT_EQ(e.code(), apsis::exit_code::input);
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST(damaged_case, a_file_cut_at_any_byte_is_refused_or_read) {
  int read = 0;
  for (std::size_t n = 0; n <= good.size(); ++n) {
    const std::string message = error_of(good.substr(0, n));
    if (message == "accepted")
      ++read;
    else
      EXPECT_THAT(message, StartsWith("c.toml:")) << n;
  }
  // A file that is cut after its last required key is a valid case, also within the numbers "0.04" and "0.1".
  EXPECT_GE(read, 2);
  EXPECT_LE(read, 25);
}

TEST(damaged_case, a_file_with_any_byte_changed_is_refused_or_read) {
  for (std::size_t n = 0; n < good.size(); ++n) {
    for (const char c : {'\0', '"', '[', '=', '\xff', '\n', '9'}) {
      std::string text = good;
      text[n] = c;
      const std::string message = error_of(text);
      EXPECT_TRUE(message == "accepted" || message.rfind("c.toml:", 0) == 0) << message;
    }
  }
}

TEST(damaged_case, bytes_that_are_not_text_and_values_that_are_too_long_are_refused_at_their_place) {
  std::string bytes = good;
  bytes.replace(bytes.find("bgk"), 3, "b\xffk");
  EXPECT_THAT(error_of(bytes), StartsWith("c.toml:2:"));
  EXPECT_THAT(error_of(good, {"title=\xff"}), StartsWith("override '"));
  const auto with = [](const std::string& change) { apsis::parse_case(good, "c.toml", {change}); };
  bad_input::expect_refused({
      {[&] { with("title=" + std::string(5000, 'a')); }, {"override 'title=aaa", "at most 4096 are read"}},
      {[&] { with("model.epsilon=" + std::string(1001, '1')); },
       {"override 'model.epsilon=111", "1001 characters"}},
  });
}

TEST(damaged_case, large_garbage_is_refused_before_it_is_parsed) {
  EXPECT_THAT(error_of(std::string(10'000'000, 'x')),
              StartsWith("c.toml:1:1000001: the file is larger than 1 MB"));
  EXPECT_THAT(error_of("\n\n" + std::string(900'000, '[')),
              StartsWith("c.toml:3:4097: the line is longer than 4096"));
  std::string deep;
  for (int k = 0; k < 2000; ++k) deep += "a.";
  // Two thousand dotted tables fit into one line. The parser must neither overflow the stack nor accept them.
  EXPECT_THAT(error_of("[" + deep + "b]\n" + deep + "c = 1\n"), StartsWith("c.toml:"));
}

TEST(cases_on_the_command_line, integers_may_be_written_in_any_notation) {
  for (const std::string value : {"1e1", "40.0", "80/2", "+40", "4_0", " 40 ", "4e1"})
    for (const std::string key :
         {"space.cells", "velocity.points", "output.stride", "output.checkpoint_every"})
      EXPECT_EQ(error_of(good, {key + "=" + value}), "accepted") << key << value;
  EXPECT_EQ(apsis::parse_case(good, "c.toml", {"space.cells=1e1"}).space.cells, std::vector<int>{10});
  EXPECT_EQ(apsis::parse_case(good, "c.toml", {" space.cells = 1.2e2 "}).space.cells, std::vector<int>{120});
}

}  // namespace damaged_cases_test
