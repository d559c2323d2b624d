// Kernels and their formulas on single numbers have the same bits in every instruction set, at every point.
// Sums have one chain of additions per lane. The reference adds in the same chains.
#include "drawn_velocity.hpp"

#include <apsis/core/random_source.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/model/formula_rows.hpp>
#include <apsis/model/formulas/arithmetic.hpp>
#include <apsis/model/formulas/grid_sums.hpp>
#include <apsis/model/formulas/line.hpp>
#include <apsis/model/formulas/relaxation.hpp>
#include <apsis/model/formulas/target.hpp>
#include <apsis/model/formulas/target_moments.hpp>
#include <apsis/model/formulas/velocity.hpp>
#include <apsis/model/grid_sums.hpp>
#include <apsis/model/line_powers.hpp>
#include <apsis/model/line_sums.hpp>
#include <apsis/model/relaxation_rows.hpp>
#include <apsis/model/target_rows.hpp>
#include <apsis/model/vector_math.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace model_formulas_test {

namespace {

using apsis::random_source;
namespace scalar = apsis::scalar;

}  // namespace

TEST(formulas, exponential_and_logarithm_are_accurate_to_two_units_in_the_last_place) {
  check_property("exp and log", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    for (int i = 0; i < 100; ++i) {
      const double x = random.one_in(3) ? random.uniform(-1.0, 1.0) : random.uniform(-700.0, 700.0);
      const double y = random.one_in(3) ? random.uniform(0.5, 2.0) : random.magnitude(-307.0, 308.0);
      const long double e = std::exp(static_cast<long double>(x)), l = std::log(static_cast<long double>(y));
      // Without a fused product the rounding error of the reduced argument is larger.
      RC_ASSERT(std::abs(scalar::exp_of(x) - e) <= 2.3e-16L * e);
      RC_ASSERT(std::abs(value_of(scalar::exp_of(unfused(x))) - e) <= 4.5e-16L * e);
      const double small = random.uniform(-scalar::small_exponent, scalar::small_exponent);
      const long double of_small = std::exp(static_cast<long double>(small));
      RC_ASSERT(std::abs(scalar::exp_of_small(small) - of_small) <= 2.3e-16L * of_small);
      RC_ASSERT(std::abs(value_of(scalar::exp_of_small(unfused(small))) - of_small) <= 2.3e-16L * of_small);
      RC_ASSERT(std::abs(scalar::log_of(y) - l) <= 2.3e-16L * std::abs(l));
      RC_ASSERT(std::abs(value_of(scalar::log_of(unfused(y))) - l) <= 4.5e-16L * std::abs(l));
    }
  });
  EXPECT_EQ(scalar::exp_of(0.0), 1.0);
  EXPECT_EQ(scalar::exp_of(-1001.0), 0.0);
  EXPECT_EQ(scalar::exp_of(std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(scalar::exp_of(800.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(scalar::log_of(1.0), 0.0);
}

TEST(formulas, relaxations_are_those_of_single_numbers) {
  check_property("relaxation", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    std::vector<std::vector<double>> row;
    for (int i = 0; i < 10; ++i) row.push_back(drawn(n, random, any_size));
    const double share = random.uniform(0.0, 0.5);
    std::vector<apsis::relaxation::weighted_rows> points;
    for (std::size_t p = 0; p < 5; ++p)
      points.push_back({0.2, 0.2 * random.uniform(0.0, 0.5), row[2 * p].data(), row[2 * p + 1].data()});
    const auto width = static_cast<int>(n);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      auto u = row[0], v = row[0];
      std::vector<double> mean3(n), mean5(n), q(n);
      apsis::relaxation::combine(1.0 - share, share, row[1].data(), width, u.data());
      apsis::relaxation::combine(share, 1.0 - share, row[1].data(), width, v.data());
      apsis::relaxation::mean({points.data(), 3}, width, mean3.data());
      apsis::relaxation::mean(points, width, mean5.data());
      apsis::relaxation::change(1e6, row[1].data(), row[0].data(), width, q.data());
      for (std::size_t k = 0; k < n; ++k) {
        const N here(row[0][k]), there(row[1][k]);
        RC_ASSERT(same_bits(u[k], value_of(scalar::moved_towards(here, N(share), there))));
        RC_ASSERT(same_bits(v[k], value_of(scalar::moved_towards(there, N(share), here))));
        RC_ASSERT(same_bits(q[k], value_of(scalar::relaxation_rate(N(1e6), there, here))));
        N sum(0.0);
        for (std::size_t p = 0; p < 5; ++p) {
          const auto& of = points[p];
          sum = scalar::with_part(sum, N(of.weight), N(of.base[k]), N(of.share), N(of.other[k]));
          if (p == 2) {
            RC_ASSERT(same_bits(mean3[k], value_of(sum)));
          }
        }
        RC_ASSERT(same_bits(mean5[k], value_of(sum)));
      }
    });
  });
}

