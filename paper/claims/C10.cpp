#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/stepper.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/square_decay.hpp>

namespace apsis::paper {
namespace C10_claim {
namespace {

using row = std::vector<double>;

/// Returns the largest relative growth of a functional in a step, in units of the admissible rounding. A
/// value ≤ 1 counts as decay.
template <class G>
double growth(const std::string& method, const G& g, const std::function<double(const row&)>& functional,
              double dt, double rounding, row u) {
  newton_problem problem(no_transport{}, g);
  stepper march(find_method(method), problem);
  double worst = 0.0, before = functional(u);
  for (int n = 0; n < 3; ++n) {
    march.step(0.0, dt, u);
    const double after = functional(u);
    worst = maximum(worst, after <= before ? 0.0 : (after / before - 1.0) / rounding);
    before = after;
  }
  return worst;
}

/// Returns the growth of u for G = −c u^p, for which u decays and keeps its sign; infinity if the
/// sign changes.
double power_decay(const std::string& method, random_source& random) {
  const int p = random.integer(1, 6);
  const double c = random.magnitude(-4, 4), dt = random.magnitude(-8, 8);
  const auto g = [=](const auto& u, auto& out) {
    out[0] = -c * u[0];
    for (int k = 1; k < p; ++k) out[0] *= u[0];
  };
  // A decay below the rounding of u is not resolved, because the convex combination of stages is accurate to
  // an ulp or two. Linear decay soon underflows to 0.
  const auto functional = [p](const row& u) {
    return u[0] > 0.0 || (p == 1 && u[0] == 0.0) ? u[0] : std::numeric_limits<double>::infinity();
  };
  return growth(method, g, functional, dt, 1e-15, {random.magnitude(-3, 3)});
}

/// Returns the growth of the Euclidean norm for G(u) = S g(Sᵀu), g_i(w) = −c_i w − e_i w³, S an orthogonal
/// reflection. Forward Euler with a small step, and u − τ²Ġ with Ġ_i = (c_i + e_i w²)(c_i + 3 e_i w²) w_i,
/// both shorten every w_i. They therefore reduce the norm.
double reflected_cubic_decay(const std::string& method, random_source& random) {
  const auto n = static_cast<std::size_t>(random.integer(1, 6));
  row c(n), e(n), u(n), normal(n);
  double square = 0.0, fastest = 1e-3;
  for (std::size_t i = 0; i < n; ++i) {
    c[i] = random.one_in(3) ? 0.0 : random.magnitude(-3, 3);
    e[i] = random.one_in(3) ? 0.0 : random.magnitude(-3, 3);
    u[i] = random.uniform(-5, 5);
    fastest = maximum(fastest, c[i] + 3 * e[i] * 125);  // w² ≤ ‖u‖² ≤ 125
    normal[i] = random.uniform(0.1, 1);
    square += normal[i] * normal[i];
  }
  const auto g = [=](const auto& v, auto& out) {
    const auto at = [&](std::size_t i, std::size_t k) {
      return (i == k ? 1.0 : 0.0) - 2 * normal[i] * normal[k] / square;
    };
    for (std::size_t i = 0; i < n; ++i) out[i] = 0 * v[i];
    for (std::size_t k = 0; k < n; ++k) {
      auto w = 0 * v[0];
      for (std::size_t i = 0; i < n; ++i) w += at(i, k) * v[i];
      const auto slope = -w * (c[k] + e[k] * w * w);
      for (std::size_t i = 0; i < n; ++i) out[i] += at(i, k) * slope;
    }
  };
  const auto norm = [](const row& v) {
    double sum = 0.0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
  };
  // k = Δt · fastest rate. Rounding enters Ġ times k² and returns undamped where G vanishes.
  const double k = random.magnitude(-4, 3);
  return growth(method, g, norm, k / fastest, 1e-14 * (1 + k * k), u);
}

/// Returns the growth of a functional for G(u) = C (mean(u) − u) with C depending on the mean, so that Ġ = −C
/// G. Forward Euler and u − τ²Ġ are averages of permutations of u. Every symmetric convex functional
/// therefore decreases: here Σ_i h(u_i), h the maximum of random affine functions.
double averaging(const std::string& method, random_source& random) {
  constexpr std::size_t pieces = 4;
  row u(static_cast<std::size_t>(random.integer(2, 8))), slope(pieces), offset(pieces);
  for (double& x : u) x = random.uniform(-3, 3);
  for (std::size_t k = 0; k < pieces; ++k) {
    slope[k] = random.uniform(-2, 2);
    offset[k] = random.uniform(-1, 1);
  }
  const double rate = random.magnitude(-3, 1), dt = random.magnitude(-4, 2);
  const auto g = [n = u.size(), rate](const auto& v, auto& out) {
    auto mean = 0 * v[0];
    for (std::size_t i = 0; i < n; ++i) mean += v[i] / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) out[i] = rate * (1 + mean * mean) * (mean - v[i]);
  };
  const auto functional = [=](const row& v) {
    double sum = 0.0;
    for (const double x : v) {
      double h = -std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < pieces; ++k) h = maximum(h, slope[k] * x + offset[k]);
      sum += h + 10;  // so that rounding is relative to it
    }
    return sum;
  };
  // The rounding of mean(u) shifts all components equally and enters Ġ times (Δt C)², C ≤ 10 rate. A general
  // G does not conserve the mean better than that; relaxation_problem does.
  const double rounding = 1e-14 * (1 + std::pow(10 * rate * dt, 2));
  return growth(method, g, functional, dt, rounding, u);
}

claim_result check(const study_control& control) {
  constexpr int samples = 200;
  const std::tuple<const char*, double (*)(const std::string&, random_source&)> fields[] = {
      {"-c u^p, p = 1 … 5: u", power_decay},
      {"reflected cubic decay: Euclidean norm", reflected_cubic_decay},
      {"averaging with rate C(mean): random symmetric convex functional", averaging}};
  claim_result result;
  for (const auto& method : unconditional_methods()) {
    control.check();
    std::vector<std::pair<double, int>> runs;  // step and number of steps
    for (int n = 4; n <= 64; n *= 2) runs.emplace_back(1.0 / n, 2 * n);
    for (double dt = 1e-6; dt <= 1e8; dt *= 10) runs.emplace_back(dt, 20);
    const auto right = std::count_if(runs.begin(), runs.end(), [&](const auto& run) {
      return square_decay(method, run.first, run.second).qualitatively_right();
    });
    result.findings.push_back(
        exactly(fmt::format("{}: positive stages and decay for how many of {} steps from 1e-6 to 1e8", method,
                            runs.size()),
                right, static_cast<long>(runs.size())));
    random_source random(1);
    for (const auto& [what, sample] : fields) {
      double worst = 0.0;
      for (int k = 0; k < samples; ++k) worst = maximum(worst, sample(method, random));
      result.findings.push_back(
          at_most(fmt::format("{}, {} random G = {}: largest growth in units of the admissible rounding",
                              method, samples, what),
                  worst, 1.0));
    }
  }
  random_source random(1);
  double worst = 0.0;
  for (int k = 0; k < samples; ++k) worst = maximum(worst, averaging("dirk-2-2", random));
  result.findings.push_back(
      at_least("the last of these with dirk-2-2, for contrast: largest growth", worst, 1e6));
  return result;
}

}  // namespace
}  // namespace C10_claim

extern const claim_entry claim_C10;
const claim_entry claim_C10 = {
    .id = "C10",
    .section = "Numerical results, the implicit methods on u' = -10 u^2; theorem on implicit methods",
    .statement = "the implicit methods keep u' = -10 u^2, u(0) = 10 positive for every step",
    .how =
        "positivity of every stage and step; beyond the paper: random dissipative G with random convex "
        "functionals, for every unconditionally SSP implicit method of the catalogue",
    .check = C10_claim::check};

}  // namespace apsis::paper
