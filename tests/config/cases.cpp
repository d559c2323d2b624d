#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace cases_test {

using namespace apsis;
using testing::HasSubstr;

TEST(cases, every_built_in_case_is_valid_and_described) {
  const auto names = case_names();
  ASSERT_GE(names.size(), 7U);
  for (const auto& name : names) {
    const case_config c = load_case(name);
    EXPECT_EQ(c.source, name);
    EXPECT_GT(c.title.size(), 10U) << name;
    EXPECT_NE(c.model.initial.empty(), c.prescribed.empty()) << name << ": data by name, or a table";
  }
}

TEST(cases, the_mixed_regime_case_is_the_one_of_the_paper) {
  const case_config c = load_case("paper/bgk-mixed");
  EXPECT_EQ(c.model.name, "bgk");
  EXPECT_EQ(c.model.initial, "mixed-v");
  EXPECT_EQ(c.space.cells, std::vector<int>{40});
  EXPECT_EQ(c.space.domain, (std::vector<apsis::interval>{{0.0, 2.0}}));
  EXPECT_EQ(c.space.discretization, "finite-volume");
  EXPECT_EQ(c.space.limiter, apsis::limiter_choice::positivity);
  EXPECT_EQ(c.velocity.points, 150);
  EXPECT_EQ(c.velocity.max, 15.0);
  EXPECT_EQ(c.time.end, 0.5);
  EXPECT_EQ(*c.time.cfl, 1.0 / 24.0);
  EXPECT_FALSE(c.time.dt || c.time.safety);
  // The reference takes steps of about 7e-6 on 80 cells.
  const case_config reference = load_case("paper/bgk-mixed-reference");
  EXPECT_EQ(reference.space.cells, std::vector<int>{80});
  EXPECT_NEAR(*reference.time.cfl * (2.0 / 80) / 15.0, 7e-6, 1e-7);
}

TEST(cases, overrides_replace_values_of_the_file) {
  const case_config c =
      load_case("paper/bgk-mixed", {"space.cells=80", "time.method=ssprk-2-2", "title=a \"b\" \\c",
                                    "space.domain=[-1, 1]", "output.fields=[\"rho\"]", "time.dt=1e-4"});
  EXPECT_EQ(c.space.cells, std::vector<int>{80});
  EXPECT_EQ(c.time.method, "ssprk-2-2");
  EXPECT_EQ(c.title, "a \"b\" \\c");
  EXPECT_EQ(c.space.domain, (std::vector<apsis::interval>{{-1.0, 1.0}}));
  EXPECT_EQ(c.output.fields, std::vector<std::string>{"rho"});
  // A step rule on the command line replaces the one in the file.
  EXPECT_EQ(*c.time.dt, 1e-4);
  EXPECT_FALSE(c.time.cfl);
}

TEST(cases, numbers_of_overrides_may_be_fractions) {
  EXPECT_EQ(*load_case("paper/ode", {"time.dt=1/48"}).time.dt, 1.0 / 48.0);
  EXPECT_EQ(load_case("paper/decay", {"model.u0=2.5e1/4"}).model.parameters.at("u0"), 6.25);
  // Texts stay texts. The expression parser reads the formulas.
  EXPECT_EQ(load_case("paper/ode", {"title=1/2"}).title, "1/2");
  EXPECT_EQ(load_case("paper/ode", {"model.epsilon=1/2"}).model.epsilon.text, "1/2");
}