namespace {

/// Lines of a row in d directions, with arbitrary velocities.
struct drawn_lines {
  std::vector<double> v, across[2];
  apsis::target_rows::lines_of_row of;

  drawn_lines(int d, int n, int count, random_source& random)
      : v(drawn(static_cast<std::size_t>(n), random, any_velocity)) {
    std::sort(v.begin(), v.end());
    of = {d, 2, {0, 1}, n, count, v.data(), {}, any_velocity(random), {}};
    for (int k = 0; k < 2; ++k) {
      across[k] = drawn(static_cast<std::size_t>(count), random, any_velocity);
      of.v_across[k] = across[k].data();
      of.u_across[k] = any_velocity(random);
    }
  }

  template <int D, class N>
  scalar::cubic_polynomial<N> polynomial(const apsis::target_polynomial& p, int line) const {
    const auto at = static_cast<std::size_t>(line);
    const N c[2] = {N(across[0][at]) - N(of.u_across[0]), N(across[1][at]) - N(of.u_across[1])};
    return p.is_quadratic() ? scalar::polynomial_on_line<D, false>(p, of.across, of.last, c)
                            : scalar::polynomial_on_line<D, true>(p, of.across, of.last, c);
  }
  template <class N>
  scalar::cubic_polynomial<N> polynomial(const apsis::target_polynomial& p, int line) const {
    return of.dimensions == 1   ? polynomial<1, N>(p, line)
           : of.dimensions == 2 ? polynomial<2, N>(p, line)
                                : polynomial<3, N>(p, line);
  }
};

apsis::target_polynomial drawn_polynomial(bool cubic, random_source& random) {
  apsis::target_polynomial p;
  p.k = random.uniform(-1, 1);
  for (int k = 0; k < 3; ++k) {
    p.l[k] = random.uniform(-1, 1);
    if (cubic) p.w[k] = random.uniform(-1, 1);
    for (int l = 0; l <= k; ++l) p.a[k][l] = p.a[l][k] = random.uniform(-1, 1);
  }
  return p;
}

}  // namespace

TEST(formulas, weighed_targets_are_those_of_single_numbers) {
  check_property("targets", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const int n = *rc::gen::inRange(1, 40), count = *rc::gen::inRange(1, 20);
    const drawn_lines lines(*rc::gen::inRange(1, 4), n, count, random);
    const auto p = drawn_polynomial(*rc::gen::arbitrary<bool>(), random);
    const auto size = static_cast<std::size_t>(lines.of.size());
    const auto m = drawn(size, random, any_size);
    auto f = drawn(size, random, any_size);
    // Bounds of signed data may be positive.
    if (*rc::gen::arbitrary<bool>())
      f[static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(size)))] *= -1.0;
    for (const double keep : {std::numeric_limits<double>::infinity(), 0.0, 0.3})
      for_each_number([&](auto number, int) {
        using N = decltype(number);
        std::vector<double> e(size), in_place = m;
        const bool raised = apsis::target_rows::weigh(m.data(), p, lines.of, f.data(), keep, e.data());
        apsis::target_rows::weigh(in_place.data(), p, lines.of, f.data(), keep, in_place.data());
        bool of_any = false;
        for (std::size_t at = 0; at < size; ++at) {
          const auto k = at % static_cast<std::size_t>(n);
          const auto cubic = lines.polynomial<N>(p, static_cast<int>(at) / n);
          N value = N(m[at]) * cubic(N(lines.v[k]) - N(lines.of.u));
          if (std::isfinite(keep)) of_any |= scalar::raise(value, N(keep), N(f[at]));
          RC_ASSERT(same_bits(e[at], value_of(value)));
          RC_ASSERT(same_bits(in_place[at], e[at]));
        }
        RC_ASSERT(raised == of_any);
      });
  });
}

