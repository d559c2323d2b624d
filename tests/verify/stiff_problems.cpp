// Stiff problems of the literature: digits of their solutions at a given tolerance.
#include <apsis/integrate/autodiff.hpp>
#include <apsis/verify/stiff_problem.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace stiff_problems_test {
namespace {

using apsis::find_stiff_problem;
using apsis::solve_stiff_problem;
using apsis::stiff_problem_entries;
using apsis::stiff_problem_entry;

std::string plain(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

std::vector<std::string> names(bool slow) {
  std::vector<std::string> found;
  for (const auto* one : stiff_problem_entries())
    if (one->slow == slow && one->name != "ring-modulator") found.push_back(one->name);
  return found;
}

/// Solves a problem to rtol = 10^−digits. Records digits, steps and calls of G (--gtest_output=json:FILE).
void require_digits(const stiff_problem_entry& problem, const std::string& method, int digits) {
  const auto found = solve_stiff_problem(problem, method, std::pow(10.0, -digits));
  EXPECT_GE(found.digits, digits - 1) << method;
  ::testing::Test::RecordProperty(fmt::format("{} to 1e-{}", method, digits),
                                  fmt::format("{:.1f} digits, {} steps, {} rejected, {} calls", found.digits,
                                              found.steps, found.rejected, found.evaluations));
}

class every_stiff_problem : public ::testing::TestWithParam<std::string> {};

TEST_P(every_stiff_problem, is_solved_to_the_digits_of_its_tolerance) {
  for (const int digits : {4, 6, 8})
    require_digits(find_stiff_problem(GetParam()), "imdrk-9-5-accurate", digits);
}

INSTANTIATE_TEST_SUITE_P(stiff_problems, every_stiff_problem, ::testing::ValuesIn(names(false)),
                         [](const auto& test) { return plain(test.param); });

/// The method that `auto` chooses for systems whose stages Newton's method solves.
class every_stiff_problem_by_default : public ::testing::TestWithParam<std::string> {};

TEST_P(every_stiff_problem_by_default, is_solved_to_the_digits_of_its_tolerance) {
  for (const int digits : {4, 6, 8}) require_digits(find_stiff_problem(GetParam()), "ark-548-2", digits);
}

INSTANTIATE_TEST_SUITE_P(stiff_problems, every_stiff_problem_by_default, ::testing::ValuesIn(names(false)),
                         [](const auto& test) { return plain(test.param); });
INSTANTIATE_TEST_SUITE_P(slow_stiff_problems, every_stiff_problem_by_default,
                         ::testing::ValuesIn(names(true)),
                         [](const auto& test) { return plain(test.param); });

class every_slow_stiff_problem : public ::testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(every_slow_stiff_problem, is_solved_to_the_digits_of_its_tolerance) {
  const auto& [name, digits] = GetParam();
  require_digits(find_stiff_problem(name), "extrapolated-euler-6", digits);
}

INSTANTIATE_TEST_SUITE_P(SLOW_stiff_problems, every_slow_stiff_problem,
                         ::testing::Combine(::testing::ValuesIn(names(true)), ::testing::Values(4, 6)),
                         [](const auto& test) {
                           return fmt::format("{}_to_{}", plain(std::get<0>(test.param)),
                                              std::get<1>(test.param));
                         });

TEST(SLOW_stiff_problems, errors_of_lasting_oscillations_add_up) {
  // The ring modulator takes 30 000 and 67 000 steps. Its fast oscillations do not damp their errors. At 1e-6
  // it loses a digit more than other problems.
  const auto& problem = find_stiff_problem("ring-modulator");
  require_digits(problem, "extrapolated-euler-6", 4);
  EXPECT_GE(solve_stiff_problem(problem, "extrapolated-euler-6", 1e-6).digits, 4);
}

// Smaller tolerances make up for it.
TEST(SLOW_stiff_problems, lasting_oscillations_reach_the_digits_of_a_tolerance_at_the_end) {
  const auto& problem = find_stiff_problem("ring-modulator");
  for (const int digits : {4, 6}) {
    const auto found = apsis::solve_stiff_problem_to_end(problem, "ark-548-2", std::pow(10.0, -digits));
    EXPECT_GE(found.digits, digits - 1) << digits;
  }
}

TEST(stiff_problems, digits_of_a_tolerance_at_the_end_are_at_least_its_own) {
  for (const char* name : {"oregonator", "hires", "brusselator"}) {
    const auto& problem = find_stiff_problem(name);
    const auto by_steps = solve_stiff_problem(problem, "ark-548-2", 1e-5);
    const auto found = apsis::solve_stiff_problem_to_end(problem, "ark-548-2", 1e-5);
    EXPECT_GE(found.digits, 5) << name;
    EXPECT_GT(found.steps, 2 * by_steps.steps) << name;  // it counts all runs
  }
}

TEST(stiff_problems, have_what_an_entry_must_have) {
  std::set<std::string> all;
  for (const auto* one : stiff_problem_entries()) {
    EXPECT_TRUE(all.insert(one->name).second) << one->name;
    const std::size_t n = one->start().size();
    EXPECT_TRUE(one->sizes.size() == 1 || one->sizes.size() == n) << one->name;
    EXPECT_TRUE(std::is_sorted(one->times.begin(), one->times.end()) && one->times.size() > 1) << one->name;
    EXPECT_FALSE(one->reference.empty()) << one->name;
    for (const auto& [i, value] : one->reference) EXPECT_TRUE(i < n && std::isfinite(value)) << one->name;
    EXPECT_FALSE(one->source.empty() || one->origin.empty() || one->description.empty()) << one->name;
  }
  EXPECT_GE(all.size(), 10u);
}

TEST(stiff_problems, derivatives_stay_inside_their_patterns) {
  // Products with single unit vectors must stay in the pattern, at the start and off it.
  for (const auto* one : stiff_problem_entries()) {
    if (one->pattern == nullptr) continue;
    const auto pattern = one->pattern();
    const auto rate = one->rate(0);
    auto u = one->start();
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += 0.1 + 0.01 * std::sin(static_cast<double>(i));
    ASSERT_EQ(pattern.size(), u.size());
    std::vector<apsis::dual<double>> in(u.begin(), u.end()), out(u.size());
    const apsis::dual<double> t(0.5), s(0.0, true);
    for (std::size_t j = 0; j < u.size(); j += 7) {
      in[j] = s + u[j];
      rate->evaluate(t, in, out);
      in[j] = u[j];
      const auto rows = pattern.rows(j);
      for (std::size_t i = 0; i < u.size(); ++i)
        EXPECT_TRUE(out[i].derivative(1) == 0 || std::binary_search(rows.begin(), rows.end(), i))
            << one->name << " " << i << " " << j;
    }
  }
}

TEST(stiff_problems, digits_are_those_of_the_worst_unknown) {
  const auto& problem = find_stiff_problem("oregonator");
  std::vector<double> u;
  for (const auto& [i, value] : problem.reference) u.push_back(value);
  u[1] += 1e-3 * (u[1] + 1);  // its size is 1
  EXPECT_NEAR(apsis::correct_digits(problem, u), 3, 1e-9);
  u[0] = std::nan("");
  EXPECT_EQ(apsis::correct_digits(problem, u), -INFINITY);
}

TEST(stiff_problems, e5_and_robertson_conserve_their_sums) {
  // The sums are y₀ + y₁ + y₂ = 1, and y₁ − y₂ − y₃ = 0 of numbers up to 1.2e-10.
  const auto robertson = solve_stiff_problem(find_stiff_problem("robertson"), "imdrk-9-5-accurate", 1e-6).u;
  EXPECT_NEAR(robertson[0] + robertson[1] + robertson[2], 1, 1e-13);
  const auto e5 = solve_stiff_problem(find_stiff_problem("e5"), "imdrk-9-5-accurate", 1e-6).u;
  EXPECT_NEAR(e5[1] - e5[2] - e5[3], 0, 1e-24);  // a hundred roundings
}

TEST(stiff_problems, stages_without_second_derivatives_share_one_of_their_step) {
  // With two unknowns a derivative has two products. Every attempt of a step computes one derivative, and
  // more where the oscillator turns.
  const auto found = solve_stiff_problem(find_stiff_problem("van-der-pol"), "ark-437", 1e-6);
  const long attempts = found.steps + found.rejected;
  EXPECT_GE(found.products, 2 * found.steps);
  EXPECT_LE(found.products, 2 * 2 * attempts);
  EXPECT_GT(found.evaluations - found.products, 6 * found.steps);  // a value for each of six stages at least
}

TEST(stiff_problems, refuse_unknown_names_and_too_many_steps) {
  bad_input::expect_refused({
      {[] { find_stiff_problem("robertsen"); },
       {"unknown stiff problem 'robertsen'", "did you mean 'robertson'"},
       2},
      {[] { solve_stiff_problem(find_stiff_problem("hires"), "imdrk-3-3", 1e-8, 10); },
       {"'imdrk-3-3' of 'hires' takes more than 10 steps"},
       3},
      {[] { solve_stiff_problem(find_stiff_problem("hires"), "imdrk-3-3", 1e-8, 1000000, 0.0); },
       {"'imdrk-3-3' of 'hires' takes more than 0 s"},
       3},
  });
}

}  // namespace
}  // namespace stiff_problems_test
