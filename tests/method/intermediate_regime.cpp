// O(ε) terms from coefficients alone. tests/integrate compares them with the stepper.
#include <apsis/method/intermediate_regime.hpp>

#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/plateau.hpp>
#include <apsis/method/polish.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace apsis::intermediate_regime_test {
namespace {

intermediate_regime<mp_real> of(const std::string& name) {
  return analyse_intermediate_regime(find_method(name).coefficients<mp_real>());
}

TEST(intermediate_regime, flux_of_the_papers_second_order_method_is_zero) {
  const auto terms = of("md-imex-3-2");  // by hand: χ = (0, 0, ½/½), b̂ = (½, ½, 0), λ = (1/½, 0, 0)
  ASSERT_TRUE(terms.applies);
  EXPECT_EQ(terms.flux, 0);
  EXPECT_EQ(terms.last, 1);
  EXPECT_EQ(terms.layer, 1);
}

TEST(intermediate_regime, flux_of_the_papers_third_order_method_is_too_large) {
  const auto terms = of("md-imex-6-3");
  ASSERT_TRUE(terms.applies);
  // By hand from the printed coefficients, χ₃ = w₃₁/(r d₃), χ₄ = w₄₃/(r d₄), and b̂ is the last
  // row of R⁻¹W/r.
  const double r = 0.904402174130635;
  EXPECT_NEAR(terms.kept[2].convert_to<double>(), 0.764266518291495 / (r * 0.388820513661584), 1e-12);
  EXPECT_NEAR(terms.kept[3].convert_to<double>(), 0.292520982667463 / (r * 0.083529464436389), 1e-12);
  const double b4 = 0.448630511341543 / r + 0.331204417210324 * 0.281050180194829 / r;
  const double b3 = (0.448630511341543 + 0.331204417210324 * 0.281050180194829) * 0.292520982667463 / r;
  EXPECT_NEAR(terms.flux.convert_to<double>(),
              b3 * terms.kept[2].convert_to<double>() + b4 * terms.kept[3].convert_to<double>(), 1e-12);
  EXPECT_EQ(terms.last, 0);
  EXPECT_NEAR(terms.layer.convert_to<double>(), b4 * 0.583517183806433 / 0.083529464436389, 1e-12);
}

TEST(intermediate_regime, is_exact_for_methods_designed_for_it) {
  for (const std::string name : {"md-imex-4-2", "md-imex-5-2", "md-imex-8-3"}) {
    const auto terms = of(name);
    ASSERT_TRUE(terms.applies) << name;
    EXPECT_LT(abs(terms.flux - 1), mp_real(1e-42)) << name;
    EXPECT_LT(abs(terms.last - 1), mp_real(1e-42)) << name;
  }
  EXPECT_LT(abs(of("md-imex-5-2").layer - 1), mp_real(1e-55));
  EXPECT_LT(abs(of("md-imex-8-3").layer - 1), mp_real(1e-42));
  EXPECT_GT(abs(of("md-imex-4-2").layer - 1), mp_real(1));
}

TEST(intermediate_regime, with_u_n_as_a_stage_is_exact_for_consistent_data_only) {
  const auto terms = of("forward-backward-euler");
  ASSERT_TRUE(terms.applies);
  EXPECT_EQ(terms.flux, 1);
  EXPECT_EQ(terms.last, 1);
  EXPECT_TRUE(isinf(terms.layer));
}

TEST(intermediate_regime, does_not_apply_if_a_stage_is_explicit) {
  for (const std::string name : {"ssprk-3-3", "ssp2-222"}) EXPECT_FALSE(of(name).applies) << name;
}

TEST(intermediate_regime, includes_the_terms_of_next_order) {
  // md-imex-5-2 by hand. T contributes at stages 1, 3, 4 with weights 1/3 and ĉ = 0, 1/2, 1. χ = (0, 0, 3, 0,
  // 1). RÂĉ is (1/2) ĉ of the previous stage, so (0, 0, 0, 1/4, 1/3·…). χ′ is 0 except for χ′_5. Rĉ²/2 is 1/8
  // at stage 3, and χ″_3 = (1/8)/(1/6).
  const auto terms = of("md-imex-5-2");
  const auto expect = [](const mp_real& value, double wanted) {
    EXPECT_NEAR(value.convert_to<double>(), wanted, 1e-15);
  };
  expect(terms.flux_place, 0.5);
  expect(terms.flux_slope, 0.0);
  expect(terms.flux_curvature, 0.25);
  expect(terms.flux_carried, 0.5);
  expect(terms.last_slope, 1.0);
  expect(terms.last_curvature, 0.5);
  expect(terms.layer_place, 0.0);
  expect(terms.layer_carried, 1.0);
}

TEST(intermediate_regime, is_the_limit_of_the_band_and_vanishes_with_the_order) {
  for (const auto& name : method_names()) {
    const auto& m = find_method(name);
    const auto form = m.coefficients<mp_real>();
    const auto terms = analyse_intermediate_regime(form);
    if (m.kind != method_kind::imex || !terms.applies) continue;
    const auto b = to_butcher(form);
    const auto stiff = at_finite_rate(b, mp_real(1e21)), soft = at_finite_rate(b, mp_real(1e-6)),
               softer = at_finite_rate(b, mp_real(1e-7));
    EXPECT_LT(abs(stiff.flux - terms.flux), mp_real(1e-15)) << name;
    EXPECT_LT(abs(stiff.last - terms.last), mp_real(1e-15)) << name;
    // The flux error has the order of the method, flux(z) − 1 = O(z^p).
    const int order = m.claims.order;
    EXPECT_LT(abs(soft.flux - 1), 20 * pow(mp_real(1e-6), order)) << name;
    EXPECT_LT(abs(softer.flux - 1), 20 * pow(mp_real(1e-7), order)) << name;
  }
}

TEST(intermediate_claims, of_the_catalogue_are_certified) {
  EXPECT_EQ(find_certificate("md-imex-3-2").remaining_terms(), "none");
  EXPECT_EQ(find_certificate("md-imex-4-2").remaining_terms(), "slow");
  EXPECT_EQ(find_certificate("ars-222").remaining_terms(), "slow");
  EXPECT_EQ(find_certificate("md-imex-5-2").remaining_terms(), "all");
  EXPECT_EQ(find_certificate("md-imex-8-3").remaining_terms(), "all");
  EXPECT_FALSE(find_certificate("ssp2-222").regime.applies);
  // An independent program computed the largest errors in the band with 30 digits.
  EXPECT_NEAR(find_certificate("md-imex-3-2").band.error, 0.20125, 1e-4);
  EXPECT_NEAR(find_certificate("md-imex-5-2").band.error, 0.01806, 1e-4);
  EXPECT_NEAR(find_certificate("md-imex-5-2").band.at, 4.47, 0.3);
}

TEST(intermediate_band, is_the_maximum_over_ten_thousand_samples) {
  for (const auto& name : method_names()) {
    const auto& m = find_method(name);
    if (m.kind != method_kind::imex) continue;
    const auto b = to_butcher(m.coefficients<long double>());
    long double largest = 0;
    for (int k = -5000; k <= 5000; ++k) {  // 0.05 < z < 20, the range of all maxima
      const long double z = std::exp(3 * static_cast<long double>(k) / 5000);
      largest = std::max(largest, std::abs(at_finite_rate(b, z).flux - 1) / z);
    }
    // Samples are at most 3e-4 in log z away from a maximum. They miss 4.5e-8 times its relative curvature.
    // The curvature is 2 for wide bands and 7 for narrow ones, whose errors oscillate. The tolerance 1e-6
    // allows 20. Methods without a band have rounding errors, 1e-12.
    EXPECT_NEAR(find_certificate(name).band.error, static_cast<double>(largest),
                1e-6 * static_cast<double>(largest) + 1e-12)
        << name;
  }
  EXPECT_NEAR(find_certificate("md-imex-6-2-mixed").band.error, 0.002436, 5e-7);
}

std::vector<std::string> failures_with(const std::string& name, const std::string& claim,
                                       const std::string& old = "", const std::string& replacement = "") {
  std::string text = to_toml(find_method(name));
  const auto change = [&text](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  if (const auto at = text.find("intermediate = "); at != std::string::npos)
    text.erase(at, text.find('\n', at) + 1 - at);
  change("[claims]\n", "[claims]\nintermediate = \"" + claim + "\"\n");
  if (!old.empty()) change(old, replacement);
  return certify(parse_method(text, "m.toml")).failures;
}

TEST(plateau_bounds, are_infinite_where_the_stage_equations_have_no_solution) {
  // One stage with u = u^n − Δt Q(u): 1 + zA = 0 at z = 1/|A|, which is one of the samples.
  const auto bounds_of = [](double diagonal) {
    butcher_form<double> b{matrix<double>(1, 1), matrix<double>(1, 1), matrix<double>(1, 1)};
    b.A(0, 0) = diagonal;
    return compute_plateau_bounds(b);
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // At z = 1 inside the range; elsewhere û = u^n without transport has flux = last = 0.
  const auto inside = bounds_of(-1.0);
  EXPECT_EQ(inside.last_band, infinity);
  EXPECT_EQ(inside.flux_band, infinity);
  EXPECT_EQ(inside.last, 1.0);
  EXPECT_EQ(inside.flux, 1.0);
  // At the end, z = 10⁵.
  const auto at_end = bounds_of(-1e-5);
  EXPECT_EQ(at_end.last, infinity);
  EXPECT_EQ(at_end.flux, infinity);
  EXPECT_EQ(at_end.last_band, infinity);
  EXPECT_EQ(at_end.flux_band, infinity);
  const auto solvable = bounds_of(1.0);
  EXPECT_LT(solvable.last_band, infinity);
  EXPECT_LT(solvable.flux_band, infinity);
}

TEST(intermediate_claims, that_do_not_hold_are_rejected) {
  using ::testing::Contains, ::testing::HasSubstr, ::testing::IsEmpty;
  EXPECT_THAT(failures_with("md-imex-5-2", "slow"), IsEmpty());  // claims less than holds
  EXPECT_THAT(failures_with("ars-222", "slow"), IsEmpty());
  EXPECT_THAT(failures_with("md-imex-3-2", "slow"), Contains(HasSubstr("claims.intermediate = slow but the "
                                                                       "O(epsilon) terms are flux 0")));
  EXPECT_THAT(failures_with("md-imex-4-2", "all"), Contains(HasSubstr("layer 2.16")));
  EXPECT_THAT(failures_with("ars-222", "all"), Contains(HasSubstr("claims.intermediate = all")));
  EXPECT_THAT(failures_with("ssp2-222", "slow"), Contains(HasSubstr("neither relaxed nor u^n")));
  // A change of d_3 = 1/6 by 1e-6 changes the flux by 6e-6.
  EXPECT_THAT(failures_with("md-imex-5-2", "slow", "1/6", "0.166667666666666666666666666667"),
              Contains(HasSubstr("claims.intermediate = slow but the O(epsilon) terms are flux 0.99999")));
  bad_input::expect_refused({{[&] { failures_with("md-imex-5-2", "slwo"); }, {"did you mean 'slow'?"}}});
}

// Four digits from a search suffice for Newton's method to find the other forty. Trailing zeros mark the
// numbers as inexact.
const std::string four_digits = test::method_text("md-imex-4-2", "imex", 2, R"([shu_osher]
r = "1.511000000000"
P = [[], ["0"], ["0", "0"], ["0.373200000000", "0", "0"]]
W = [[], ["0.410600000000"], ["0", "1"], ["0", "0", "0.626800000000"]]
d = ["0.703900000000", "0.112700000000", "0.112700000000", "0.414800000000"]
ddot = ["-0.078300000000", "0", "-0.387100000000", "0"]
)");

TEST(polishing, with_conditions_of_the_intermediate_regime_recovers_the_catalogue_method) {
  const auto keeps_flux = [](const shu_osher_form<mp_real>& m) {
    const auto terms = analyse_intermediate_regime(m);
    return std::vector<mp_real>{terms.flux - 1, terms.last - 1};
  };
  const auto polished = polish(parse_method(four_digits, "four digits"), 45, keeps_flux).polished;
  // Eight conditions leave one of nine coefficients free. The result is therefore as close to the method of
  // the file as four digits allow.
  const auto m = polished.coefficients<mp_real>(), file = find_method("md-imex-4-2").coefficients<mp_real>();
  EXPECT_LT(abs(m.r - file.r), mp_real(1e-3));
  EXPECT_LT(abs(analyse_intermediate_regime(m).flux - 1), mp_real(1e-42));
  EXPECT_EQ(certify(polished).order, 2);
  // Polishing the file itself changes nothing.
  const auto again = polish(find_method("md-imex-4-2"), 45, keeps_flux);
  EXPECT_LT(again.largest_move, mp_real(1e-42));
  EXPECT_LT(again.residual, mp_real(1e-50));
}

}  // namespace
}  // namespace apsis::intermediate_regime_test