namespace {

/// Number of chains of additions in grid_sums. Point j is in chain j mod 8.
constexpr std::size_t chains = 8;

/// Returns Σ a_l f_l in chains of at most 16 lines, which are added as halves of halves.
template <class N>
N sum_over_lines(const double* f, std::size_t apart, const double* a, std::size_t lines) {
  if (lines > 16) {
    const std::size_t half = lines / 2;
    return sum_over_lines<N>(f, apart, a, half) +
           sum_over_lines<N>(f + half * apart, apart, a + half, lines - half);
  }
  N sum(0.0);
  for (std::size_t l = 0; l < lines; ++l) sum = fma(N(a[l]), N(f[l * apart]), sum);
  return sum;
}

}  // namespace

namespace {

/// Compares powers of the sums over lines of one function with formulas on single numbers, chain by chain.
template <class Powers, class N>
void expect_powers(const Powers& sums, const std::vector<N>& of_columns, const std::vector<N>& c,
                   double factor) {
  using formula = std::conditional_t<std::tuple_size_v<Powers> == 4, scalar::sums_of_powers<N>,
                                     scalar::sums_of_six_powers<N>>;
  std::vector<formula> of(chains);
  for (std::size_t j = 0; j < c.size(); ++j) of[j % chains].add(of_columns[j], c[j]);
  for (std::size_t p = 0; p < sums.size(); ++p) {
    std::vector<N> parts;
    for (const auto& chain : of) parts.push_back(chain.of[p]);
    RC_ASSERT(same_bits(sums[p], factor * sum_of_lanes(parts)));
  }
}

}  // namespace

TEST(formulas, sums_over_a_grid_are_those_of_single_numbers) {
  check_property("grid sums", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40)),
               lines = static_cast<std::size_t>(*rc::gen::inRange(1, 70)),
               functions = *rc::gen::inRange<std::size_t>(1, apsis::grid_sums::most_functions + 1);
    const auto f = drawn(n * lines, random, any_size), v = drawn(n, random, any_velocity),
               w = drawn(n, random, any_size), a = drawn(functions * lines, random, any_velocity);
    const double u = any_velocity(random);
    const bool weighted = random.one_in(2);
    const apsis::grid_sums::axis last{static_cast<int>(n), v.data(), weighted ? w.data() : nullptr};
    const int line_count = static_cast<int>(lines), count = static_cast<int>(functions);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::vector<apsis::grid_sums::powers> sums(functions);
      std::vector<apsis::grid_sums::six_powers> more(functions);
      std::vector<double> rows(functions * n + 1, -7.0);
      apsis::grid_sums::sum(last, line_count, f.data(), u, a.data(), count, sums.data());
      apsis::grid_sums::sum(last, line_count, f.data(), u, a.data(), count, more.data());
      apsis::grid_sums::sum_lines(f.data(), line_count, last.n, a.data(), count, rows.data());
      RC_ASSERT(rows.back() == -7.0);
      const bool single = lines * functions == 1;
      for (std::size_t k = 0; k < functions; ++k) {
        std::vector<N> of_columns, c;
        for (std::size_t j = 0; j < n; ++j) {
          const N sum = sum_over_lines<N>(f.data() + j, n, a.data() + k * lines, lines);
          RC_ASSERT(same_bits(rows[k * n + j], value_of(sum)));
          const N here = single ? N(f[j]) : sum;
          of_columns.push_back(weighted ? N(w[j]) * here : here);
          c.push_back(N(v[j]) - N(u));
        }
        expect_powers(sums[k], of_columns, c, single ? a[0] : 1.0);
        expect_powers(more[k], of_columns, c, single ? a[0] : 1.0);
      }
    });
  });
}