TEST(cases, numbers_of_overrides_may_lack_digits_on_one_side_of_the_point) {
  const auto u0 = [](const std::string& value) {
    return load_case("paper/decay", {"model.u0=" + value}).model.parameters.at("u0");
  };
  EXPECT_EQ(u0(".1"), 0.1);
  EXPECT_EQ(u0("+.5e1"), 5.0);
  EXPECT_EQ(u0("1."), 1.0);
  EXPECT_EQ(u0("2.e-1"), 0.2);
  EXPECT_THAT([&] { u0("-.5"); },
              testing::ThrowsMessage<input_error>(HasSubstr("'model.u0' is the number -.5 (")));
  EXPECT_EQ(*load_case("paper/ode", {"time.dt=.02"}).time.dt, 0.02);
  EXPECT_EQ(load_case("paper/ode", {"title=.5"}).title, ".5");
  for (const std::string no_number : {".", "-.", "1.2.3", ".e5", "1.-2", "+-.5"})
    EXPECT_THAT([&] { u0(no_number); },
                testing::ThrowsMessage<input_error>(HasSubstr("is not a value of TOML")))
        << no_number;
}

TEST(cases, a_missing_case_is_an_input_error_with_the_nearest_name) {
  bad_input::expect_refused({
      {[] { load_case("paper/bgk-mixd"); },
       {"no case 'paper/bgk-mixd' (no file and no built-in case has this name); did you mean "
        "'paper/bgk-mixed'? see: apsis list cases"}},
      {[] { load_case("cylinder.toml"); }, {"did you mean 'gas/cylinder'? see: apsis list cases"}},
      {[] { load_case("cases/gas/cylinder.toml"); }, {"did you mean 'gas/cylinder'? see: apsis list cases"}},
      {[] { load_case("help"); },
       {"no case 'help' (no file and no built-in case has this name); see: apsis list cases"}},
      {[] { load_case("/"); }, {"'/' is not a case file (it is a folder); give a file"}},
  });
}

TEST(cases, resolved_text_reads_back_to_the_same_case) {
  for (const auto& name : case_names()) {
    const case_config c = load_case(name);
    const std::string text = to_toml(c);
    EXPECT_EQ(to_toml(parse_case(text, "again")), text) << name;
  }
}

RC_GTEST_PROP(cases, resolved_text_keeps_every_bit_of_random_values, ()) {
  case_config c = load_case("paper/bgk-mixed");
  const auto positive =
      rc::gen::map(rc::gen::arbitrary<int>(), [](int k) { return 1e-9 + std::abs(k * 1.2345678e-7); });
  c.time.cfl = *positive;
  c.time.end = *positive;
  c.velocity.max = *positive;
  c.space.domain = {{-*positive, *positive}};
  c.space.cells = {*rc::gen::inRange(1, 1000)};
  c.title = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 126));
  const case_config again = parse_case(to_toml(c), "again");
  RC_ASSERT(again.time.cfl == c.time.cfl);
  RC_ASSERT(again.time.end == c.time.end);
  RC_ASSERT(again.velocity.max == c.velocity.max);
  RC_ASSERT(again.space.domain == c.space.domain);
  RC_ASSERT(again.space.cells == c.space.cells);
  RC_ASSERT(again.title == c.title);
}

TEST(cases, lists_of_one_entry_are_written_without_brackets) {
  const std::string text = to_toml(load_case("paper/bgk-mixed"));
  const case_config plain = parse_case(text, "c.toml", {"space.cells=33", "space.domain=[0.0, 3.0]"});
  const case_config listed = parse_case(text, "c.toml", {"space.cells=[33]", "space.domain=[[0.0, 3.0]]"});
  EXPECT_EQ(to_toml(plain), to_toml(listed));
  EXPECT_THAT(to_toml(plain), HasSubstr("cells = 33\ndomain = [0.0, 3.0]\n"));
}

TEST(cases, cells_and_domain_of_several_dimensions_make_a_mesh) {
  const case_config c =
      load_case("paper/bgk-mixed", {"space.cells=[4,5,6]", "space.domain=[[0,4],[-1,1],[0,3]]",
                                    "space.formulation=finite-difference", "velocity.points=40"});
  EXPECT_EQ(c.model.parameters.at("velocity_dimensions"), 3.0);
  const apsis::grid mesh = make_mesh(c);
  EXPECT_EQ(mesh.dimensions(), 3);
  EXPECT_EQ(mesh.size(), 120);
  EXPECT_EQ(mesh.centre(0), (apsis::position{0.5, -0.8, 0.25}));
  EXPECT_EQ(make_boundaries(c, make_model(c)).size(), 3U);
  EXPECT_THAT(to_toml(c), HasSubstr("cells = [4, 5, 6]\ndomain = [[0.0, 4.0], [-1.0, 1.0], [0.0, 3.0]]\n"));
}

