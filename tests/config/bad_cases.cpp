// Invalid cases: every message has its place, its reason and a suggestion.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bad_cases_test {

using testing::HasSubstr;
using testing::StartsWith;

namespace {

// Line numbers of the table below refer to this text.
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

struct bad_case {
  std::string name;
  std::string from, to;  ///< the change to the valid case
  std::string place;     ///< "line:column", or "line:" where the column is that of the TOML parser
  std::string says;
};

void PrintTo(const bad_case& c, std::ostream* out) {
  *out << c.name;
}

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    apsis::parse_case(text, "c.toml", overrides);
  } catch (const apsis::error& e) {
    EXPECT_EQ(e.code(), apsis::exit_code::input);
    return e.what();
  }
  return "accepted";
}

class bad_cases : public testing::TestWithParam<bad_case> {};

TEST_P(bad_cases, is_refused_at_its_place) {
  std::string text = good;
  const auto at = text.find(GetParam().from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, GetParam().from.size(), GetParam().to);
  const std::string message = error_of(text);
  EXPECT_THAT(message,
              StartsWith("c.toml:" + GetParam().place + (GetParam().place.back() == ':' ? "" : ": ")));
  EXPECT_THAT(message, HasSubstr(GetParam().says));
  // problem (reason); suggestion: text follows the last parenthesis.
  EXPECT_LT(message.rfind(')') + 2, message.size()) << message;
  EXPECT_THAT(message, HasSubstr("); "));
}

