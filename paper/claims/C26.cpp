#include <apsis/core/extremes.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/certificate.hpp>

#include <array>
#include <cmath>

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/square_decay.hpp>

namespace apsis::paper {
namespace C26_claim {
namespace {

constexpr const char* name = "imdrk-9-5";
constexpr long double modulus = 0.8L, end = 4.0L;

/// Returns the maximum error at t = 4, in long double, for the free rigid body. Its equation is y' = (y₂y₃,
/// −y₁y₃, −k²y₁y₂), y(0) = (0, 1, 1), with the solution y = (sn, cn, dn)(t, k). In this system no two trees
/// have the same differential.
double rigid_body_error(long steps) {
  const auto body = [](const auto& y, auto& out) {
    out[0] = y[1] * y[2];
    out[1] = -y[0] * y[2];
    out[2] = -modulus * modulus * y[0] * y[1];
  };
  auto problem = make_newton_problem<std::vector<long double>>(no_transport{}, body);
  stepper march(find_method(name), problem);
  std::vector<long double> y{0, 1, 1};
  integrate(march, y, 0.0L, end, step_rule<long double>::fixed(end / static_cast<long double>(steps)));
  long double cn = 0, dn = 0;
  const long double sn = boost::math::jacobi_elliptic(modulus, end, &cn, &dn);
  const auto miss = [](long double a, long double b) { return static_cast<double>(std::abs(a - b)); };
  return maximum({miss(y[0], sn), miss(y[1], cn), miss(y[2], dn)});
}

struct problem_of_order {
  const char* what;
  double (*error)(long);
  int coarsest;  ///< k of 2^k steps
};
constexpr problem_of_order problems[] = {
    {"free rigid body, t = 4", rigid_body_error, 3},
    {"u' = −10u², t = 2", [](long n) { return square_decay_error(name, n); }, 7}};
constexpr std::size_t levels = 6;

claim_result check(const study_control& control) {
  const certificate& c = find_certificate(name);
  claim_result result;
  result.findings = {
      exactly("order from rooted trees", c.order, 5), exactly("conditions", c.conditions, 17),
      at_most("largest residual of the order conditions", static_cast<double>(c.order_residual), 1e-38),
      is_true("unconditionally SSP: R e ≥ 0, P ≥ 0, D ≥ 0, Ḋ ≤ 0", c.unconditional),
      exactly("stages", static_cast<long>(find_method(name).stages()), 9)};

  std::array<std::array<double, levels>, std::size(problems)> errors{};
  run_all(control, "order of imdrk-9-5", static_cast<int>(std::size(problems) * levels), [&](int job) {
    const auto p = static_cast<std::size_t>(job) / levels, k = static_cast<std::size_t>(job) % levels;
    errors[p][k] = problems[p].error(1L << (problems[p].coarsest + static_cast<int>(k)));
  });
  panel plot{"", "steps", "error (dimensionless)", true, true, {}, {}, {-5.0}};
  for (std::size_t p = 0; p < std::size(problems); ++p) {
    report_table table{fmt::format("{}: {}", name, problems[p].what), {"steps", "error", "order"}, {}};
    curve drawn{problems[p].what, {}, {}};
    for (std::size_t k = 0; k < levels; ++k) {
      const long steps = 1L << (problems[p].coarsest + static_cast<int>(k));
      table.rows.push_back({fmt::format("{}", steps), fmt::format("{:.3e}", errors[p][k]),
                            k > 0 ? fmt::format("{:.3f}", std::log2(errors[p][k - 1] / errors[p][k])) : ""});
      drawn.x.push_back(static_cast<double>(steps));
      drawn.y.push_back(errors[p][k]);
    }
    plot.curves.push_back(std::move(drawn));
    result.tables.push_back(std::move(table));
    result.findings.push_back(close_to(fmt::format("observed order, {}, last halving", problems[p].what),
                                       std::log2(errors[p][levels - 2] / errors[p][levels - 1]), 5.0, 0.15));
  }
  result.pictures.push_back({"C26-order",
                             "a fifth-order unconditionally SSP implicit method",
                             "Errors of imdrk-9-5 fall with the fifth power of the step.",
                             {std::move(plot)}});
  result.remarks = {
      "This method supersedes the statement of the paper that none was found; its file states how it was "
      "found. Whether fewer than nine stages suffice is open."};
  return result;
}

}  // namespace
}  // namespace C26_claim

extern const claim_entry claim_C26;
const claim_entry claim_C26 = {
    .id = "C26",
    .section = "New implicit methods, orders above four",
    .statement =
        "a fifth-order unconditionally SSP implicit two-derivative method exists (the paper found none)",
    .how = "certificate of imdrk-9-5, observed order through the production stepper in long double",
    .check = C26_claim::check};

}  // namespace apsis::paper
