// Kernels and their formulas on single numbers have the same bits in every instruction set, at every point.
#include <apsis/scheme/formulas/quartic.hpp>
#include <apsis/semidiscrete/centre_rows.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>
#include <apsis/semidiscrete/face_rows.hpp>
#include <apsis/semidiscrete/formulas/centre.hpp>
#include <apsis/semidiscrete/formulas/collision.hpp>
#include <apsis/semidiscrete/formulas/face.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <semidiscrete/number_rows.hpp>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace semidiscrete_formulas_test {

namespace {

namespace scalar = apsis::scalar;

/// A pencil of cells with two more beyond either end, with edges and two targets.
struct pencil {
  int cells;
  rows u, left, right, source;
  std::vector<double> forward, rate, inverse_cfl;
  bool with_source;

  pencil(int count, std::size_t width, random_source& random)
      : cells(count),
        u(static_cast<std::size_t>(count) + 4, width, random, any_size),
        left(static_cast<std::size_t>(count) + 4, width, random, any_sign),
        right(static_cast<std::size_t>(count) + 4, width, random, any_sign),
        source(static_cast<std::size_t>(count) + 4, width, random, any_sign),
        rate(drawn(width, random, [](random_source& r) { return r.uniform(0.0, 100.0); })),
        inverse_cfl(
            drawn(width, random, [](random_source& r) { return r.one_in(4) ? 1.0 : r.uniform(1.0, 30.0); })),
        with_source(random.one_in(2)) {
    // Some edges differ little from their cells and are not limited.
    for (std::size_t i = 0; i < u.all.size(); ++i)
      if (random.one_in(2)) left.all[i] = right.all[i] = u.all[i] * random.uniform(0.9, 1.1);
    const bool mixed = random.one_in(2);
    for (std::size_t k = 0; k < width; ++k)
      forward.push_back(mixed ? random.integer(0, 2) : k < width / 2 ? 0.0 : 1.0);
  }

  apsis::upwind::cells run() const {
    const auto pitch = static_cast<std::ptrdiff_t>(u.width);
    return {u.at.data() + 2,
            left.at[2],
            right.at[2],
            pitch,
            cells,
            static_cast<int>(u.width),
            forward.data(),
            rate.data(),
            inverse_cfl.data(),
            with_source ? source.at[2] : nullptr};
  }
  std::size_t place(int j, std::size_t k) const {
    return static_cast<std::size_t>(2 + (forward[k] > 0.5 ? j : cells - 1 - j));
  }
  /// Returns cell j, counted in the direction of motion.
  double value(int j, std::size_t k) const { return u.at[place(j, k)][k]; }
  double edge(int j, std::size_t k) const { return (forward[k] > 0.5 ? right : left).at[place(j, k)][k]; }
};

/// Returns the flux out of cell j.
template <class N>
N flux(const pencil& p, bool limited, int j, std::size_t k) {
  if (!limited) return N(p.edge(j, k));
  const auto cell = [&](int i) {
    const N inverse_cfl(p.inverse_cfl[k]);
    const auto upstream = scalar::unlimited(N(p.value(i - 1, k)), N(p.edge(i - 1, k)), inverse_cfl);
    return scalar::limited_after(upstream, N(p.value(i, k)), N(p.edge(i, k)), inverse_cfl);
  };
  return scalar::limited_flux(cell(j), cell(j + 1));
}

template <class N>
double transported(const pencil& p, bool limited, const apsis::upwind::row_target& to, double old, int j,
                   std::size_t k) {
  const double source = p.source.at[p.place(j, k)][k];
  return value_of(scalar::transported(
      N(to.alpha), N(p.value(j, k)), N(to.beta) * N(p.rate[k]),
      flux<N>(p, limited, j - 1, k) - flux<N>(p, limited, j, k), to.fresh, [&] { return N(old); },
      p.with_source, N(to.beta), [&] { return N(source); }));
}

}  // namespace

