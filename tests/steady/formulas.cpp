// Kernels and their formulas on single numbers have the same bits in every instruction set, at every point.
#include <apsis/core/random_source.hpp>
#include <apsis/steady/formulas/mixture.hpp>
#include <apsis/steady/formulas/sweep.hpp>
#include <apsis/steady/mixture_rows.hpp>
#include <apsis/steady/sweep_rows.hpp>

#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace steady_formulas_test {

namespace {

using apsis::random_source;
using apsis::sweep_rows::upstream;
namespace scalar = apsis::scalar;

}  // namespace

TEST(formulas, implicit_upwind_equations_are_those_of_single_numbers) {
  check_property("sweep", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    const auto directions = static_cast<std::size_t>(*rc::gen::inRange(1, 4));
    const auto width = static_cast<int>(n);
    const auto row = drawn(n, random, any_sign);
    std::vector<std::vector<double>> one, two, lambda;
    std::array<upstream, 3> terms;
    std::array<const double*, 3> speeds{};
    for (std::size_t d = 0; d < directions; ++d) {
      one.push_back(drawn(n, random, any_sign));
      two.push_back(drawn(n, random, any_sign));
      lambda.push_back(drawn(n, random, [](random_source& r) { return r.uniform(0.0, 100.0); }));
    }
    for (std::size_t d = 0; d < directions; ++d) {
      terms[d] = {random.uniform(0.0, 2.0), random.uniform(0.0, 2.0), random.uniform(-1.0, 0.0),
                  one[d].data(), two[d].data()};
      speeds[d] = lambda[d].data();
    }
    // There are two strips. A component between them keeps its value. The second one lies downstream of the
    // first one in a rotation.
    const int first = width / 2, second = std::min(first + 1, width);
    const std::array<apsis::sweep_rows::strip, 2> strips = {{{0, first}, {second, width, -second}}};
    const auto out = drawn(n, random, [](random_source& r) { return r.uniform(0.0, 10.0); }),
               in = drawn(n, random, [](random_source& r) { return r.uniform(0.0, 10.0); });
    apsis::sweep_rows::rotation turn;
    if (*rc::gen::arbitrary<bool>()) turn = {out.data(), in.data(), random.uniform(0.1, 10.0)};
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      auto solved = row;
      apsis::sweep_rows::solve({terms.data(), directions}, speeds, 0.75, turn, strips, solved.data());
      for (std::size_t k = 0; k < n; ++k) {
        scalar::upwind_equation<N> of(N(row[k]), N(0.75));
        for (std::size_t d = 0; d < directions; ++d)
          of.add(N(lambda[d][k]), N(terms[d].here), N(terms[d].first), N(one[d][k]), N(terms[d].second),
                 N(two[d][k]));
        const auto from = k < static_cast<std::size_t>(second) ? k : k - static_cast<std::size_t>(second);
        if (turn.out != nullptr)
          of.add_rotation(N(turn.per_radius) * N(out[k]), N(turn.per_radius) * N(in[k]),
                          N(from == k ? row[k] : solved[from]));
        const bool between = k == static_cast<std::size_t>(first);
        RC_ASSERT(same_bits(solved[k], between ? row[k] : value_of(of.solution())));
      }
    });
  });
}

TEST(formulas, mixtures_of_images_are_those_of_single_numbers) {
  check_property("mixture", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    const auto images = static_cast<std::size_t>(*rc::gen::inRange(0, 4));
    const double last_factor = random.uniform(0.5, 2.0), factor = random.uniform(0.5, 2.0);
    const auto x = drawn(n, random, any_sign), delta = drawn(n, random, any_sign),
               before = drawn(n, random, any_sign);
    std::vector<std::vector<double>> rows;
    apsis::mixture_rows::weighted_differences last, now;
    for (std::size_t j = 0; j < images; ++j) {
      rows.push_back(drawn(n, random, any_sign));
      last.theta.push_back(random.uniform(-1.0, 1.0));
      now.theta.push_back(random.uniform(-1.0, 1.0));
    }
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      // The newest difference overwrites the oldest one, which is read for the last time.
      auto newest = before, mixed = x;
      last.rows = now.rows = {};
      for (std::size_t j = 0; j < images; ++j) {
        last.rows.push_back(j == 0 ? newest.data() : rows[j].data());
        now.rows.push_back(j + 1 == images ? newest.data() : rows[j + 1].data());
      }
      apsis::mixture_rows::move(0, n, last, last_factor, newest.data(), now, factor, delta.data(),
                                mixed.data());
      for (std::size_t k = 0; k < n; ++k) {
        scalar::image_mixture<N> of(N(x[k]), N(delta[k]), N(1.0 / last_factor));
        for (std::size_t j = 0; j < images; ++j)
          of.recall(N(last.theta[j]), N(j == 0 ? before[k] : rows[j][k]));
        const N difference = of.difference();
        for (std::size_t j = 0; j < images; ++j)
          of.take_off(N(now.theta[j]), j + 1 == images ? difference : N(rows[j + 1][k]));
        RC_ASSERT(same_bits(newest[k], value_of(difference)));
        RC_ASSERT(same_bits(mixed[k], value_of(N(factor) * of.mixed)));
      }
    });
  });
}

}  // namespace steady_formulas_test