TEST(cases, each_end_may_have_its_own_boundary) {
  const std::string text = to_toml(load_case("paper/bgk-mixed"));
  const auto kinds = [](const case_config& c) {
    const auto faces = make_boundaries(c, make_model(c)).front();
    return std::pair{faces[0]->periodic(), faces[1]->periodic()};
  };
  EXPECT_EQ(kinds(parse_case(text, "c.toml")), std::pair(true, true));
  // The boundaries are given as tables, as dotted keys, and on the command line.
  const case_config c = parse_case(
      text + "[boundary.left]\nkind = \"outflow\"\n[boundary.right]\nkind = \"outflow\"\n", "c.toml");
  EXPECT_EQ(kinds(c), std::pair(false, false));
  EXPECT_EQ(c.space.boundary, "periodic");
  EXPECT_EQ(kinds(parse_case(to_toml(c), "again")), std::pair(false, false));
  EXPECT_EQ(kinds(parse_case(text, "c.toml", {"boundary.left.kind=outflow", "boundary.right.kind=outflow"})),
            std::pair(false, false));
}

TEST(cases, text_values_of_a_model_read_back_unchanged) {
  const case_config c = load_case("paper/relaxation", {"model.flux=u < 0.5 ? u/4 : (u - 0.25)/2"});
  EXPECT_EQ(c.model.options.at("flux"), "u < 0.5 ? u/4 : (u - 0.25)/2");
  EXPECT_EQ(parse_case(to_toml(c), "again").model.options, c.model.options);
  EXPECT_EQ(load_case("paper/relaxation", {"model.flux=0"}).model.options.at("flux"), "0");
}

TEST(cases, a_list_of_one_name_is_given_without_brackets_and_quotes) {
  const case_config c = load_case("paper/bgk-mixed", {"output.fields=T", "velocity.set=graded"});
  EXPECT_EQ(c.output.fields, std::vector<std::string>{"T"});
  EXPECT_EQ(c.velocity.set, std::vector<std::string>{"graded"});
}

TEST(schema, a_parameter_name_has_one_type_in_all_models) {
  // The command line decides whether a value needs quotes before it knows the model.
  for (const model_entry* one : model_entries())
    for (const model_option& text : one->options) {
      EXPECT_NE(std::find(text.choices.begin(), text.choices.end(), text.value), text.choices.end());
      for (const model_entry* other : model_entries())
        for (const model_parameter& p : other->parameters) EXPECT_NE(text.name, p.name);
    }
}

TEST(schema, has_every_key_once_and_the_keys_of_a_table_together) {
  std::set<std::string> keys, tables;
  std::string table = "none";
  for (const case_key& key : case_schema()) {
    EXPECT_TRUE(keys.insert(key.path).second) << key.path;
    const auto dot = key.path.find('.');
    const std::string here = dot == std::string::npos ? "" : key.path.substr(0, dot);
    EXPECT_TRUE(here == table || tables.insert(here).second) << key.path;
    table = here;
  }
}

TEST(schema, documents_every_key_with_its_default) {
  const std::string text = schema_text();
  for (const case_key& key : case_schema()) {
    EXPECT_FALSE(key.doc.empty()) << key.path;
    EXPECT_THAT(text, HasSubstr(key.path.substr(key.path.find('.') + 1))) << key.path;
  }
  EXPECT_THAT(text, HasSubstr("velocity_dimensions"));
  EXPECT_THAT(text, HasSubstr("weno5-z"));
  EXPECT_THAT(text, HasSubstr("buckley-leverett, or a formula in u"));
}

}  // namespace cases_test
