#include <apsis/core/extremes.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/method/tableau.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <paper/claim.hpp>

namespace apsis::paper {
namespace C25_claim {
namespace {

/// Returns k_s from k_1 = 1/4, k_i = 1/(4(1 − k_{i−1})), which is s/(2(s+1)).
double bound(std::size_t stages) {
  double k = 0.25;
  for (std::size_t i = 1; i < stages; ++i) k = 1.0 / (4.0 * (1.0 - k));
  return k;
}

/// Returns an implicit method of s stages whose coefficients are all 0.
shu_osher_form<double> zero_form(std::size_t s) {
  return {matrix<double>(s, s), matrix<double>(s, s), matrix<double>(s, s), std::vector<double>(s, 0.0), 1.0};
}

/// b·e, b·c and ḃ·e.
struct sums {
  double be, bc, derivative;
};

sums sums_of(const shu_osher_form<double>& m) {
  const auto butcher = to_butcher(m);
  const std::vector<double> e(m.stages(), 1.0);
  const auto c = butcher.A * e;
  return {c.back(), (butcher.A * c).back(), (butcher.A_dot * e).back()};
}

/// Returns a method with P, D, Ḋ ≥ 0 and R e ≥ 0. Its coefficients are squares of free parameters, so that
/// the signs hold. They are s(s−1)/2 weights and one of u^n per row, scaled to sum to 1, then D, then Ḋ.
shu_osher_form<double> form_of(std::size_t s, const std::vector<double>& parameters) {
  auto m = zero_form(s);
  std::size_t next = 0;
  const auto take = [&] {
    const double x = parameters[next++];
    return x * x;
  };
  for (std::size_t i = 0; i < s; ++i) {
    double sum = 1e-300 + take();
    for (std::size_t j = 0; j < i; ++j) sum += m.P(i, j) = take();
    for (std::size_t j = 0; j < i; ++j) m.P(i, j) /= sum;
  }
  for (std::size_t i = 0; i < s; ++i) m.D(i, i) = take();
  for (std::size_t i = 0; i < s; ++i) m.ddot[i] = take();
  return m;
}

std::size_t parameter_count(std::size_t s) {
  return s * (s + 1) / 2 + 2 * s;
}

/// Returns the largest value of a random search with several starts. It takes steps of adapted length from
/// the best point so far.
double maximize_at_random(std::size_t s, random_source& random,
                          const std::function<double(const shu_osher_form<double>&)>& value) {
  double best = -1e300;
  for (int start = 0; start < 4; ++start) {
    std::vector<double> here(parameter_count(s));
    for (double& x : here) x = random.uniform(0, 1);
    double height = value(form_of(s, here)), length = 0.3;
    for (int n = 0; n < 6000; ++n) {
      auto there = here;
      for (double& x : there)
        if (random.one_in(3)) x += length * random.uniform(-1, 1);
      const double found = value(form_of(s, there));
      // The length remains constant if about one step in five succeeds.
      length = std::clamp(length * (found > height ? 1.5 : 0.9), 1e-9, 1.0);
      if (found > height) {
        height = found;
        here = there;
      }
    }
    best = maximum(best, height);
  }
  return best;
}

/// Returns b·e − b·c.
double difference(const shu_osher_form<double>& m) {
  const auto sum = sums_of(m);
  return sum.be - sum.bc;
}

/// Returns b·e − b·c in the time scale that maximizes it: D → τD gives τ b·e − τ² b·c.
double largest_difference(const shu_osher_form<double>& m) {
  const auto sum = sums_of(m);
  return sum.bc > 0.0 ? sum.be * sum.be / (4.0 * sum.bc) : 0.0;
}

/// Returns the negative residual of order two, −(b·c + ḃ·e − ½), in the time scale in which b·e = 1.
double order_two_residual(const shu_osher_form<double>& m) {
  const auto sum = sums_of(m);
  if (!(sum.be > 0.0)) return -1e300;
  return -(sum.bc / (sum.be * sum.be) + sum.derivative / (sum.be * sum.be) - 0.5);
}

double largest_over_random_tableaux(int samples) {
  random_source random(25);
  double worst = 0.0;
  for (int k = 0; k < samples; ++k) {
    const auto s = static_cast<std::size_t>(random.integer(1, 11));
    std::vector<double> parameters(parameter_count(s));
    const double scale = random.magnitude(-1.5, 0.5);
    for (double& x : parameters) x = random.one_in(3) ? 0.0 : scale * random.uniform();
    worst = maximum(worst, difference(form_of(s, parameters)) / bound(s));
  }
  return worst;
}

/// Returns the method of s backward Euler steps of 1/(s + 1).
shu_osher_form<double> backward_euler_steps(std::size_t s) {
  auto m = zero_form(s);
  for (std::size_t i = 0; i < s; ++i) {
    if (i > 0) m.P(i, i - 1) = 1.0;
    m.D(i, i) = 1.0 / static_cast<double>(s + 1);
  }
  return m;
}

/// Adds the results for s = 1, 2, …, compared with the bounds.
void add_searches(const std::vector<double>& reached, const std::vector<double>& residual,
                  claim_result& result) {
  report_table table{
      "implicit two-derivative methods with nonnegative coefficients of the derivative",
      {"s", "k_s", "largest b·e − b·c found", "s steps of 1/(s+1)", "smallest residual found", "1/(2s)"},
      {}};
  double above = 0.0, least_reached = 1.0, least_residual = 1e300, extremal = 0.0, nearest = 1.0;
  for (std::size_t s = 1; s <= reached.size(); ++s) {
    const double k = bound(s), half = 0.5 / static_cast<double>(s),
                 steps = difference(backward_euler_steps(s));
    extremal = maximum(extremal, std::abs(steps / k - 1.0));
    above = maximum(above, reached[s - 1] / k);
    least_reached = minimum(least_reached, reached[s - 1] / k);
    least_residual = minimum(least_residual, residual[s - 1] / half);
    nearest = maximum(nearest, residual[s - 1] / half);
    auto& row = table.rows.emplace_back();
    row.push_back(std::to_string(s));
    for (const double x : {k, reached[s - 1], steps, residual[s - 1], half})
      row.push_back(fmt::format("{:.6f}", x));
  }
  result.tables.push_back(std::move(table));
  // One rounding per term of sums of at most 21 terms.
  result.findings.insert(
      result.findings.end(),
      {at_most("largest (b·e − b·c)/k_s that a search finds, s ≤ 6", above, 1.0 + 1e-14),
       at_least("relative distance of the search from k_s, worst s", least_reached, 0.999),
       at_most("s backward Euler steps of 1/(s+1) reach k_s, relative distance", extremal, 1e-14),
       at_least("smallest residual of order two that a search with ḋ ≥ 0 finds, over 1/(2s), s ≤ 6",
                least_residual, 1.0 - 1e-14),
       at_most("relative distance of the search from 1/(2s), worst s", nearest, 1.001)});
}

claim_result check(const study_control& control) {
  constexpr int samples = 20000;
  constexpr std::size_t largest = 6;
  claim_result result;
  result.findings = {
      at_most(
          fmt::format("largest (b·e − b·c)/k_s of {} random tableaux with P, D, R e ≥ 0, s ≤ 10", samples),
          largest_over_random_tableaux(samples), 1.0),
      at_most("k_s < 1/2: k_100", bound(100), 0.5 * (1.0 - 1e-3))};
  std::vector<double> reached(largest), residual(largest);
  run_all(control, "search for second order", static_cast<int>(2 * largest), [&](int job) {
    const auto s = static_cast<std::size_t>(job) / 2 + 1;
    random_source random(static_cast<std::uint64_t>(100 + job));
    if (job % 2 == 0) {
      reached[s - 1] = maximize_at_random(s, random, largest_difference);
    } else {
      residual[s - 1] = -maximize_at_random(s, random, order_two_residual);
    }
  });
  add_searches(reached, residual, result);
  result.remarks = {
      "Beyond the paper: with b·e = 1 its inequality for every a, x − k_s x² ≤ b·c with x = 1 − a, gives b·c "
      "≥ 1/(4 k_s) = 1/2 + 1/(2s). The residual of order two is at least 1/(2s); s backward Euler steps of "
      "1/s attain it.",
      "Where the proof states that a term 'obtains a minimum', it is a maximum, and the preceding inequality "
      "is not strict; the conclusion holds."};
  return result;
}

}  // namespace
}  // namespace C25_claim

extern const claim_entry claim_C25;
const claim_entry claim_C25 = {
    .id = "C25",
    .section = "Appendix: unconditionally SSP implicit methods",
    .statement =
        "with nonnegative coefficients of the derivative no method of the class has order two, because b·e − "
        "b·c "
        "≤ k_s < 1/2",
    .how =
        "random nonnegative tableaux; random searches for the largest difference and the smallest residual",
    .check = C25_claim::check};

}  // namespace apsis::paper