TEST(formulas, upwind_fluxes_are_those_of_single_numbers) {
  check_property("upwind", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 28));
    const pencil p(*rc::gen::inRange(1, 9), n, random);
    const bool limited = random.one_in(2);
    const auto old = drawn(static_cast<std::size_t>(p.cells) * n, random, any_size);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      auto first = old, second = old;
      const auto pitch = static_cast<std::ptrdiff_t>(n);
      const std::array<apsis::upwind::row_target, 2> targets = {
          {{first.data(), pitch, 0.3, 0.01, true}, {second.data(), pitch, 0.7, 0.002, false}}};
      if (limited) {
        apsis::upwind::add_limited(p.run(), targets);
      } else {
        apsis::upwind::add(p.run(), targets);
      }
      for (int j = 0; j < p.cells; ++j)
        for (std::size_t k = 0; k < n; ++k) {
          const std::size_t at = (p.place(j, k) - 2) * n + k;
          RC_ASSERT(same_bits(first[at], transported<N>(p, limited, targets[0], old[at], j, k)));
          RC_ASSERT(same_bits(second[at], transported<N>(p, limited, targets[1], old[at], j, k)));
        }
    });
  });
}

TEST(formulas, fluxes_at_the_ends_of_a_run_are_those_of_single_numbers) {
  check_property("fluxes", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 28));
    const pencil p(*rc::gen::inRange(1, 9), n, random);
    for (const bool limited : {false, true})
      for_each_number([&](auto number, int) {
        using N = decltype(number);
        std::vector<double> in(n), out(n);
        apsis::upwind::cells run = p.run();
        run.in = in.data();
        run.out = out.data();
        (limited ? apsis::upwind::add_limited : apsis::upwind::add)(run, {});
        for (std::size_t k = 0; k < n; ++k) {
          RC_ASSERT(same_bits(in[k], value_of(flux<N>(p, limited, -1, k))));
          RC_ASSERT(same_bits(out[k], value_of(flux<N>(p, limited, p.cells - 1, k))));
        }
      });
  });
}

TEST(formulas, values_at_faces_are_those_of_single_numbers) {
  check_property("face", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    const rows row(3, n, random, any_size);
    auto inward = drawn(n, random, any_sign);
    inward[n / 2] = 0.0;
    const double beta = random.uniform(0.0, 1.0), spacing = random.uniform(0.01, 1.0);
    const auto width = static_cast<int>(n);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::vector<double> values(row.at[0], row.at[0] + n), acc(row.at[1], row.at[1] + n);
      apsis::face_rows::keep_leaving(inward.data(), width, values.data());
      for (std::size_t k = 0; k < n; ++k)
        RC_ASSERT(same_bits(values[k], value_of(scalar::if_leaving(N(inward[k]), N(row.at[0][k])))));
      auto both = values, fluxes = values;
      apsis::face_rows::take_entering(inward.data(), row.at[2], width, both.data());
      apsis::face_rows::add_entering(inward.data(), both.data(), beta, spacing, width, acc.data());
      apsis::face_rows::multiply(inward.data(), width, fluxes.data());
      for (std::size_t k = 0; k < n; ++k) {
        const N v(inward[k]), value = scalar::if_entering(v, N(row.at[2][k]), N(values[k]));
        RC_ASSERT(same_bits(both[k], value_of(value)));
        RC_ASSERT(same_bits(acc[k],
                            value_of(scalar::with_entering(N(row.at[1][k]), N(beta), v, N(spacing), value))));
        RC_ASSERT(same_bits(fluxes[k], inward[k] * values[k]));
      }
    });
  });
}

