// Kernels along a line of velocities have the bits of their formulas on single numbers, as in formulas.cpp.
#include "drawn_velocity.hpp"

#include <apsis/core/random_source.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/model/formulas/line.hpp>
#include <apsis/model/formulas/velocity.hpp>
#include <apsis/model/line_powers.hpp>
#include <apsis/model/line_sums.hpp>
#include <apsis/model/vector_math.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace line_formulas_test {

namespace {

using apsis::random_source;
namespace scalar = apsis::scalar;

/// Returns the total of one member of the sums of all lanes.
template <class Sums, class Member>
double total(const std::vector<Sums>& lanes, Member member) {
  using N = std::decay_t<decltype(lanes[0].*member)>;
  std::vector<N> parts;
  for (const auto& lane : lanes) parts.push_back(lane.*member);
  return sum_of_lanes(parts);
}

}  // namespace

TEST(line_formulas, sums_over_a_line_are_those_of_single_numbers) {
  check_property("lines", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    constexpr auto packet = static_cast<std::size_t>(apsis::packet_length);
    const std::size_t padded = (n + packet - 1) / packet * packet;
    apsis::aligned_vector<double> x(padded), c(padded), base(padded, 1.0), w(padded);
    for (std::size_t j = 0; j < n; ++j) {
      x[j] = any_velocity(random);
      c[j] = random.uniform(0.0, 100.0);
      base[j] = random.uniform(0.0, 2.0);
    }
    const double beta = random.uniform(-3.0, 3.0), tau = random.uniform(-1.0, 10.0),
                 shift = random.uniform(-5.0, 5.0);
    const bool with_base = random.one_in(2);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      constexpr std::size_t width = 8;  // chains of additions
      const auto values = apsis::line_sums::weigh(x.data(), c.data(), with_base ? base.data() : nullptr,
                                                  static_cast<int>(n), beta, tau, shift, w.data());
      const auto products = apsis::line_sums::multiply(x.data(), c.data(), w.data(), static_cast<int>(n));
      using weights = scalar::sums_of_weights<N>;
      using second = scalar::sums_of_products<N>;
      std::vector<weights> of(width);
      std::vector<second> of_second(width);
      for (std::size_t j = 0; j < (n + width - 1) / width * width; ++j) {
        N weight = j < n ? scalar::line_weight(N(x[j]), N(c[j]), N(beta), N(tau), N(shift)) : N(0.0);
        if (with_base) weight = weight * N(base[j]);
        RC_ASSERT(same_bits(w[j], value_of(weight)));
        of[j % width].add(weight, N(x[j]), N(c[j]));
        of_second[j % width].add(weight, N(x[j]), N(c[j]));
      }
      RC_ASSERT(same_bits(values.mass, total(of, &weights::mass)));
      RC_ASSERT(same_bits(values.above, total(of, &weights::above)));
      RC_ASSERT(same_bits(values.below, total(of, &weights::below)));
      RC_ASSERT(same_bits(values.energy, total(of, &weights::energy)));
      RC_ASSERT(same_bits(products.above_x, total(of_second, &second::above_x)));
      RC_ASSERT(same_bits(products.above_c, total(of_second, &second::above_c)));
      RC_ASSERT(same_bits(products.below_x, total(of_second, &second::below_x)));
      RC_ASSERT(same_bits(products.below_c, total(of_second, &second::below_c)));
      RC_ASSERT(same_bits(products.cc, total(of_second, &second::cc)));
    });
  });
}

namespace {

/// Calls add(chain, lane, k) for every place of a row, including those behind n. There are two chains while
/// two vectors remain.
template <class Add>
void in_two_chains(std::size_t n, std::size_t lanes, const Add& add) {
  std::size_t k = 0;
  for (; k + 2 * lanes <= n; k += 2 * lanes)
    for (std::size_t i = 0; i < 2 * lanes; ++i) add(i / lanes, i % lanes, k + i);
  for (; k < n; k += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) add(0, lane, k + lane);
}

/// Returns the sum over lanes of the sums of two chains.
template <class Sums, class Member>
double total_of_chains(const std::array<std::vector<Sums>, 2>& chains, Member member) {
  using N = std::decay_t<decltype(chains[0][0].*member)>;
  std::vector<N> parts;
  for (std::size_t lane = 0; lane < chains[0].size(); ++lane)
    parts.push_back(chains[0][lane].*member + chains[1][lane].*member);
  return sum_of_lanes(parts);
}

}  // namespace

