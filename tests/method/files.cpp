// Invalid method files and the positions in their error messages.
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

struct bad_file {
  std::string name, old, replacement;
  std::string place;   ///< "line:column"
  std::string reason;  ///< part of the message
};

std::ostream& operator<<(std::ostream& out, const bad_file& file) {
  return out << file.name;
}

std::optional<std::string> complaint(const std::string& text) {
  try {
    parse_method(text, "m.toml");
  } catch (const input_error& refused) {
    return refused.what();
  }
  return std::nullopt;
}

class bad_files : public ::testing::TestWithParam<bad_file> {};

TEST_P(bad_files, are_rejected_with_position_and_reason) {
  const auto& [name, old, replacement, place, reason] = GetParam();
  std::string text = good;
  const auto at = text.find(old);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, old.size(), replacement);
  const auto message = complaint(text);
  ASSERT_TRUE(message) << "accepted:\n" << text;
  EXPECT_THAT(*message, ::testing::StartsWith("m.toml:" + place + ": "));
  EXPECT_THAT(*message, ::testing::HasSubstr(reason));
}

std::string long_text(std::size_t n) {
  return std::string(n, '7');
}

/// Returns "a.a.a" with n parts.
std::string dotted(int n) {
  std::string key = "a";
  for (int i = 1; i < n; ++i) key += ".a";
  return key;
}

std::string many_rows(int n) {
  std::string rows = "P = [";
  for (int i = 0; i < n; ++i) rows += "[],";
  return rows + "]";
}