TEST(formulas, collision_parts_are_those_of_single_numbers) {
  check_property("collision", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 28));
    const rows q(3, n, random, any_sign), u(1, n, random, any_size), old(2, n, random, any_size);
    const std::array<apsis::collision_rows::weighted_row, 3> points = {
        {{0.3, q.at[0]}, {0.4, q.at[1]}, {0.3, q.at[2]}}};
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::vector<double> first(old.at[0], old.at[0] + n), second(old.at[1], old.at[1] + n),
          weighted = second;
      const std::array<apsis::upwind::row_target, 2> targets = {
          {{first.data(), 0, 0.3, 0.01, true}, {second.data(), 0, 0.7, 1e-9, false}}};
      apsis::collision_rows::add(points, u.at[0], static_cast<int>(n), targets);
      const apsis::upwind::row_target alone{weighted.data(), 0, 0.7, 0.0, false};
      apsis::upwind::add_weights(u.at[0], static_cast<int>(n), {&alone, 1});
      for (std::size_t k = 0; k < n; ++k) {
        N change(0.0);
        for (const auto& p : points) change = scalar::with_collision(change, N(p.weight), N(p.q[k]));
        const N here(u.at[0][k]);
        const N of_first = scalar::collision_part(N(0.3), here, N(0.01), change);
        const N of_second = N(old.at[1][k]) + scalar::collision_part(N(0.7), here, N(1e-9), change);
        RC_ASSERT(same_bits(first[k], value_of(of_first)));
        RC_ASSERT(same_bits(second[k], value_of(of_second)));
        RC_ASSERT(same_bits(weighted[k], value_of(N(old.at[1][k]) + N(0.7) * here)));
      }
    });
  });
}

TEST(formulas, gauss_values_are_those_of_single_numbers) {
  check_property("quartic", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 28));
    const rows u(5, n, random, any_size);
    for (const bool limited : {false, true})
      for_each_number([&](auto number, int) {
        using N = decltype(number);
        std::vector<double> points(3 * n);
        apsis::collision_rows::gauss_values({u.at[0], u.at[1], u.at[2], u.at[3], u.at[4]}, limited,
                                            static_cast<int>(n), points.data());
        for (std::size_t k = 0; k < n; ++k) {
          const N before(u.at[0][k]), c(u.at[1][k]), after(u.at[2][k]), l(u.at[3][k]), r(u.at[4][k]);
          const auto of = limited ? scalar::quartic_values<true>(before, c, after, l, r)
                                  : scalar::quartic_values<false>(before, c, after, l, r);
          RC_ASSERT(same_bits(points[k], value_of(of.g0)));
          RC_ASSERT(same_bits(points[n + k], value_of(of.g1)));
          RC_ASSERT(same_bits(points[2 * n + k], value_of(of.g2)));
        }
      });
  });
}

TEST(formulas, values_at_centres_are_those_of_single_numbers) {
  constexpr int reach = apsis::centre_rows::reach;
  check_property("centres", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 28));
    const int cells = *rc::gen::inRange(1, 9);
    const rows u(static_cast<std::size_t>(cells + 2 * reach), n, random, any_size);
    const rows d(static_cast<std::size_t>(cells + 2 * reach), n, random, any_sign);
    const auto row = [](int i) { return static_cast<std::size_t>(i + reach); };
    for (const bool limited : {false, true})
      for_each_number([&](auto number, int) {
        using N = decltype(number);
        const auto width = static_cast<int>(n);
        std::vector<double> points(static_cast<std::size_t>(cells) * n), averages = points;
        apsis::centre_rows::values(u.at.data() + reach, cells, limited, width, points.data());
        apsis::centre_rows::add_averages(u.at.data() + reach, d.at.data() + reach, cells, limited, width,
                                         averages.data());
        std::vector<double> lowered(points.begin(), points.begin() + width);
        apsis::centre_rows::lower(u.at[reach], d.at[reach], limited, width, lowered.data());
        for (std::size_t k = 0; k < n; ++k) {
          const auto cell = [&](int i) {
            return scalar::changed_cell<N>(N(u.at[row(i)][k]), N(d.at[row(i)][k]));
          };
          for (int i = 0; i < cells; ++i) {
            const auto at = static_cast<std::size_t>(i) * n + k;
            const auto value =
                scalar::centre_value<N>([&](int j) { return N(u.at[row(i + j)][k]); }, limited);
            RC_ASSERT(same_bits(points[at], value_of(value)));
            const auto before = scalar::centre_flux(cell(i - 1), cell(i), limited),
                       after = scalar::centre_flux(cell(i), cell(i + 1), limited);
            RC_ASSERT(
                same_bits(averages[at], value_of(scalar::centre_average(cell(i).b, before, after, limited))));
          }
          const N least = scalar::lowered_centre(N(u.at[reach][k]), N(d.at[reach][k]), N(points[k]), limited);
          RC_ASSERT(same_bits(lowered[k], value_of(least)));
        }
      });
  });
}

}  // namespace semidiscrete_formulas_test
