// Input of studies: lists, ranges, references, and their errors.
#include <apsis/core/errors.hpp>
#include <apsis/study/convergence.hpp>
#include <apsis/study/settings.hpp>

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/property.hpp>

namespace convergence_input_test {

using namespace apsis;
using testing::ElementsAre;
using testing::HasSubstr;
using kind = convergence_reference::kind;

TEST(vary, separates_values_but_not_inside_brackets_and_quotes) {
  EXPECT_EQ(parse_vary("a.b=1").key, "a.b");
  EXPECT_THAT(parse_vary("a= 1 ,2, 4..8 ").values, ElementsAre("1", "2", "4", "8"));
  EXPECT_THAT(parse_vary("a=1,2e-3,1/4").values, ElementsAre("1", "2e-3", "1/4"));
  EXPECT_THAT(parse_vary("d=[0, 1],[0,[2,3]]").values, ElementsAre("[0, 1]", "[0,[2,3]]"));
  EXPECT_THAT(parse_vary("t=\"a,b\",'c,\"d'").values, ElementsAre("\"a,b\"", "'c,\"d'"));
  EXPECT_THAT(parse_vary("e=max(x,1),2").values, ElementsAre("max(x,1)", "2"));
  EXPECT_THAT(parse_vary("e=a=b,c").values, ElementsAre("a=b", "c"));
}

TEST(vary, doubles_and_halves_ranges) {
  EXPECT_THAT(parse_vary("n=20..160").values, ElementsAre("20", "40", "80", "160"));
  EXPECT_THAT(parse_vary("n=40..5").values, ElementsAre("40", "20", "10", "5"));
  EXPECT_THAT(parse_vary("n=1/4..1/32,1/100").values, ElementsAre("1/4", "1/8", "1/16", "1/32", "1/100"));
  EXPECT_THAT(parse_vary("n=1/4..2").values, ElementsAre("1/4", "1/2", "1", "2"));
  EXPECT_THAT(parse_vary("n=0.5..0.125").values, ElementsAre("0.5", "0.25", "0.125"));
  EXPECT_THAT(parse_vary("n=7..7").values, ElementsAre("7"));
  EXPECT_THAT(parse_vary("n=../file").values, ElementsAre("../file"));
}

TEST(vary, ranges_keep_their_ratio) {
  check_property("ratio", [] {
    const int p = *rc::gen::inRange(1, 1000), q = *rc::gen::inRange(1, 1000), k = *rc::gen::inRange(-12, 13);
    const std::string first = std::to_string(p) + "/" + std::to_string(q);
    const std::string last = k >= 0 ? std::to_string(p << k) + "/" + std::to_string(q)
                                    : std::to_string(p) + "/" + std::to_string(q << -k);
    const auto values = parse_vary("time.dt=" + first + ".." + last).values;
    RC_ASSERT(values.size() == static_cast<std::size_t>(std::abs(k)) + 1);
    for (std::size_t m = 0; m < values.size(); ++m) {
      const auto config = load_case("paper/ode", {"time.end=2e6", "time.dt=" + values[m]});
      const double wanted = std::ldexp(static_cast<double>(p) / q, (k < 0 ? -1 : 1) * static_cast<int>(m));
      RC_ASSERT(std::abs(*config.time.dt / wanted - 1.0) <= 1e-15);
    }
  });
}

TEST(vary, any_text_is_read_or_refused) {
  check_property("text", [] {
    const auto letter = rc::gen::elementOf(std::string("=,.@[]{}()\"'/-+e0123456789ax\n\x01\xff"));
    const auto text = *rc::gen::container<std::string>(letter);
    try {
      const auto varied = parse_vary(text);
      RC_ASSERT(!varied.key.empty());
      RC_ASSERT(!varied.values.empty());
    } catch (const input_error& refused) {
      RC_ASSERT(std::string(refused.what()).find('\n') == std::string::npos);
    }
    try {
      parse_reference(text);
    } catch (const input_error&) {
    }
  });
}

TEST(references, are_words_methods_with_steps_or_keys) {
  EXPECT_EQ(parse_reference("exact").type, kind::exact);
  EXPECT_EQ(parse_reference("next").type, kind::next);
  EXPECT_EQ(parse_reference("time").type, kind::time);
  EXPECT_EQ(parse_reference("space+time").type, kind::space_time);
  EXPECT_THAT(parse_reference("md-imex-6-3@1/1024").overrides,
              ElementsAre("time.method=md-imex-6-3", "time.dt=1/1024"));
  EXPECT_THAT(parse_reference("space.cells=80,model.epsilon=max(x,1)").overrides,
              ElementsAre("space.cells=80", "model.epsilon=max(x,1)"));
}

TEST(settings, upper_layers_replace_keys_and_step_rules) {
  EXPECT_THAT(layered({"a=1", "time.cfl=0.5", "b=2"}, {"b=3", "time.dt=1e-3"}),
              ElementsAre("a=1", "b=3", "time.dt=1e-3"));
  EXPECT_THAT(layered({"a=1", "time.cfl=0.5"}, {"a=2"}), ElementsAre("time.cfl=0.5", "a=2"));
}

TEST(settings, have_numbers) {
  const auto c = load_case("paper/bgk-accuracy", {"model.epsilon=1/4", "space.cells=50"});
  EXPECT_EQ(number_of(c, "model.epsilon"), 0.25);
  EXPECT_EQ(number_of(c, "space.cells"), 50.0);
  EXPECT_EQ(resolution(c, "space.cells"), 2.0 / 50.0);
  EXPECT_EQ(resolution(c, "velocity.points"), 30.0 / 150.0);
  EXPECT_TRUE(std::isnan(number_of(c, "time.dt")));
  EXPECT_TRUE(std::isnan(number_of(c, "time.method")));
  EXPECT_TRUE(std::isnan(number_of(load_case("paper/bgk-mixed"), "model.epsilon")));
  EXPECT_EQ(number_of(load_case("paper/decay"), "model.u0"), 10.0);
  // Formulas may contain the constants of their case. A rarefaction is a formula that is converted.
  EXPECT_EQ(number_of(load_case("gas/sod"), "model.epsilon"), 1e-4);
  const auto couette = load_case("gas/couette");
  EXPECT_EQ(number_of(couette, "model.epsilon"), make_epsilon(couette, 1).evaluate(apsis::position{}));
}

namespace {

/// A gas on a line with Gauss–Hermite points, which need no velocity.max.
const char* const of_gauss_points = R"case([model]
name = "bgk"
[initial]
rho = "1 + 0.1*sin(2*pi*x)"
T = 1
[space]
cells = 12
[velocity]
set = "gauss-hermite"
points = 4
[time]
method = "md-imex-6-3"
end = 0.02
dt = 0.01
)case";

}  // namespace