std::string name_of(const ::testing::TestParamInfo<bad_file>& file) {
  return file.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    method_files, bad_files,
    ::testing::Values(
        bad_file{"order_99", "order = 2", "order = 99", "7:9", "out of range"},
        bad_file{"d_too_short", "d = [\"1/2\", \"0\", \"1/2\"]", "d = [\"1/2\", \"0\"]", "13:5",
                 "has 2 entries"},
        bad_file{"claims_missing", "[claims]\norder = 2\n", "", "1:1", "missing table [claims]"},
        bad_file{"no_form", good.substr(good.find("[shu_osher]")), "", "1:1", "missing or given twice"},
        bad_file{"unknown_key", "title =", "titel =", "2:1", "did you mean 'title'"},
        bad_file{"unknown_claim", "order = 2", "order = 2\nspp_coefficient = \"1\"", "8:1",
                 "did you mean 'ssp_coefficient'"},
        bad_file{"unknown_matrix", "ddot =", "dddot =", "14:1", "did you mean 'ddot'"},
        bad_file{"unknown_table", "[claims]", "[claim]", "6:2", "did you mean 'claims'"},
        bad_file{"missing_name", "name = \"x\"\n", "", "1:1", "missing key 'name'"},
        bad_file{"missing_weights", "d = [\"1/2\", \"0\", \"1/2\"]\n", "", "9:1", "missing key 'd'"},
        bad_file{"order_is_text", "order = 2", "order = \"2\"", "7:9", "integer"},
        bad_file{"order_is_real", "order = 2", "order = 2.0", "7:9", "integer"},
        bad_file{"order_is_zero", "order = 2", "order = 0", "7:9", "out of range"},
        bad_file{"order_is_huge", "order = 2", "order = 9223372036854775807", "7:9", "out of range"},
        bad_file{"unknown_kind", "\"imex\"", "\"imax\"", "4:8", "did you mean 'imex'"},
        bad_file{"kind_is_number", "\"imex\"", "3", "4:8", "string in quotes"},
        bad_file{"coefficient_is_number", "r = \"1\"", "r = 1.0", "10:5", "in quotes"},
        bad_file{"coefficient_is_nan", "r = \"1\"", "r = \"nan\"", "10:5", "not a coefficient"},
        bad_file{"coefficient_is_infinite", "r = \"1\"", "r = \"inf\"", "10:5", "not a coefficient"},
        bad_file{"coefficient_has_spaces", "r = \"1\"", "r = \" 1\"", "10:5", "not a coefficient"},
        bad_file{"coefficient_has_comma", "\"1/2\", \"0\", \"1/2\"", "\"0,5\", \"0\", \"1/2\"", "13:6",
                 "not a coefficient"},
        bad_file{"coefficient_is_empty", "r = \"1\"", "r = \"\"", "10:5", "not a coefficient"},
        bad_file{"division_by_zero", "r = \"1\"", "r = \"1/0\"", "10:5", "not a coefficient"},
        bad_file{"two_slashes", "r = \"1\"", "r = \"1/2/3\"", "10:5", "not a coefficient"},
        bad_file{"huge_exponent", "r = \"1\"", "r = \"1e99999\"", "10:5", "not a coefficient"},
        bad_file{"too_long_number", "r = \"1\"", "r = \"" + long_text(100000) + "\"", "10:5",
                 "not a coefficient"},
        bad_file{"too_long_name", "name = \"x\"", "name = \"" + long_text(100000) + "\"", "1:8", "too long"},
        bad_file{"empty_name", "name = \"x\"", "name = \"\"", "1:8", "the name is empty"},
        bad_file{"name_leaves_the_folder", "name = \"x\"", "name = \"../escape\"", "1:8", "cannot be used"},
        bad_file{"name_is_a_path", "name = \"x\"", "name = \"a/b\"", "1:8", "cannot be used"},
        bad_file{"name_is_hidden", "name = \"x\"", "name = \".x\"", "1:8", "cannot be used"},
        bad_file{"name_is_an_option", "name = \"x\"", "name = \"-x\"", "1:8", "cannot be used"},
        bad_file{"name_has_two_lines", "name = \"x\"", "name = \"x\\ny\"", "1:8", "cannot be used"},
        bad_file{"name_is_of_61_letters", "name = \"x\"", "name = \"" + std::string(61, 'x') + "\"", "1:8",
                 "too long"},
        bad_file{"name_is_a_file", "name = \"x\"", "name = \"x.toml\"", "1:8", "ends in '.toml'"},
        bad_file{"key_of_fifty_thousand_parts", "title =", dotted(50000) + " = 1\ntitle =", "2:16",
                 "the key has more than 8 parts"},
        bad_file{"table_of_fifty_thousand_parts", "[claims]", "[" + dotted(50000) + "]\n[claims]", "6:17",
                 "the key has more than 8 parts"},
        bad_file{"key_with_spaces_and_quotes", "title =", "a . \"b.c\" .c.d.e.f.g.h.i = 1\ntitle =", "2:23",
                 "the key has more than 8 parts"},
        bad_file{"inline_table_of_many_parts", "title =", "x = {" + dotted(9) + " = 1}\ntitle =", "2:21",
                 "the key has more than 8 parts"},
        bad_file{"lists_of_lists_of_lists", "title =", "x = " + std::string(9, '[') + "\ntitle =", "2:13",
                 "nested deeper than 8"},
        bad_file{"origin_is_a_list", "citation = \"c\"", "citation = \"c\"\norigin = [\"a\"]", "4:10",
                 "string in quotes"},
        bad_file{"too_long_origin", "citation = \"c\"",
                 "citation = \"c\"\norigin = \"" + long_text(501) + "\"", "4:10", "too long"},
        bad_file{"purpose_is_a_number", "citation = \"c\"", "citation = \"c\"\npurpose = 3", "4:11",
                 "string in quotes"},
        bad_file{"misspelled_purpose", "citation = \"c\"", "citation = \"c\"\npurpos = \"x\"", "4:1",
                 "did you mean 'purpose'"},
        bad_file{"negative_r", "r = \"1\"", "r = \"-1\"", "10:5", "not positive"},
        bad_file{"zero_r", "r = \"1\"", "r = \"0/7\"", "10:5", "not positive"},
        bad_file{"above_the_diagonal", "W = [[], [\"1\"], ", "W = [[], [\"1\", \"0\", \"1/3\"], ", "12:21",
                 "above the triangle"},
        bad_file{"row_too_short", "[\"0\", \"1/2\"]]", "[\"1/2\"]]", "12:17", "has 1 entries"},
        bad_file{"row_is_no_list", "P = [[], [\"0\"]", "P = [[], \"0\"", "11:10", "list"},
        bad_file{"row_missing", "W = [[], [\"1\"], [\"0\", \"1/2\"]]", "W = [[], [\"1\"]]", "12:5",
                 "has 2 rows"},
        bad_file{"d_too_long", "\"-1/2\", \"0\"]", "\"-1/2\", \"0\", \"0\"]", "14:8", "3 stages"},
        bad_file{"no_stages", "P = [[], [\"0\"], [\"1/2\", \"0\"]]", "P = []", "11:5", "1 to 64"},
        bad_file{"too_many_stages", "P = [[], [\"0\"], [\"1/2\", \"0\"]]", many_rows(65), "11:5", "1 to 64"},
        bad_file{"not_toml", "r = \"1\"", "r = ", "10:5", "not TOML"},
        bad_file{"duplicate_key", "r = \"1\"", "r = \"1\"\nr = \"1\"", "11:5", "not TOML"},
        bad_file{"claims_is_a_value", "\n[claims]\norder = 2\n", "claims = 3\n", "5:10", "not a table"},
        bad_file{"both_forms", "ddot = [\"0\", \"-1/2\", \"0\"]",
                 "ddot = [\"0\", \"-1/2\", \"0\"]\n[butcher]\nA = [[]]", "1:1", "missing or given twice"},
        bad_file{"transport_in_implicit_method", "\"imex\"", "\"implicit\"", "12:1", "unknown key 'W'"},
        bad_file{"collision_in_explicit_method", "\"imex\"", "\"explicit\"", "13:1", "unknown key 'd'"}),
    name_of);

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
      // Any other exception fails the test.
    }
  }
}

