// Invalid method files, and the positions in their error messages.
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/export.hpp>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace apsis::test::files_test {
namespace {

// Lines: 1 name, 2 title, 3 citation, 4 kind, 6 [claims], 7 order, 9 [shu_osher], 10 r, 11 P, 12 W,
// 13 d, 14 ddot.
const std::string good = R"(name = "x"
title = "t"
citation = "c"
kind = "imex"

[claims]
order = 2

[shu_osher]
r = "1"
P = [[], ["0"], ["1/2", "0"]]
W = [[], ["1"], ["0", "1/2"]]
d = ["1/2", "0", "1/2"]
ddot = ["0", "-1/2", "0"]
)";

std::optional<std::string> complaint(const std::string& text) {
  try {
    parse_method(text, "m.toml");
  } catch (const input_error& refused) {
    return refused.what();
  }
  return std::nullopt;
}

TEST(method_files, may_state_origin_and_purpose) {
  EXPECT_EQ(parse_method(good, "m.toml").origin, "");
  EXPECT_EQ(parse_method(good, "m.toml").purpose, "");
  const method m = parse_method("origin = \"by hand\"\npurpose = \"a test\"\n" + good, "m.toml");
  EXPECT_EQ(m.origin, "by hand");
  EXPECT_EQ(m.purpose, "a test");
}

TEST(method_files, truncated_anywhere_are_rejected) {
  for (std::size_t n = 0; n + 2 < good.size(); ++n) EXPECT_TRUE(complaint(good.substr(0, n))) << n;
}

TEST(method_files, with_any_byte_changed_do_not_crash) {
  std::mt19937 draw(7);
  for (int k = 0; k < 3000; ++k) {
    std::string text = good;
    for (int changes = 0; changes < 3; ++changes)
      text[draw() % text.size()] = static_cast<char>(draw() % 256);
    try {
      parse_method(text, "m.toml");
    } catch (const input_error&) {
      // Exceptions of other types fail the test.
    }
  }
}

TEST(method_files, of_ten_megabytes_are_rejected_quickly) {
  std::mt19937 draw(11);
  std::string garbage(10'000'000, ' ');
  for (char& c : garbage) c = static_cast<char>(draw() % 256);
  std::string brackets = "x = " + std::string(900'000, '[');
  const std::clock_t start = std::clock();  // CPU time excludes other programs
  EXPECT_TRUE(complaint(garbage));
  EXPECT_TRUE(complaint(std::string(10'000'000, '\n')));
  EXPECT_TRUE(complaint(brackets));
  EXPECT_TRUE(complaint(std::string(1'000'000, '\0')));
  // The refusal takes a few milliseconds, and more under a sanitizer.
  EXPECT_LT(std::clock() - start, 3 * CLOCKS_PER_SEC);
}

TEST(method_files, dots_in_strings_comments_and_numbers_do_not_split_keys) {
  const std::string dots(60, '.');
  std::string text =
      "# " + dots + "\norigin = \"\"\"a\n" + dots + "\\\"\"\"\"\npurpose = '" + dots + "'\n" + good;
  EXPECT_EQ(parse_method(text, "m.toml").purpose, dots);
  text.replace(text.find("[claims]"), 8, "[ claims ] # [[[[[[[[[[");
  EXPECT_EQ(parse_method(text, "m.toml").claims.order, 2);
}

/// Writes a file into the folder of the test and returns its path.
std::string write_file(const std::string& name, const std::string& text) {
  const std::string path = ::testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

TEST(method_files, larger_than_a_mebibyte_are_rejected_rather_than_truncated) {
  // Beyond the limit there is a comment or another key. The message has the position of the limit.
  const std::string comment = "# " + std::string(1 << 20, 'c') + "\n";
  const auto path = write_file("large.toml", good + comment);
  try {
    load_method_file(path);
    FAIL() << "accepted";
  } catch (const input_error& refused) {
    EXPECT_THAT(refused.what(), ::testing::StartsWith(path + ":15:"));
    EXPECT_THAT(refused.what(), ::testing::HasSubstr("larger than 1048576 bytes"));
  }
  EXPECT_THROW(find_method(path), input_error);
}

TEST(method_files, may_repeat_a_catalogue_method_but_not_reuse_its_name) {
  std::string text = to_toml(find_method("md-imex-3-2"));
  text.replace(text.find("1/2"), 3, "0.5");  // the same number
  EXPECT_EQ(load_method_file(write_file("same.toml", text)).name, "md-imex-3-2");
  const std::string other = to_toml(find_method("md-imex-5-2"));
  const auto named = [&other](const std::string& name) {
    std::string file = other;
    const std::string first = "name = \"md-imex-5-2\"";
    file.replace(file.find(first), first.size(), "name = \"" + name + "\"");
    return write_file("named.toml", file);
  };
  const auto refused_as = [](const std::string& path) -> std::string {
    try {
      load_method_file(path);
    } catch (const input_error& refused) {
      return refused.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refused_as(named("my-method")), "accepted");
  EXPECT_THAT(refused_as(named("md-imex-3-2")), ::testing::HasSubstr("is taken"));
  EXPECT_THAT(refused_as(named("md-imex-chain-5-2")), ::testing::HasSubstr("is taken"));
  EXPECT_THAT(refused_as(named("md-imex-chain-99-2")), ::testing::HasSubstr("is reserved"));
}

TEST(method_files, that_changed_are_certified_again) {
  // The method is two backward Euler steps of half the length, with order 1.
  const auto text = [](const std::string& order, const std::string& d) {
    return "name = \"mine-1\"\ntitle = \"t\"\nkind = \"implicit\"\ncitation = \"c\"\n[claims]\norder = " +
           order + "\n[shu_osher]\nP = [[], [\"1\"]]\nd = [\"1/2\", \"" + d + "\"]\nddot = [\"0\", \"0\"]\n";
  };
  const auto path = write_file("edited.toml", text("1", "1/2"));
  const method& first = find_method(path);
  const certificate& certified = find_certificate(path);
  EXPECT_EQ(&find_method(path), &first) << "an unchanged file is certified once";
  const double constant = certified.error_constant.convert_to<double>();
  EXPECT_TRUE(certified.claims_hold);

  write_file("edited.toml", text("2", "1/2"));
  try {
    find_method(path);
    FAIL() << "the certificate of the previous contents was returned";
  } catch (const claim_error& refused) {
    EXPECT_THAT(refused.what(), ::testing::HasSubstr("order 2: the condition of tree G[G]"));
  }
  EXPECT_FALSE(find_certificate(path).claims_hold);

  // The second text has the same length as the first and possibly the same time stamp. Neither size nor
  // modification time may identify the contents.
  write_file("edited.toml", text("1", "2/2"));
  EXPECT_THAT(find_certificate(path).failures, ::testing::Contains(::testing::HasSubstr("tree G is 1.5")));
  write_file("edited.toml", text("1", "1/2"));
  EXPECT_EQ(&find_method(path), &first);

  EXPECT_EQ(first.exact.D(1, 1), "1/2") << "references returned before an edit stay valid";
  EXPECT_EQ(certified.error_constant.convert_to<double>(), constant);

  std::filesystem::remove(path);
  EXPECT_THROW(find_method(path), input_error) << "a removed file is not a method";
}

}  // namespace
}  // namespace apsis::test::files_test
