// A file with a single wrong coefficient is rejected.
#include "named_tree.hpp"
#include "support/catalogue.hpp"
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/resolved_flows.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace apsis::test::mutations_test {
namespace {

struct mutant {
  std::string what, text;
  int weight_of_first_stage = 0;  ///< i if P_i1 is changed, otherwise 0
};

std::string moved(const std::string& text, const char* by) {
  return mp_real(coefficient_value(text) + mp_real(by)).str(45, std::ios_base::fixed);
}

/// Returns the files of all methods that differ from m in one coefficient, also in one that is zero.
std::vector<mutant> mutants(const method& m, const char* by) {
  std::vector<mutant> all;
  method changed = m;
  const auto change = [&](std::string& place, const std::string& what) {
    const std::string kept = place;
    place = moved(kept, by);
    all.push_back({what + " + " + by, to_toml(changed)});
    place = kept;
  };
  const auto name = [](const char* what, std::size_t i, std::size_t j) {
    return what + std::to_string(i + 1) + std::to_string(j + 1);
  };
  auto& e = changed.exact;
  for (std::size_t i = 0; i < m.stages(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (m.is_tableau()) {
        change(e.D(i, j), name("A", i, j));
        if (m.kind == method_kind::imex) change(e.W(i, j), name("A_hat", i, j));
        continue;
      }
      change(e.P(i, j), name("P", i, j));
      if (j == 0) all.back().weight_of_first_stage = static_cast<int>(i + 1);
      if (m.kind != method_kind::implicit_only) change(e.W(i, j), name("W", i, j));
    }
    if (m.kind == method_kind::explicit_only) continue;
    change(e.D(i, i), name("d", i, i));
    if (!m.is_tableau() && has_derivatives(m.kind)) change(e.ddot[i], name("ddot", i, i));
  }
  if (m.kind != method_kind::implicit_only && !m.is_tableau()) change(e.r, "r");
  return all;
}

/// The claims do not depend on these coefficients. A change by 1e-6 gives another method with
/// the same claims.
const std::map<std::string, std::vector<std::string>> free_coefficients = {
    // Conditions of order 1 do not involve Q̇.
    {"forward-backward-euler", {"ddot22 + -1e-6"}},
    // Only T(u_2) is used. It reaches u^{n+1} through u_3 and u_5 with the weights γ b̂_3 and −γ b̂_3.
    // Conditions of order 3 therefore do not depend on the abscissa of stage 2.
    {"bhr-553",
     {"A21 + 1e-6", "A21 + -1e-6", "d22 + 1e-6", "d22 + -1e-6", "A_hat21 + 1e-6", "A_hat21 + -1e-6"}}};

bool is_free(const method& m, const std::string& what) {
  const auto found = free_coefficients.find(m.name);
  return found != free_coefficients.end() &&
         std::find(found->second.begin(), found->second.end(), what) != found->second.end();
}

bool same_butcher_form(const method& a, const method& b) {
  const auto x = to_butcher(a.coefficients<mp_real>()), y = to_butcher(b.coefficients<mp_real>());
  for (std::size_t i = 0; i < a.stages(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      for (const auto part :
           {&butcher_form<mp_real>::A_hat, &butcher_form<mp_real>::A, &butcher_form<mp_real>::A_dot})
        if (abs((x.*part)(i, j) - (y.*part)(i, j)) > mp_real(1e-40)) return false;
  return true;
}

/// Reasons for the rejection of mutants that satisfy the order conditions. All other mutants violate one.
const std::map<std::pair<std::string, std::string>, std::string> other_causes = {
    // Conditions of order 1 do not involve Q̇. Its sign decides about strong stability, its presence in stage
    // 1 about the type.
    {{"forward-backward-euler", "ddot11 + 1e-6"}, "claims.ssp_coefficient = 1 but the Butcher form gives 0"},
    {{"forward-backward-euler", "ddot22 + 1e-6"}, "claims.ssp_coefficient = 1 but the Butcher form gives 0"},
    {{"forward-backward-euler", "ddot11 + -1e-6"}, "claims.type = ARS but the method is of type A"},
    // T of stage 1 is not used. Q of stage 1 has weight 0 in u^{n+1}.
    {{"ssp3-433", "d11 + 1e-6"}, "claims.l_stable = true but the implicit part is A("},
    {{"ssp3-433", "d11 + -1e-6"}, "claims.l_stable = true but the implicit part is A("},
};

/// Expects that the message names a condition of the claimed order, and that `m` violates it by
/// the printed residual.
void expect_violated_condition(const method& m, const std::string& refusal) {
  const std::regex pattern(
      R"(order (\d+): the condition of tree ([FG\[\],]+) is \S+ instead of \S+ \(residual (\S+)\))");
  std::smatch part;
  ASSERT_TRUE(std::regex_match(refusal, part, pattern)) << refusal;
  const named_tree tree(part[2]);
  EXPECT_EQ(tree.nodes(), std::stoi(part[1])) << refusal;
  EXPECT_LE(tree.nodes(), m.claims.order) << refusal;
  const auto form = m.coefficients<mp_real>();
  const auto weights =
      tree.weights(to_butcher(m.kind == method_kind::exact_collision ? with_resolved_flows(form) : form));
  const mp_real residual = weights.back() - 1 / tree.density();
  const mp_real printed(part[3].str());
  EXPECT_NE(printed, 0) << refusal;
  EXPECT_LE(abs(residual - printed), mp_real("0.01") * abs(residual))
      << refusal;  // printed with three digits
}

class every_method : public ::testing::TestWithParam<std::string> {};

TEST_P(every_method, is_rejected_for_the_right_reason_if_a_coefficient_is_off_by_a_millionth) {
  const method& m = find_method(GetParam());
  // If the first stage is u^n, a change of P_i1 shifts weight from u^n to itself. The method is the same, in
  // another form.
  const bool first_is_initial = !m.is_tableau() && m.exact.D(0, 0) == "0" && m.exact.ddot[0] == "0";
  for (const char* by : {"1e-6", "-1e-6"})
    for (const auto& mutant : mutants(m, by)) {
      SCOPED_TRACE(mutant.what);
      const method changed = parse_method(mutant.text, "mutant.toml");
      const certificate c = certify(changed);
      if (is_free(m, mutant.what)) {
        EXPECT_TRUE(c.claims_hold);
        continue;
      }
      // A form that is not unique is refused if strong stability follows from it.
      if (first_is_initial && mutant.weight_of_first_stage > 0 && m.claims.ssp_coefficient == "0") {
        EXPECT_TRUE(same_butcher_form(m, changed) && c.claims_hold);
        continue;
      }
      ASSERT_FALSE(c.failures.empty());
      const auto other = other_causes.find({m.name, mutant.what});
      if (other != other_causes.end())
        EXPECT_THAT(c.failures.front(), ::testing::StartsWith(other->second));
      else if (first_is_initial && mutant.weight_of_first_stage > 0)
        EXPECT_THAT(c.failures.front(),
                    ::testing::StartsWith("row " + std::to_string(mutant.weight_of_first_stage) +
                                          " gives weight to u^n twice"));
      else
        expect_violated_condition(changed, c.failures.front());
      try {
        require_claims(c);
        ADD_FAILURE() << "accepted";
      } catch (const claim_error& refused) {
        EXPECT_THAT(refused.what(), ::testing::HasSubstr(c.failures.front()));
      }
    }
}

TEST_P(every_method, survives_export_and_parsing) {
  const method& m = find_method(GetParam());
  const method again = parse_method(to_toml(m), "again.toml");
  EXPECT_EQ(to_toml(again), to_toml(m));
  EXPECT_EQ(again.title, m.title);
  EXPECT_EQ(again.citation, m.citation);
  EXPECT_EQ(again.origin, m.origin);
  EXPECT_EQ(again.purpose, m.purpose);
  EXPECT_EQ(again.claims.ssp_coefficient, m.claims.ssp_coefficient);
  EXPECT_TRUE(same_butcher_form(m, again));
  EXPECT_TRUE(certify(again).claims_hold);
}

std::string name_of(const ::testing::TestParamInfo<std::string>& method_name) {
  std::string name = method_name.param;
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

/// A method with many stages has several hundred mutants, which take about 10 ms each.
std::vector<std::string> methods_with(bool many_stages) {
  return methods_where([&](const method& m) { return (m.stages() > 6) == many_stages; });
}

INSTANTIATE_TEST_SUITE_P(catalogue, every_method, ::testing::ValuesIn(methods_with(false)), name_of);
INSTANTIATE_TEST_SUITE_P(SLOW_catalogue, every_method, ::testing::ValuesIn(methods_with(true)), name_of);

/// A temporary file, removed by the destructor.
class temporary_file {
 public:
  explicit temporary_file(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("apsis-mutant-" + std::to_string(::getpid()) + ".toml")) {
    std::ofstream(path_) << text;
  }
  ~temporary_file() { std::filesystem::remove(path_); }
  temporary_file(const temporary_file&) = delete;
  temporary_file& operator=(const temporary_file&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string refusal(const std::string& text) {
  const temporary_file file(text);
  try {
    load_method_file(file.path());
  } catch (const claim_error& refused) {
    EXPECT_EQ(refused.code(), exit_code::claim);
    return refused.what();
  }
  return "accepted";
}

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const auto at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), replacement);
}

TEST(refusals, name_condition_value_and_tree) {
  const std::string text = catalogue_text("md-imex-3-2");
  ASSERT_FALSE(text.empty());
  {
    const temporary_file file(text);
    EXPECT_NO_THROW(load_method_file(file.path()));
  }
  // With d_1 = 0.6, b·e = 0.6 + 0.5.
  const std::string wrong = refusal(with(text, "d = [\"1/2\"", "d = [\"0.6\""));
  EXPECT_THAT(wrong, ::testing::HasSubstr("tree G is 1.1 instead of 1"));
}

TEST(refusals, reject_wrong_orders_coefficients_and_types) {
  const std::string text = catalogue_text("md-imex-3-2");
  EXPECT_THAT(refusal(with(text, "order = 2", "order = 3")), ::testing::HasSubstr("order 3"));
  EXPECT_THAT(refusal(with(text, "order = 2", "order = 1")), ::testing::HasSubstr("the method has order 2"));
  EXPECT_THAT(refusal(with(text, "ssp_coefficient = \"1\"", "ssp_coefficient = \"1.1\"")),
              ::testing::HasSubstr("gives 1"));
  EXPECT_THAT(refusal(with(text, "ssp_coefficient = \"1\"", "ssp_coefficient = \"unconditional\"")),
              ::testing::HasSubstr("not unconditionally SSP"));
  EXPECT_THAT(refusal(with(text, "type = \"A\"", "type = \"ARS\"")), ::testing::HasSubstr("type A"));
  const std::string third = catalogue_text("md-imex-6-3");
  EXPECT_THAT(refusal(with(third, "ssp_coefficient = \"0.904402174130635\"",
                           "ssp_coefficient = \"0.904402174131635\"")),
              ::testing::HasSubstr("0.9044021741306"));
}

TEST(refusals, reject_a_method_with_a_negative_weight) {
  // The trapezoidal rule uses Q(u^n) explicitly, so it has no form of the paper's class.
  const auto& c = find_certificate("dirk-2-2");
  EXPECT_EQ(c.ssp_coefficient, 0);
  EXPECT_FALSE(c.unconditional);
  EXPECT_THAT(c.limiting_entry, ::testing::HasSubstr("A_2,1 = 0.5"));
  // The radius of absolute monotonicity follows from 1 − r/2 ≥ 0.
  EXPECT_NEAR(c.radius_of_implicit_part.convert_to<double>(), 2.0, 1e-15);
}

}  // namespace
}  // namespace apsis::test::mutations_test