const std::vector<bad_case> all = {
    {"unknown_key", "cells = 40", "cels = 40", "6:1", "did you mean 'space.cells'?"},
    {"unknown_key_at_top", "[model]", "tilte = \"x\"\n[model]", "1:1", "did you mean 'title'?"},
    {"unknown_table", "[velocity]", "[velocty]", "9:1", "did you mean 'velocity'?"},
    {"key_of_no_table", "[space]", "[space]\nlots = 3", "6:1", "unknown key 'space.lots'"},
    {"value_instead_of_table", "[model]", "output = 3\n[model]", "17:", "not valid TOML"},
    {"missing_cells", "cells = 40\n", "", "5:1", "key 'space.cells' is missing"},
    {"missing_velocity_max", "max = 15.0\n", "", "9:1", "key 'velocity.max' is missing"},
    {"missing_model", "name = \"bgk\"\n", "", "1:1", "key 'model.name' is missing"},
    {"missing_end", "end = 0.5\n", "", "12:1", "key 'time.end' is missing"},
    {"missing_step", "cfl = 0.04\n", "", "12:1", "no step size is given"},
    {"text_for_integer", "cells = 40", "cells = \"40\"", "6:1", "an integer is needed"},
    {"float_for_integer", "cells = 40", "cells = 40.5", "6:1",
     "(an integer is needed); write for example 41"},
    {"text_for_number", "max = 15.0", "max = \"15\"", "10:1", "a number is needed"},
    {"number_for_text", "limiter = \"positivity\"", "limiter = 1", "8:1", "a text is needed"},
    {"boolean", "limiter = \"positivity\"", "limiter = true", "8:1", "is a boolean"},
    {"date", "end = 0.5", "end = 2020-01-01", "14:1", "is a date"},
    {"negative_cells", "cells = 40", "cells = -40", "6:1", "at least 1"},
    {"zero_cells", "cells = 40", "cells = 0", "6:1", "at least 1"},
    {"huge_cells", "cells = 40", "cells = 9223372036854775807", "6:1", "at most 10000000"},
    {"integer_overflow", "cells = 40", "cells = 9223372036854775808", "6:", "not valid TOML"},
    {"one_velocity", "points = 150", "points = 1", "11:1", "at least 4"},
    {"table_twice", "points = 150", "points = 150\n[space]", "12:", "not valid TOML"},
    {"nan_end", "end = 0.5", "end = nan", "14:1", "must be finite"},
    {"inf_end", "end = 0.5", "end = inf", "14:1", "must be finite"},
    {"negative_end", "end = 0.5", "end = -0.5", "14:1", "at least 0"},
    {"zero_cfl", "cfl = 0.04", "cfl = 0.0", "15:1", "above 0"},
    {"minus_inf_cfl", "cfl = 0.04", "cfl = -inf", "15:1", "must be finite"},
    {"two_step_rules", "cfl = 0.04", "cfl = 0.04\ndt = 0.001", "15:1", "'time.cfl' conflicts with 'time.dt'"},
    {"dt_beyond_end", "cfl = 0.04", "dt = 0.6", "15:1", "longer than time.end"},
    {"unknown_model", "name = \"bgk\"", "name = \"bkg\"", "2:1", "did you mean 'bgk'?"},
    {"member_beyond_its_family", "md-imex-3-2", "md-imex-chain-65-2", "13:1",
     "md-imex-chain-S-2 has S from 3 to 64"},
    {"no_member_of_a_family", "md-imex-3-2", "md-imex-chain-x-2", "13:1",
     "md-imex-chain-S-2 has S from 3 to 64"},
    {"unknown_method", "md-imex-3-2", "md-imex-3-3", "13:1", "did you mean 'md-imex-3-2'?"},
    {"unknown_initial", "mixed-v", "mixed-w", "4:1", "did you mean 'mixed-"},
    {"unknown_limiter", "positivity", "positivty", "8:1", "did you mean 'positivity'?"},
    {"unknown_scheme", "cells = 40", "cells = 40\nreconstruction = \"weno\"", "7:1", "weno5-z"},
    {"negative_epsilon", "epsilon = 1e-2", "epsilon = -1e-2", "3:1", "at least 0"},
    {"epsilon_negative_somewhere", "epsilon = 1e-2", "epsilon = \"1 - x\"", "3:12",
     "it must be finite and not negative"},
    {"epsilon_syntax", "epsilon = 1e-2", "epsilon = \"1 + + *x\"", "3:", "cannot be used"},
    {"epsilon_unknown_name", "epsilon = 1e-2", "epsilon = \"1 + y\"", "3:16", "unknown name 'y'"},
    {"epsilon_list", "epsilon = 1e-2", "epsilon = [1, 2]", "3:1",
     "a number or a formula in x, y, z is needed"},
    {"domain_reversed", "[0.0, 2.0]", "[2.0, 0.0]", "7:1", "not lower < upper"},
    {"domain_of_three", "[0.0, 2.0]", "[0.0, 1.0, 2.0]", "7:1",
     "a pair of numbers or a list of up to 3 pairs is needed"},
    {"domain_of_texts", "[0.0, 2.0]", "[\"a\", \"b\"]", "7:1",
     "a pair of numbers or a list of up to 3 pairs is needed"},
    {"domain_nan", "[0.0, 2.0]", "[nan, 2.0]", "7:1", "must be finite"},
    {"domain_too_far", "[0.0, 2.0]", "[1e20, 1.0000000000000002e20]", "7:1", "cannot be told apart"},
    {"too_many_snapshots", "every = 0.1", "every = 1e-9", "17:1", "snapshots"},
    {"unknown_field", "every = 0.1", "fields = [\"rho\", \"pressure\"]", "17:1", "unknown field 'pressure'"},
    {"fields_of_numbers", "every = 0.1", "fields = [1]", "17:1", "a list of texts is needed"},
    {"unknown_parameter", "epsilon = 1e-2", "epsilon = 1e-2\ngamma = 1.4", "4:1",
     "unknown key 'model.gamma'"},
    {"parameter_out_of_range", "epsilon = 1e-2", "epsilon = 1e-2\nvelocity_dimensions = 7", "4:1",
     "from 0 to 3"},
    {"duplicate_key", "cells = 40", "cells = 40\ncells = 41", "7:", "not valid TOML"},
    {"no_value", "cells = 40", "cells = ", "6:", "not valid TOML"},
    {"open_string", "\"bgk\"", "\"bgk", "2:", "not valid TOML"},
    {"control_character", "\"bgk\"", "\"b\x01k\"", "2:", "not valid TOML"},
    {"not_utf8", "\"bgk\"", "\"b\xffk\"", "2:", "not valid TOML"},
    {"keys_of_another_model", "name = \"bgk\"", "name = \"decay\"", "6:1", "model 'decay' has no space"},
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(table, bad_cases, testing::ValuesIn(all),
                         [](const auto& c) { return c.param.name; });

TEST(bad_case, boundaries_of_ends_exist_and_are_periodic_in_pairs) {
  EXPECT_THAT(
      error_of(good + "[boundary.left]\nkind = \"outfow\"\n"),
      StartsWith("c.toml:19:1: 'boundary.left.kind' is the text 'outfow' (there is no such name); did "
                 "you mean 'outflow'?"));
  EXPECT_THAT(
      error_of(good + "[boundary.left]\nkind = \"outflow\"\n"),
      StartsWith("c.toml:19:1: 'boundary.left.kind' is the text 'outflow' (only one of the two ends is "
                 "periodic); write "));
  EXPECT_THAT(error_of(good + "[boundary.top]\nkind = \"outflow\"\n"),
              StartsWith("c.toml:19:1: key 'boundary.top.kind' is not used (the case has 1 space dimension); "
                         "remove it"));
  EXPECT_THAT(error_of(good + "[boundary.lift]\nkind = \"outflow\"\n"),
              StartsWith("c.toml:19:1: unknown key 'boundary.lift.kind' (a face is a table [boundary.left], "
                         "[boundary.right], …); did you mean 'left'?"));
  EXPECT_THAT(error_of(good + "[boundary]\nleft = \"outflow\"\n"),
              StartsWith("c.toml:19:1: unknown key 'boundary.left' (a face is a table [boundary.left], "
                         "[boundary.right], …); write [boundary.left]"));
}

TEST(bad_case, the_text_that_the_table_changes_is_valid) {
  EXPECT_EQ(error_of(good), "accepted");
}

TEST(bad_case, too_many_unknowns_name_both_factors) {
  const std::string message = error_of(good, {"space.cells=1000000", "velocity.points=100000"});
  EXPECT_THAT(message, HasSubstr("1e+11 unknowns"));
}

TEST(bad_case, keys_that_the_model_does_not_use_are_errors) {
  const std::string ode = "[model]\nname = \"decay\"\n[time]\nmethod = \"imdrk-1-2\"\nend = 1.0\n";
  EXPECT_EQ(error_of(ode + "dt = 0.1\n"), "accepted");
  EXPECT_THAT(error_of(ode + "cfl = 0.1\n"),
              StartsWith("c.toml:6:1: key 'time.cfl' is not used (model 'decay' has no space)"));
  EXPECT_THAT(error_of(ode + "dt = 0.1\n[velocity]\nmax = 1.0\n"),
              StartsWith("c.toml:8:1: key 'velocity.max'"));
}

TEST(bad_case, a_mesh_has_the_dimensions_of_its_model) {
  const auto with = [](const std::string& key, const std::string& value) {
    return error_of(
        "[model]\nname = \"broadwell\"\n[space]\ncells = 20\ndomain = [0.0, 1.0]\n[time]\nmethod = "
        "\"md-imex-3-2\"\nend = 1.0\ncfl = 0.5\n",
        {key + "=" + value});
  };
  // A list of one entry is accepted in one dimension.
  EXPECT_EQ(with("space.cells", "[30]"), "accepted");
  EXPECT_EQ(with("space.domain", "[[0.0, 2.0]]"), "accepted");
  EXPECT_THAT(with("space.cells", "[30, 20]"),
              HasSubstr("'space.cells' has 2 numbers (model 'broadwell' has 1 space dimension); give 1"));
  EXPECT_THAT(with("space.domain", "[[0.0, 2.0], [0.0, 1.0]]"),
              HasSubstr("'space.domain' has 2 intervals (model 'broadwell' has 1 space dimension); give 1"));
  EXPECT_THAT(with("space.cells", "[]"), HasSubstr("an integer or a list of up to 3 integers is needed"));
  EXPECT_THAT(with("space.cells", "[1, 2, 3, 4]"), HasSubstr("a list of up to 3 integers is needed"));
  EXPECT_THAT(with("space.cells", "[30, 0]"), HasSubstr("it must be at least 1"));
  EXPECT_THAT(with("space.cells", "[30, \"a\"]"), HasSubstr("an integer is needed"));
  EXPECT_THAT(with("space.domain", "[[0.0, 1.0], [0.0]]"), HasSubstr("a list of up to 3 pairs is needed"));
  EXPECT_THAT(with("model.epsilon", "1 + y"), HasSubstr("unknown name 'y'"));
}

TEST(bad_case, a_formula_in_x_needs_space) {
  const std::string ode =
      "[model]\nname = \"ode\"\nepsilon = \"1 + x\"\n[time]\nmethod = \"md-imex-3-2\"\nend = 1.0\ndt = 0.1\n";
  EXPECT_THAT(error_of(ode), HasSubstr("depends on x (model 'ode' has no space)"));
}

TEST(bad_case, a_text_value_of_a_model_is_a_known_name_or_a_formula) {
  const auto with = [](const std::string& flux) {
    return error_of("[model]\nname = \"relaxation\"\nflux = " + flux +
                    "\n[space]\ncells = 20\n[time]\nmethod = \"md-imex-3-2\"\nend = 1.0\ncfl = 0.5\n");
  };
  EXPECT_EQ(with("\"burgers\""), "accepted");
  EXPECT_EQ(with("\"-u^2/4\""), "accepted");
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"\"burger\"",
       "3:1: 'model.flux' is the text 'burger' (it is neither a name nor a formula in u); did you mean "
       "'burgers'?"},
      {"\"buckley-levrett\"", "did you mean 'buckley-leverett'?"},
      {"\"\"", "expression is empty"},
      {"\" \"", "expression is empty"},
      {"\"sin(x)/2\"", "3:13: expression 'sin(x)/2' cannot be used (unknown name 'x'"},
      {"\"u +\"", "ends too early"},
      {"\"u = 2\"", "an assignment"},
      {"\"u, 2\"", "a comma outside a function"},
      {"\"u\\u0000\"", "the byte 0x00"},
      {"3", "3:1: 'model.flux' is the integer 3 (a text is needed); put it in quotes"},
      {"[\"burgers\"]", "a text is needed"},
      {"true", "a text is needed"},
      {"\"" + std::string(1001, '1') + "\"", "1001 characters"},
  };
  for (const auto& [flux, says] : wrong) {
    EXPECT_THAT(with(flux), StartsWith("c.toml:3:")) << flux;
    EXPECT_THAT(with(flux), HasSubstr(says)) << flux;
  }
  EXPECT_THAT(error_of(good, {"model.flux=burgers"}), HasSubstr("no such key for model 'bgk'"));
}

