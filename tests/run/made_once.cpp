// A run makes its expensive objects once. Reading, checking, running and reporting share them.
#include <apsis/boundary/domain.hpp>
#include <apsis/config/case.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/folder.hpp>

namespace made_once_test {

namespace {

using apsis::domain;
using apsis::expression;
using apsis::model;
using apsis::run_setup;

/// The case has five formulas that no other test has. Further formulas are the numbers 0.251 and 0.502 of a
/// box, 1, 0, and 0 as a function of t.
const std::string gas = R"toml(
title = "Walls and a force"
[model]
name = "bgk"
epsilon = "0.1 + 0.017*y"
[initial]
rho = "1 + 0.013*sin(x)"
T = 1
[space]
cells = [8, 8]
domain = [[0, 1.004], [0, 1.004]]
boundary = "diffuse"
[[space.solid]]
from = [0.251, 0.251]
to = [0.502, 0.502]
T = "1.1 + 0.019*t"
[boundary.top]
kind = "diffuse"
velocity = ["0.1 + 0.0123*x", 0]
[force]
acceleration = ["0.0157*x", 0]
[velocity]
max = 6
points = 12
[time]
method = "md-imex-3-2"
cfl = 0.3
end = 0.01
[output]
surfaces = "all"
every = 0.005
)toml";

/// Numbers of objects made so far.
struct counts {
  long models = model::so_far(), setups = run_setup::so_far(), domains = domain::so_far(),
       formulas = expression::compiled_so_far();
};

counts made_by_a_run(const std::string& text, const std::vector<std::string>& overrides) {
  const test_folder folder;
  const counts before;
  apsis::session_options options;
  options.out = folder / "result";
  apsis::run_session(apsis::parse_case(text, "case.toml", overrides), options).run();
  const counts after;
  return {after.models - before.models, after.setups - before.setups, after.domains - before.domains,
          after.formulas - before.formulas};
}

}  // namespace

TEST(made_once, are_model_setup_domain_and_formulas_of_a_run) {
  apsis::prototype(apsis::find_model("bgk"));  // for queries about the model without a case
  const counts made = made_by_a_run(gas, {});
  EXPECT_EQ(made.models, 1);
  EXPECT_EQ(made.setups, 1);
  EXPECT_EQ(made.domains, 1);
  // Other tests may have compiled the last three numbers.
  EXPECT_GE(made.formulas, 7);
  EXPECT_LE(made.formulas, 10);
}

TEST(made_once, are_those_of_a_case_that_was_changed_after_it_was_read) {
  auto c = apsis::parse_case(gas, "case.toml");
  const auto before = apsis::make_model(c);
  EXPECT_EQ(apsis::make_model(c), before);
  auto changed = c;
  changed.velocity.points = 16;
  const auto other = apsis::make_model(changed);
  EXPECT_NE(other, before);
  EXPECT_EQ(other->components(), 256);
  EXPECT_EQ(apsis::make_model(c)->components(), 144);
}

TEST(made_once, are_domains_of_problems_that_exist_beside_each_other) {
  const auto c = apsis::parse_case(gas, "case.toml");
  const run_setup setup(c);
  const long before = domain::so_far();
  const auto one = setup.make_problem(), other = setup.make_problem();  // each problem has its own ghost rows
  EXPECT_EQ(setup.open_faces().size(), 6U);
  EXPECT_EQ(domain::so_far() - before, 2);
}

}  // namespace made_once_test