TEST(line_formulas, moments_on_a_line_are_those_of_single_numbers) {
  check_property("moments", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, apsis::velocity_rows::longest_chain + 1));
    const int rows = *rc::gen::inRange(1, 6);
    const auto f = drawn(n * static_cast<std::size_t>(rows), random, any_size),
               v = drawn(n, random, any_velocity);
    std::vector<double> half;
    for (const double x : v) half.push_back(0.5 * x * x);
    for_each_number([&](auto number, int /*lanes*/) {
      using N = decltype(number);
      using moments = scalar::sums_of_moments<N>;
      std::vector<apsis::velocity_rows::sums> sums(static_cast<std::size_t>(rows));
      apsis::velocity_rows::moments(f.data(), static_cast<std::ptrdiff_t>(n), rows, v.data(), half.data(),
                                    static_cast<int>(n), sums.data());
      for (std::size_t r = 0; r < sums.size(); ++r) {
        constexpr std::size_t width = 8;  // for any length of a vector
        std::array<std::vector<moments>, 2> of{std::vector<moments>(width), std::vector<moments>(width)};
        in_two_chains(n, width, [&](std::size_t chain, std::size_t lane, std::size_t k) {
          const N value(k < n ? f[r * n + k] : 0.0);
          of[chain][lane].add(value, N(k < n ? v[k] : 0.0), N(k < n ? half[k] : 0.0));
        });
        RC_ASSERT(same_bits(sums[r].mass, total_of_chains(of, &moments::mass)));
        RC_ASSERT(same_bits(sums[r].momentum, total_of_chains(of, &moments::momentum)));
        RC_ASSERT(same_bits(sums[r].energy, total_of_chains(of, &moments::energy)));
      }
    });
  });
}

namespace {

/// Number of chains of additions in line_powers. Point j is in chain j mod 8.
constexpr std::size_t chains = 8;

}  // namespace

TEST(line_formulas, powers_on_a_line_and_their_changes_are_those_of_single_numbers) {
  check_property("line powers", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    const auto w = drawn(n, random, any_size), v = drawn(n, random, any_velocity),
               b = drawn(n, random, any_size);
    const double u = any_velocity(random), beta = random.uniform(-2e-4, 2e-4),
                 gamma = random.uniform(-1e-5, 1e-5);
    const bool weighted = random.one_in(2);
    const apsis::line_powers::points line{static_cast<int>(n), v.data(), weighted ? b.data() : nullptr};
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      auto changed = w;
      const auto before = apsis::line_powers::sum(line, u, w.data()),
                 after = apsis::line_powers::change(line, u, beta, gamma, changed.data());
      std::vector<scalar::sums_of_six_powers<N>> of(chains), of_changed(chains);
      for (std::size_t j = 0; j < n; ++j) {
        const N c = N(v[j]) - N(u), here(w[j]), there = scalar::changed_weight(here, c, N(beta), N(gamma));
        RC_ASSERT(same_bits(changed[j], value_of(there)));
        of[j % chains].add(weighted ? here * N(b[j]) : here, c);
        of_changed[j % chains].add(weighted ? there * N(b[j]) : there, c);
      }
      for (std::size_t p = 0; p < before.size(); ++p) {
        std::vector<N> parts, parts_after;
        for (std::size_t i = 0; i < chains; ++i) {
          parts.push_back(of[i].of[p]);
          parts_after.push_back(of_changed[i].of[p]);
        }
        RC_ASSERT(same_bits(before[p], sum_of_lanes(parts)));
        RC_ASSERT(same_bits(after[p], sum_of_lanes(parts_after)));
      }
    });
  });
}