TEST(formulas, products_and_entropies_over_a_grid_are_those_of_single_numbers) {
  check_property("grid products", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40)),
               lines = static_cast<std::size_t>(*rc::gen::inRange(1, 6));
    const auto g = drawn(n, random, any_size), h = drawn(n, random, any_size), w = drawn(n, random, any_size),
               a = drawn(lines, random, any_size);
    const double degrees = random.uniform(0.0, 3.0);
    const bool weighted = random.one_in(2), reduced = random.one_in(2);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::vector<double> m(lines * n), scaled(n);
      apsis::grid_sums::multiply(a.data(), static_cast<int>(lines), g.data(), static_cast<int>(n), m.data());
      apsis::grid_sums::scale(a[0], g.data(), static_cast<int>(n), scaled.data());
      for (std::size_t k = 0; k < m.size(); ++k) RC_ASSERT(same_bits(m[k], a[k / n] * g[k % n]));
      for (std::size_t k = 0; k < n; ++k) RC_ASSERT(same_bits(scaled[k], m[k]));
      const double entropy =
          apsis::grid_sums::entropy(weighted ? w.data() : nullptr, g.data(), reduced ? h.data() : nullptr,
                                    degrees, static_cast<int>(n));
      std::vector<N> sum(chains, N(0.0));
      for (std::size_t k = 0; k < n; ++k) {
        const N here(g[k]);
        const N of_mass =
            reduced ? scalar::entropy_per_mass(here, N(h[k]), N(degrees)) : scalar::log_of_normal(here);
        sum[k % chains] = fma(N(weighted ? w[k] : 1.0) * here, of_mass, sum[k % chains]);
      }
      RC_ASSERT(same_bits(entropy, sum_of_lanes(sum)));
    });
  });
}

TEST(formulas, operations_on_columns_are_those_on_single_numbers) {
  check_property("columns", [] {
    using apsis::formula_rows::operation;
    constexpr int most = apsis::formula_rows::most_points;
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const int points = *rc::gen::inRange(1, most + 1);
    const double constant = random.uniform(-3.0, 3.0);
    std::vector<double> given(3 * most);
    for (double& one : given) one = random.one_in(9) ? 0.0 : random.uniform(-5.0, 5.0);
    const auto table = [](double a, double b) { return a - 2.0 * b; };
    const auto value = [&](operation what, double a, double b) {
      switch (what) {
        case operation::add:
          return a + b;
        case operation::subtract:
          return a - b;
        case operation::multiply:
          return a * b;
        case operation::divide:
          return a / b;
        case operation::negate:
          return -a;
        case operation::square:
          return scalar::square_of(a);
        case operation::cube:
          return scalar::cube_of(a);
        case operation::fourth_power:
          return scalar::fourth_power_of(a);
        default:
          return table(a, b);
      }
    };
    for_each_number([&](auto, int) {
      for (int kind = 0; kind <= static_cast<int>(operation::call); ++kind)
        for (int constants = 0; constants < 3; ++constants) {
          apsis::formula_rows::step one{static_cast<operation>(kind), {0, 0.0}, {1, 0.0}, 2};
          const bool single = one.what >= operation::negate && one.what <= operation::fourth_power;
          if (single && constants > 0) continue;
          if (constants == 1) one.first = {-1, constant};
          if (constants == 2) one.second = {-1, constant};
          if (one.what == operation::call) one.of_two = table;
          auto columns = given;
          apsis::formula_rows::evaluate({&one, 1}, points, columns.data());
          for (int p = 0; p < points; ++p) {
            const auto k = static_cast<std::size_t>(p);
            const double a = constants == 1 ? constant : given[k],
                         b = constants == 2 ? constant : given[most + k];
            RC_ASSERT(same_bits(columns[2 * most + k], value(one.what, a, b)));
            RC_ASSERT(columns[k] == given[k]);
          }
        }
    });
  });
}

}  // namespace model_formulas_test