struct bad_override {
  std::string text, says;
};

TEST(bad_case, messages_quote_the_override) {
  const std::vector<bad_override> overrides = {
      {"space.cells=ten", "'ten' is not a value of TOML"},
      {"space.cells=-1", "at least 1"},
      {"space.cels=10", "did you mean 'space.cells'?"},
      {"cells", "not of the form key=value"},
      {"=3", "not of the form key=value"},
      {"", "not of the form key=value"},
      {"time.method=", "there is no such name"},
      {"time.method=md-imex-3-3", "did you mean 'md-imex-3-2'?"},
      {"time.method=\"md", "not a value of TOML"},
      {"time.end=nan", "must be finite"},
      {"time.end=1\ntime.dt=3", "more than one line"},
      {"title=\xff", "not a value of TOML"},
      {"model.epsilon=1+z", "unknown name 'z'"},
      {"model.epsilon=-1", "must be finite and not negative"},
      {"space={cells=3}", "it is a table"},
      {"time.end=1/0", "must be finite"},
      {"time.end=1/", "not a value of TOML"},
      {"time.end=1/2/3", "not a value of TOML"},
      {"space.cells=81/2", "'space.cells' is the fraction 81/2 (an integer is needed); write for example 41"},
      {"space.cells=1.5", "'space.cells' is the number 1.5 (an integer is needed); write for example 2"},
      {"space.cells=0.2", "(an integer is needed); write for example 1"},
      {"space.cells=1e300", "at most 10000000"},
      {"space.cells=nan", "must be finite"},
      {"space.cells=-inf", "must be finite"},
      {"space.cells=\"40\"", "is the text '40' (an integer is needed)"},
      {"space.cells=[[40]]", "is a list of 1 (an integer is needed)"},
      {"space.cells=true", "is a boolean (an integer is needed)"},
      {"space.cells=", "the value is empty (nothing stands behind '='); write for example 100"},
      {"space.cells=40 # fine", "the value is followed by '#'"},
      {"velocity.points=1e2.5", "not a value of TOML"},
      {"space.domain=0,2", "write for example [0.0, 2.0]"},
      {"output.fields=[rho]", "write for example [\"rho\", \"u\"]"},
      {" =3", "not of the form key=value"},
      {"model.epsilon=foo + x", "unknown name 'foo' at character 1); valid: x"},
      {std::string("title=") + std::string(5000, 'a'), "the value has 5000 bytes (at most 4096 are read)"}};
  for (const auto& given : overrides) {
    const std::string message = error_of(good, {given.text});
    EXPECT_THAT(message, StartsWith("override '")) << given.text;
    EXPECT_THAT(message, HasSubstr(given.says)) << given.text;
  }
  EXPECT_THAT(error_of(good, {"time.dt=0.1", "time.cfl=0.1"}), HasSubstr("conflicts"));
}