namespace {

/// Returns a Gaussian at all points, by the formulas on single numbers, for vectors of `length` numbers.
template <class N>
std::vector<double> gaussian(const apsis::velocity_rows::points& line,
                             const apsis::velocity_rows::gaussian& of, int length) {
  const int n = line.n, vectors = (n + length - 1) / length;
  std::vector<double> m(static_cast<std::size_t>(n));
  const auto x = [&](int j) { return scalar::distance_to(N(of.u), N(line.spacing), N(j + 0.5 - 0.5 * n)); };
  const double jump = line.spacing * length;
  const N per = N(0.5) / N(of.T);
  const auto put = [&](int j, N value) {
    if (j < n) m[static_cast<std::size_t>(j)] = value_of(value);
  };
  if (!scalar::gaussian_recurs(jump * jump * value_of(per), vectors)) {
    for (int j = 0; j < n; ++j) put(j, scalar::gaussian_start(N(of.a), x(j), per));
    return m;
  }
  const double farthest = 0.5 * line.spacing * n + jump + std::abs(of.u);
  const N change = scalar::gaussian_change(per, N(jump));
  const int centre = static_cast<int>(
      value_of(scalar::gaussian_vector(N(of.u), N(line.spacing), N(n), N(length), N(vectors))));
  const auto fill = [&]<bool Deep>(std::bool_constant<Deep>) {
    for (int lane = 0; lane < length; ++lane) {
      const N from = x(centre * length + lane), start = scalar::gaussian_start(N(of.a), from, per),
              right = scalar::gaussian_right(from, per, N(jump));
      scalar::gaussian_walk<Deep, N> walk{start, right, change};
      for (int k = centre; k < vectors; ++k, walk.advance()) put(k * length + lane, walk.value);
      walk = {start, change / right, change};
      for (int k = centre - 1; k >= 0; --k) {
        walk.advance();
        put(k * length + lane, walk.value);
      }
    }
  };
  if (scalar::gaussian_is_deep(of.a, farthest, value_of(per))) {
    fill(std::true_type());
  } else {
    fill(std::false_type());
  }
  return m;
}

}  // namespace

TEST(line_formulas, gaussians_are_those_of_single_numbers) {
  check_property("gaussians", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const apsis::velocity_rows::points line{*rc::gen::inRange(1, 160), random.uniform(0.05, 0.5)};
    std::vector<apsis::velocity_rows::gaussian> of;
    const int rows = *rc::gen::inRange(1, 12);
    for (int p = 0; p < rows; ++p)
      of.push_back({random.magnitude(-40.0, 10.0), random.uniform(-20.0, 20.0), random.magnitude(-3.0, 3.0)});
    const auto n = static_cast<std::size_t>(line.n);
    const auto places = drawn(n, random, any_velocity);
    for_each_number([&](auto number, int /*lanes*/) {
      std::vector<double> m(n * of.size());
      apsis::velocity_rows::gaussians(line, of.data(), rows, m.data(), line.n);
      for (std::size_t p = 0; p < of.size(); ++p) {
        const auto expected = gaussian<decltype(number)>(line, of[p], 8);
        for (std::size_t j = 0; j < n; ++j) RC_ASSERT(same_bits(m[p * n + j], expected[j]));
      }
      using N = decltype(number);
      std::vector<double> one(n);
      apsis::velocity_rows::gaussian_at(places.data(), line.n, of[0], one.data());
      for (std::size_t j = 0; j < n; ++j)
        RC_ASSERT(same_bits(one[j], value_of(scalar::gaussian_start(N(of[0].a), N(places[j]) - N(of[0].u),
                                                                    N(0.5 / of[0].T)))));
      auto powers = places;
      apsis::velocity_rows::exponentials(of[0].u, line.n, powers.data());
      for (std::size_t j = 0; j < n; ++j)
        RC_ASSERT(same_bits(powers[j], value_of(scalar::exp_of(N(places[j]) - N(of[0].u)))));
    });
  });
}

}  // namespace line_formulas_test