TEST(method_files, of_ten_megabytes_are_rejected_quickly) {
  std::mt19937 draw(11);
  std::string garbage(10'000'000, ' ');
  for (char& c : garbage) c = static_cast<char>(draw() % 256);
  std::string brackets = "x = " + std::string(900'000, '[');
  const std::clock_t start = std::clock();  // CPU time, which excludes other programs
  EXPECT_TRUE(complaint(garbage));
  EXPECT_TRUE(complaint(std::string(10'000'000, '\n')));
  EXPECT_TRUE(complaint(brackets));
  EXPECT_TRUE(complaint(std::string(1'000'000, '\0')));
  // A few milliseconds; more under a sanitizer.
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
  // Beyond the limit there is a comment or another key; the message gives the position of the limit.
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
  // Two backward Euler steps of half the length: order 1.
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

  // Same length as the first text and possibly the same time stamp: neither size nor modification time may
  // identify the contents.
  write_file("edited.toml", text("1", "2/2"));
  EXPECT_THAT(find_certificate(path).failures, ::testing::Contains(::testing::HasSubstr("tree G is 1.5")));
  write_file("edited.toml", text("1", "1/2"));
  EXPECT_EQ(&find_method(path), &first);

  EXPECT_EQ(first.exact.D(1, 1), "1/2") << "references returned before an edit stay valid";
  EXPECT_EQ(certified.error_constant.convert_to<double>(), constant);

  std::filesystem::remove(path);
  EXPECT_THROW(find_method(path), input_error) << "a removed file is not a method";
}

TEST(method_files, that_do_not_exist_or_are_folders_are_rejected) {
  const auto refused_by = [](const std::string& path) -> std::pair<exit_code, std::string> {
    try {
      load_method_file(path);
    } catch (const error& refused) {
      return {refused.code(), refused.what()};
    }
    return {exit_code::success, "accepted"};
  };
  const auto is = [](exit_code code, const char* message) {
    return ::testing::Pair(code, ::testing::StartsWith(message));
  };
  EXPECT_THAT(refused_by("/nowhere/at/all.toml"),
              is(exit_code::input, "cannot read the method file '/nowhere/at/all.toml' (it does not exist)"));
  EXPECT_THAT(refused_by("/"), is(exit_code::output, "cannot read '/' (it is a folder or not readable)"));
  EXPECT_THAT(refused_by(""), is(exit_code::input, "cannot read the method file '' (it does not exist)"));
}

TEST(method_files, unknown_names_get_the_closest_name_as_suggestion) {
  try {
    find_method("md-imex-3-3");
    FAIL();
  } catch (const input_error& refused) {
    EXPECT_THAT(refused.what(), ::testing::HasSubstr("did you mean 'md-imex-"));
  }
  EXPECT_THROW(find_method(std::string(1'000'000, 'x')), input_error);
}

}  // namespace
}  // namespace apsis::test::files_test
