// Norms of a small version of every built-in case agree with pinned ones. This detects a change of any number
// of a case, even if no property of the solution reveals it. A new case fails until its norms are pinned.
// After an intended change, pin the norms again and review the difference before it is committed:
// APSIS_PIN_NORMS=1 build/release/tests/test_run --gtest_filter='*pinned_norms*'
#include "cases.hpp"

#include <apsis/config/case.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <support/instruction_sets.hpp>

namespace pinned_norms_test {

using namespace apsis;

namespace {

constexpr std::array<const char*, 4> norm_names = {"mean", "rms", "largest", "variation"};
/// Mean of |u|, root mean square, maximum of |u|, and mean difference of neighbours. Only the last one is
/// sensitive to a permutation.
using norms = std::array<double, 4>;
/// Norms of the small version of a case.
struct case_norms {
  std::map<std::string, norms> quantities;  ///< norms of the state and of each field
  double rounding = 0.0;                    ///< contribution of explicit collisions to the tolerance
};

// Some differences are legitimate. Kernels of another instruction set sum in another order and use fma.
// Another compiler or libm rounds exp and pow differently. Newton's method for the discrete Maxwellian stops
// at another iterate. Each difference is 1e-16 to 1e-13 of the largest value per stage. Nonlinear weights and
// ten steps of up to ten stages amplify it. In practice the instruction sets of one machine agree to 1e-13.
// The tolerance 1e-10 is a thousand times larger, but smaller than an error in a coefficient. Methods that
// evaluate Q explicitly amplify its rounding error by Δt/ε in every step.
constexpr double tolerance = 1e-10;
constexpr long steps = 10;

/// Returns the overrides that make a case small, restricted to keys of its model.
std::vector<std::string> small_version(const std::string& name) {
  const case_config whole = load_case(name);
  std::vector<std::string> overrides;
  // The cells suffice for the widest stencil. Jumps of the data are several cells apart.
  if (whole.places.contains("space.cells") && whole.solids.empty()) {
    constexpr std::array<int, 3> most_cells = {24, 12, 5};
    const int most = enough_cells(whole, most_cells.at(whole.space.cells.size() - 1));
    std::vector<int> cells;
    for (const int n : whole.space.cells) cells.push_back(std::min(n, most));
    overrides.push_back(cells.size() == 1 ? fmt::format("space.cells={}", cells.front())
                                          : fmt::format("space.cells=[{}]", fmt::join(cells, ",")));
  }
  // Δv = 1/2 resolves equilibria with temperatures near 1. The coarser density 1.4 saves time in space, and
  // with solids, whose boxes need all cells.
  const double density = whole.space.cells.size() == 3 || !whole.solids.empty() ? 1.4 : 4.0;
  if (whole.places.contains("velocity.points"))
    overrides.push_back(fmt::format(
        "velocity.points={}",
        std::min<int>(whole.velocity.points, static_cast<int>(std::ceil(density * whole.velocity.max)))));
  return overrides;
}

/// Returns the norms of u, in which NaN counts as 0. Fields have no values in solid cells. If a field lost
/// another value, its mean would change.
norms norms_of(std::vector<double> u) {
  norms n{};
  std::replace_if(u.begin(), u.end(), [](double x) { return std::isnan(x); }, 0.0);
  for (std::size_t k = 0; k < u.size(); ++k) {
    n[0] += std::abs(u[k]);
    n[1] += u[k] * u[k];
    n[2] = std::max(n[2], std::abs(u[k]));
    n[3] += k > 0 ? std::abs(u[k] - u[k - 1]) : 0.0;
  }
  const auto count = static_cast<double>(u.size());
  return {n[0] / count, std::sqrt(n[1] / count), n[2], n[3] / count};
}

/// Returns the norms after the first steps of a case.
case_norms computed(const std::string& name, std::vector<std::string> overrides) {
  simulation run(load_case(name, overrides));
  case_norms all;
  const auto epsilon = run.epsilon();
  if (schedule(find_method(run.config().time.method).coefficients<double>()).collision_evaluations() > 0)
    all.rounding = 10 * steps * std::numeric_limits<double>::epsilon() * run.dt() /
                   *std::min_element(epsilon.begin(), epsilon.end());
  while (!run.finished() && run.step() < steps) run.advance();
  all.quantities["state"] = norms_of(run.state());
  const field_table fields = run.fields();
  for (std::size_t k = 0; k < fields.names.size(); ++k)
    all.quantities["field:" + fields.names[k]] = norms_of(fields.values[k]);
  return all;
}

/// Returns a description of the differences between `now` and `pinned`, "" if they agree.
std::string difference(const case_norms& pinned, const case_norms& now) {
  // If a field vanishes by symmetry, its rounding errors are relative to the state.
  const double scale = now.quantities.at("state")[2];
  std::string text;
  for (const auto& [what, numbers] : now.quantities) {
    const auto found = pinned.quantities.find(what);
    if (found == pinned.quantities.end()) text += what + " is not pinned\n";
    for (std::size_t k = 0; found != pinned.quantities.end() && k < numbers.size(); ++k) {
      const double wanted = found->second[k];
      if (!(std::abs(numbers[k] - wanted) <= (tolerance + now.rounding) * (std::abs(wanted) + scale)))
        text += fmt::format("{} of {} is {:.13g}, pinned is {:.13g} (difference {:.1e})\n", norm_names[k],
                            what, numbers[k], wanted, numbers[k] - wanted);
    }
  }
  for (const auto& [what, numbers] : pinned.quantities)
    if (!now.quantities.contains(what)) text += what + " is pinned and not computed\n";
  return text;
}

std::map<std::string, case_norms> read_pinned() {
  std::map<std::string, case_norms> all;
  std::ifstream in(APSIS_PINNED_NORMS);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name, what;
    norms n{};
    words >> name >> what >> n[0] >> n[1] >> n[2] >> n[3];
    EXPECT_TRUE(words) << APSIS_PINNED_NORMS << ": " << line;
    all[name].quantities[what] = n;
  }
  return all;
}

void write_pinned(const std::map<std::string, case_norms>& all) {
  std::ofstream out(APSIS_PINNED_NORMS);
  out << "# Norms of the built-in cases in the small versions of pinned_norms.cpp, written by\n"
         "#   APSIS_PIN_NORMS=1 build/release/tests/test_run --gtest_filter='*pinned_norms*'\n"
         "# case, quantity, mean of |u|, root mean square, largest |u|, mean difference of neighbours\n";
  for (const auto& [name, pinned] : all)
    for (const auto& [what, n] : pinned.quantities)
      out << fmt::format("{} {} {:.13e} {:.13e} {:.13e} {:.13e}\n", name, what, n[0], n[1], n[2], n[3]);
  EXPECT_TRUE(out.flush()) << "cannot write " << APSIS_PINNED_NORMS;
}

const std::string pinning_hint =
    "if the change is meant, pin the norms again (APSIS_PIN_NORMS=1 test_run "
    "--gtest_filter='*pinned_norms*') and commit "
    "tests/run/pinned_norms.txt";

class pinned_norms : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(pinned_norms, of_the_small_version_agree_with_the_file) {
  auto pinned = read_pinned();
  if (std::getenv("APSIS_PIN_NORMS") != nullptr) {
    pinned[GetParam()] = computed(GetParam(), small_version(GetParam()));
    std::erase_if(pinned, [names = case_names()](const auto& entry) {
      return std::find(names.begin(), names.end(), entry.first) == names.end();
    });
    write_pinned(pinned);
    return;
  }
  ASSERT_TRUE(pinned.contains(GetParam())) << "no norms of case '" << GetParam() << "'; " << pinning_hint;
  for_each_instruction_set([&] {
    EXPECT_EQ(difference(pinned[GetParam()], computed(GetParam(), small_version(GetParam()))), "")
        << pinning_hint;
  });
}

INSTANTIATE_TEST_SUITE_P(cases, pinned_norms, testing::ValuesIn(case_names()), [](const auto& p) {
  std::string name = p.param;
  for (char& c : name) c = c == '-' || c == '/' ? '_' : c;
  return name;
});

TEST(the_file_of_pinned_norms, has_no_case_that_no_longer_exists) {
  const auto names = case_names();
  for (const auto& [name, quantities] : read_pinned())
    EXPECT_TRUE(std::find(names.begin(), names.end(), name) != names.end())
        << "'" << name << "' is not a built-in case; " << pinning_hint;
}

TEST(the_comparison_with_pinned_norms, detects_a_domain_longer_by_a_part_in_two_million) {
  const std::string name = "paper/bgk-mixed";
  auto overrides = small_version(name);
  const auto pinned = computed(name, overrides);
  overrides.push_back("space.domain=[0.0, 2.000001]");
  const auto text = difference(pinned, computed(name, overrides));
  EXPECT_NE(text.find(" of state is "), std::string::npos) << text;
  EXPECT_NE(text.find(" of field:rho is "), std::string::npos) << text;
}

}  // namespace pinned_norms_test