TEST(bad_case, a_file_cut_at_any_byte_is_refused_or_read) {
  int read = 0;
  for (std::size_t n = 0; n <= good.size(); ++n) {
    const std::string message = error_of(good.substr(0, n));
    if (message == "accepted")
      ++read;
    else
      EXPECT_THAT(message, StartsWith("c.toml:")) << n;
  }
  // Only cuts after the last required key leave a valid case, including those within the numbers "0.04" and
  // "0.1".
  EXPECT_GE(read, 2);
  EXPECT_LE(read, 25);
}

TEST(bad_case, a_file_with_any_byte_changed_is_refused_or_read) {
  for (std::size_t n = 0; n < good.size(); ++n) {
    for (const char c : {'\0', '"', '[', '=', '\xff', '\n', '9'}) {
      std::string text = good;
      text[n] = c;
      const std::string message = error_of(text);
      EXPECT_TRUE(message == "accepted" || message.rfind("c.toml:", 0) == 0) << message;
    }
  }
}

TEST(bad_case, large_garbage_is_refused_before_it_is_parsed) {
  EXPECT_THAT(error_of(std::string(10'000'000, 'x')),
              StartsWith("c.toml:1:1000001: the file is larger than 1 MB"));
  EXPECT_THAT(error_of("\n\n" + std::string(900'000, '[')),
              StartsWith("c.toml:3:4097: the line is longer than 4096"));
  std::string deep;
  for (int k = 0; k < 2000; ++k) deep += "a.";
  // A chain of two thousand dotted tables fits a line and must neither overflow the stack nor pass.
  EXPECT_THAT(error_of("[" + deep + "b]\n" + deep + "c = 1\n"), StartsWith("c.toml:"));
}

TEST(bad_case, a_misspelt_key_on_the_command_line_is_reported_for_every_value) {
  for (const std::string value : {"ars-222", "1", "[1, ", "x y"})
    EXPECT_THAT(error_of(good, {"time.methd=" + value}), HasSubstr("did you mean 'time.method'?")) << value;
}

TEST(bad_case, a_number_of_dimensions_is_an_integer) {
  EXPECT_EQ(error_of(good, {"model.velocity_dimensions=2"}), "accepted");
  EXPECT_THAT(error_of(good, {"model.velocity_dimensions=1.7"}), HasSubstr("it must be an integer"));
}

TEST(bad_case, integers_may_be_written_in_any_notation) {
  for (const std::string value : {"1e1", "40.0", "80/2", "+40", "4_0", " 40 ", "4e1"})
    for (const std::string key :
         {"space.cells", "velocity.points", "output.stride", "output.checkpoint_every"})
      EXPECT_EQ(error_of(good, {key + "=" + value}), "accepted") << key << value;
  EXPECT_EQ(apsis::parse_case(good, "c.toml", {"space.cells=1e1"}).space.cells, std::vector<int>{10});
  EXPECT_EQ(apsis::parse_case(good, "c.toml", {" space.cells = 1.2e2 "}).space.cells, std::vector<int>{120});
}

TEST(bad_case, a_step_rule_written_with_spaces_replaces_that_of_the_file) {
  EXPECT_EQ(error_of(good, {"time.dt = 0.1"}), "accepted");
}

}  // namespace bad_cases_test