TEST(settings, have_the_spacing_of_the_velocities_of_the_run) {
  // The largest of the four points is the root of v⁴ − 6v² + 3.
  const double end = std::sqrt(3.0 + std::sqrt(6.0));
  EXPECT_NEAR(resolution(parse_case(of_gauss_points, "gauss"), "velocity.points"), 2.0 * end / 3.0, 1e-14);
  // Scaled to end at max = 6.
  EXPECT_NEAR(resolution(parse_case(of_gauss_points, "gauss", {"velocity.max=6"}), "velocity.points"), 4.0,
              1e-14);
  // Each direction of velocity has its own line.
  const std::vector<std::string> plane = {"model.velocity_dimensions=2", "velocity.points=[4,10]",
                                          "velocity.set=[\"gauss-hermite\",\"uniform\"]", "velocity.max=6"};
  const auto lines = parse_case(of_gauss_points, "gauss", plane);
  EXPECT_NEAR(resolution(lines, "velocity.points"), 4.0, 1e-14);
  EXPECT_EQ(resolution(lines, "velocity.points", 1), 1.2);
}

TEST(settings, of_velocities_that_choose_their_maximum_have_rates) {
  const convergence_study study{.case_name = "gauss",
                                .case_text = of_gauss_points,
                                .vary = {parse_vary("velocity.points=12,4,8")},
                                .reference = parse_reference("velocity.points=20"),
                                .quantity = "rho"};
  const auto table = converge(study);
  EXPECT_EQ(table.h_name, "Δv");
  const auto& rows = table.blocks.at(0).rows;
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(rows[0].values, ElementsAre("4"));
  EXPECT_THAT(rows[2].values, ElementsAre("12"));
  EXPECT_NEAR(rows[0].h, 2.0 * std::sqrt(3.0 + std::sqrt(6.0)) / 3.0, 1e-14);
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_LT(rows[k].h, rows[k - 1].h);
    EXPECT_EQ(rows[k].rate,
              std::log(rows[k - 1].error / rows[k].error) / std::log(rows[k - 1].h / rows[k].h));
    EXPECT_GT(rows[k].rate, 1.0);
  }
}

namespace {

struct bad_study {
  std::string name, case_name;
  std::vector<std::string> overrides, vary;
  std::string reference, quantity, says;
};

void PrintTo(const bad_study& b, std::ostream* out) {
  *out << b.name;
}

std::string planned(const bad_study& b) {
  try {
    convergence_study study{.case_name = b.case_name, .overrides = b.overrides, .quantity = b.quantity};
    for (const auto& text : b.vary) study.vary.push_back(parse_vary(text));
    if (!b.reference.empty()) study.reference = parse_reference(b.reference);
    const convergence planned(study);
  } catch (const input_error& e) {
    return e.what();
  }
  return "accepted";
}

std::string many(int count) {
  std::string list;
  for (int k = 1; k <= count; ++k) list += (k > 1 ? "," : "") + std::to_string(k);
  return list;
}

class bad_studies : public testing::TestWithParam<bad_study> {};

TEST_P(bad_studies, are_refused_before_any_run) {
  EXPECT_THAT(planned(GetParam()), HasSubstr(GetParam().says));
}

const std::string bgk = "paper/bgk-accuracy", ode = "paper/ode";

const std::vector<bad_study> all = {
    {"unknown_case", "paper/odd", {}, {"time.dt=1/4"}, "", "", "did you mean 'paper/ode'?"},
    {"nothing_varied", ode, {}, {}, "", "", "nothing is varied"},
    {"no_equals", ode, {}, {"time.dt"}, "", "", "not of the form key=value"},
    {"no_key", ode, {}, {"=1"}, "", "", "not of the form key=value"},
    {"no_values", ode, {}, {"time.dt="}, "", "", "a value is empty"},
    {"empty_value", ode, {}, {"time.dt=1/4,,1/8"}, "", "", "a value is empty"},
    {"trailing_comma", ode, {}, {"time.dt=1/4,"}, "", "", "a value is empty"},
    {"value_twice", ode, {}, {"time.dt=1/4,1/8,1/4"}, "", "", "twice"},
    {"value_twice_in_a_range", ode, {}, {"time.dt=1/4..1/16,1/8"}, "", "", "twice"},
    {"value_twice_written_differently", ode, {}, {"time.dt=1/4,0.25"}, "", "", "make the same run"},
    {"formula_twice", ode, {}, {"model.epsilon=1/4,0.25"}, "time", "", "make the same run"},
    {"open_range", ode, {}, {"time.dt=1/4..1/5"}, "", "", "does not end"},
    {"endless_range", ode, {}, {"time.dt=1e300..1e-300"}, "", "", "does not end"},
    {"key_twice", ode, {}, {"time.dt=1/4", "time.dt=1/8"}, "", "", "varied twice"},
    {"key_varied_and_set", ode, {"time.dt=1/4"}, {"time.dt=1/4,1/8"}, "", "", "both varied and set"},
    {"unknown_key", ode, {}, {"time.td=1/4,1/8"}, "", "", "did you mean 'time.dt'?"},
    {"key_of_another_model", ode, {}, {"space.cells=10,20"}, "", "", "has no space"},
    {"wrong_type", bgk, {}, {"space.cells=ten"}, "", "", "not a value of TOML"},
    {"control_characters", ode, {}, {"time.\x1b[2Jdt=1"}, "", "", "?"},
    {"two_step_rules", bgk, {}, {"time.dt=1e-3", "time.cfl=0.5"}, "", "", "conflicts"},
    {"useless_key", ode, {}, {"output.every=1,2"}, "", "", "cannot be varied"},
    {"title", ode, {}, {"title=a,b"}, "", "", "cannot be varied"},
    {"too_many_runs",
     ode,
     {},
     {"model.epsilon=" + many(101), "time.end=" + many(100)},
     "",
     "",
     "at most 10000"},
    {"mesh_below_stencil", bgk, {}, {"space.cells=3,6"}, "", "", "stencil"},
    {"method_without_transport",
     bgk,
     {},
     {"time.method=imdrk-1-2", "space.cells=20,40"},
     "",
     "",
     "implicit only"},
    {"exact_where_none_is", ode, {}, {"time.dt=1/4,1/8"}, "exact", "", "no exact solution of model 'ode'"},
    {"unknown_reference", ode, {}, {"time.dt=1/4,1/8"}, "exakt", "", "did you mean 'exact'?"},
    {"reference_method", ode, {}, {"time.dt=1/4"}, "md-imex-6-4@1/8", "", "did you mean 'md-imex-6-3'?"},
    {"reference_step", ode, {}, {"time.dt=1/4"}, "md-imex-6-3@", "", "override 'time.dt='"},
    {"reference_key", ode, {}, {"time.dt=1/4"}, "time.tend=3", "", "did you mean 'time.end'?"},
    {"step_too_short", ode, {}, {"time.dt=1/4,1e-17"}, "", "", "dt is too small"},
    {"reference_end", ode, {}, {"time.dt=1/4"}, "time.end=3", "", "'time.end'"},
    {"reference_without_space", ode, {}, {"time.dt=1/4,1/8"}, "space+time", "", "has no space"},
    {"reference_coarser", bgk, {}, {"space.cells=20,40"}, "space.cells=20", "", "coarser"},
    {"next_without_refinement", ode, {}, {"model.epsilon=1,2"}, "next", "", "needs a finer run"},
    {"no_reference", ode, {}, {"model.epsilon=1,2"}, "", "", "give --reference"},
    {"meshes_not_nested", bgk, {}, {"space.cells=20,30"}, "", "", "choose a multiple of 20 along x"},
    {"velocity_of_states", bgk, {}, {"velocity.points=100,150"}, "velocity.points=200", "", "velocities"},
    {"velocity_set_of_states",
     bgk,
     {"time.dt=1e-3", "space.cells=8"},
     {"model.epsilon=1,2"},
     "velocity.set=gauss-hermite",
     "",
     "a run and its reference differ in 'velocity'"},
    {"unknown_quantity", bgk, {}, {"space.cells=20,40"}, "", "rhoo", "did you mean 'rho'?"},
    {"unknown_quantity_exact", "paper/decay", {}, {"time.dt=1/8,1/16"}, "", "v", "valid: u"},
};

}  // namespace

INSTANTIATE_TEST_SUITE_P(table, bad_studies, testing::ValuesIn(all),
                         [](const auto& b) { return b.param.name; });

TEST(convergence_input, fields_can_be_compared_across_velocity_grids) {
  EXPECT_EQ(
      planned({"", bgk, {"space.cells=8"}, {"velocity.points=100,150"}, "velocity.points=200", "rho", ""}),
      "accepted");
}

TEST(convergence_input, a_case_need_not_be_a_file) {
  convergence_study study{
      .case_name = "mine",
      .case_text = "[model]\nname = \"decay\"\n[time]\nmethod = \"imdrk-1-2\"\nend = 1.0\ndt = 0.5\n",
      .vary = {parse_vary("time.dt=1/2,1/4")}};
  EXPECT_EQ(converge(study).blocks.at(0).rows.size(), 2U);
  study.vary = {parse_vary("time.dt=x")};
  EXPECT_THROW(converge(study), input_error);
}

}  // namespace convergence_input_test
