// Kernels against their formulas on single numbers, point by point: the same bits in every instruction set.
#include <apsis/core/random_source.hpp>
#include <apsis/scheme/formulas/quartic.hpp>
#include <apsis/semidiscrete/centre_rows.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>
#include <apsis/semidiscrete/cut_rows.hpp>
#include <apsis/semidiscrete/face_rows.hpp>
#include <apsis/semidiscrete/formulas/centre.hpp>
#include <apsis/semidiscrete/formulas/collision.hpp>
#include <apsis/semidiscrete/formulas/cut_cell.hpp>
#include <apsis/semidiscrete/formulas/face.hpp>
#include <apsis/semidiscrete/formulas/lattice.hpp>
#include <apsis/semidiscrete/formulas/rotation.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>
#include <apsis/semidiscrete/lattice_rows.hpp>
#include <apsis/semidiscrete/rotation_rows.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace semidiscrete_formulas_test {

namespace {

using apsis::random_source;
namespace scalar = apsis::scalar;

/// Rows one behind the other.
struct rows {
  std::size_t width;
  std::vector<double> all;
  std::vector<const double*> at;

  template <class Draw>
  rows(std::size_t count, std::size_t of_row, random_source& random, const Draw& draw)
      : width(of_row), all(drawn(count * of_row, random, draw)) {
    for (std::size_t i = 0; i < count; ++i) at.push_back(all.data() + i * width);
  }
};

/// A pencil of cells with two more beyond either end, their edges and two targets.
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
    // Some edges differ little from their cells: those are not limited.
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
  /// Cell j seen in the direction of motion.
  double value(int j, std::size_t k) const { return u.at[place(j, k)][k]; }
  double edge(int j, std::size_t k) const { return (forward[k] > 0.5 ? right : left).at[place(j, k)][k]; }
};

/// The flux out of cell j.
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

namespace {

/// A row on a lattice, seen along one direction of motion; outside of the lattice there is vacuum.
template <class N>
struct line_of_lattice {
  const apsis::lattice_rows::layout& at;
  const apsis::lattice_rows::flux_rule& rule;
  const double* row;

  int steps(int i) const { return rule.forward ? i : -i; }
  /// The value i points downstream of one.
  N value(int block, int point, int column, int i) const {
    const int to = point + steps(i);
    return to < 0 || to >= at.points ? N(0.0) : N(row[(block * at.points + to) * at.apart + column]);
  }
  N edge(int block, int point, int column) const {
    if (point < 0 || point >= at.points) return N(0.0);
    const auto v = [&](int i) { return value(block, point, column, i); };
    return rule.fifth_order ? scalar::upwind5_edge(v(-2), v(-1), v(0), v(1), v(2))
                            : scalar::upwind1_edge(v(0));
  }
  /// The flux out of a point by the formulas of add_limited(), none out of the last one.
  N flux(int block, int point, int column) const {
    const int last = rule.forward ? at.points - 1 : 0;
    if (point < 0 || point >= at.points || point == last) return N(0.0);
    if (!rule.limited) return edge(block, point, column);
    const auto cell = [&](int to) {
      const N inverse_cfl(rule.inverse_cfl);
      const int before = to - steps(1);
      const auto upstream =
          scalar::unlimited(value(block, before, column, 0), edge(block, before, column), inverse_cfl);
      return scalar::limited_after(upstream, value(block, to, column, 0), edge(block, to, column),
                                   inverse_cfl);
    };
    return scalar::limited_flux(cell(point), cell(point + steps(1)));
  }
};

}  // namespace

TEST(formulas, changes_along_a_lattice_are_those_of_single_numbers) {
  check_property("lattice", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const apsis::lattice_rows::layout at{*rc::gen::inRange(1, 5), *rc::gen::inRange(1, 14),
                                         *rc::gen::inRange(1, 14)};
    const auto n = static_cast<std::size_t>(at.blocks * at.block());
    rows row(3, n, random, any_size);
    // Some rows vary little, as in the bulk of a gas: most of their points are not limited.
    if (random.one_in(2))
      for (std::size_t i = 0; i < n; ++i) row.all[i] = 1.0 + 0.1 * random.uniform(0.0, 1.0);
    const bool fresh = random.one_in(2);
    const apsis::lattice_rows::flux_rule rule{random.one_in(2), random.one_in(2), random.one_in(2),
                                              random.one_in(4) ? 1.0 : random.uniform(1.0, 30.0)};
    const double rate = random.uniform(0.0, 3.0), beta = random.magnitude(-12.0, 0.0);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::array<std::vector<double>, 5> all;
      for (auto& one : all) one.resize(at.size());
      const apsis::lattice_rows::places places{all[0].data(), all[1].data(), all[2].data(), all[3].data(),
                                               all[4].data()};
      const double* out = places.fluxes(rule);
      std::vector<double> sum(row.at[1], row.at[1] + n), acc(row.at[2], row.at[2] + n);
      apsis::lattice_rows::find_fluxes(at, rule, row.at[0], places);
      apsis::lattice_rows::add_differences(at, out, rule.forward, rate, fresh, sum.data());
      apsis::lattice_rows::add(sum.data(), -beta, static_cast<int>(n), acc.data());
      const line_of_lattice<N> line{at, rule, row.at[0]};
      std::size_t j = 0;
      for (int block = 0; block < at.blocks; ++block)
        for (int point = 0; point < at.points; ++point)
          for (int column = 0; column < at.apart; ++column, ++j) {
            const N flux = line.flux(block, point, column);
            const auto place =
                static_cast<std::size_t>(at.first() + block * at.pitch() + point * at.apart + column);
            RC_ASSERT(all[0][place] == row.at[0][j]);
            RC_ASSERT(same_bits(out[place], value_of(flux)));
            const N upstream = line.flux(block, point - line.steps(1), column);
            const N change = fma(N(rate), upstream - flux, N(fresh ? 0.0 : row.at[1][j]));
            RC_ASSERT(same_bits(sum[j], value_of(change)));
            RC_ASSERT(same_bits(acc[j], value_of(scalar::with_change(N(row.at[2][j]), N(-beta), change))));
          }
      RC_ASSERT(j == n);
      // Gaps are empty, and the place before the first point.
      for (int block = 0; block < at.blocks; ++block)
        for (int k = 0; k < at.first(); ++k) {
          const auto behind = static_cast<std::size_t>(at.first() + block * at.pitch() + at.block() + k);
          RC_ASSERT(all[0][behind] == 0.0);
          RC_ASSERT(out[behind] == 0.0);
          RC_ASSERT(out[static_cast<std::size_t>(k)] == 0.0);
        }
    });
  });
}

namespace {

/// A ring of random values.
template <class N>
struct ring_of_numbers {
  const apsis::rotation_rows::ring& of;
  const apsis::rotation_rows::flux_rule& rule;
  const double* ring;
  int column;

  bool lower(int angle) const { return angle >= of.angles / 2; }
  std::size_t place(int angle) const {
    return static_cast<std::size_t>((angle + of.angles) % of.angles * of.apart + column);
  }
  N value(int angle) const { return N(ring[place(angle)]); }
  /// The fluxes through an edge between the angles edge − 1 and edge, in the direction of a half.
  scalar::rotation_fluxes<N> through(int edge, bool upwards) const {
    const int from = upwards ? edge - 1 : edge, step = upwards ? 1 : -1;
    const auto v = [&](int i) { return value(from + i * step); };
    const auto k = static_cast<std::size_t>(edge * of.apart + column);
    return scalar::fluxes_of_rotation(scalar::rotation_edge<N>{N(rule.speeds[k]), N(rule.slopes[k])},
                                      {rule.first, rule.third, rule.second}, rule.fifth_order, v(-2), v(-1),
                                      v(0), v(1), v(2));
  }
  int edge_behind(int angle) const { return lower(angle) ? angle + 1 : angle; }
  int edge_before(int angle) const { return lower(angle) ? angle : angle + 1; }
  N fraction(int angle) const {
    return scalar::fraction_of_rotation(through(edge_before(angle), lower(angle)),
                                        through(edge_behind(angle), lower(angle)), value(angle),
                                        N(rule.scale) * N(rule.inverse[place(angle)]));
  }
  /// The flux through an edge in the direction of a half.
  N flux(int edge, bool upwards) const {
    const auto found = through(edge, upwards);
    if (!rule.limited) return found.high_order;
    const int below = (edge - 1 + of.angles) % of.angles, above = edge % of.angles;
    return scalar::limited_edge(found.low_order, found.high_order, fraction(upwards ? below : above),
                                fraction(upwards ? above : below));
  }
  N change(int angle, double rate) const {
    const bool upwards = lower(angle);
    return N(rate) * (flux(edge_before(angle), upwards) - flux(edge_behind(angle), upwards));
  }
};

}  // namespace

TEST(formulas, changes_along_a_ring_are_those_of_single_numbers) {
  check_property("ring", [] {
    namespace rows_of_ring = apsis::rotation_rows;
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const rows_of_ring::ring of{4 * *rc::gen::inRange(1, 6), *rc::gen::inRange(1, 14)};
    const auto n = static_cast<std::size_t>(of.size());
    rows ring(1, n, random, any_size);
    // Some rings vary little: most of their angles are not limited.
    if (random.one_in(2))
      for (double& one : ring.all) one = 1.0 + 0.1 * random.uniform(0.0, 1.0);
    const auto edges = static_cast<std::size_t>(of.edges());
    const auto speeds = drawn(edges, random, [](random_source& r) { return r.uniform(0.0, 1.0); });
    const auto slopes = drawn(edges, random, [](random_source& r) { return r.uniform(-0.5, 0.5); });
    const auto inverse = drawn(n, random, [](random_source& r) { return r.uniform(0.0, 5.0); });
    const rows_of_ring::flux_rule rule{
        random.one_in(2), random.one_in(2),         speeds.data(), slopes.data(), 0.1, -0.01, -0.001,
        inverse.data(),   random.uniform(1.0, 20.0)};
    const double rate = random.uniform(0.0, 3.0);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::array<std::vector<double>, 4> all;
      for (auto& one : all) one.resize(of.places());
      std::vector<double> values(of.continued()), change(n);
      rows_of_ring::continue_ring(of, ring.at[0], values.data());
      rows_of_ring::turn(of, rule, values.data(), rate,
                         {all[0].data(), all[1].data(), all[2].data(), all[3].data()}, change.data());
      for (int column = 0; column < of.apart; ++column) {
        const ring_of_numbers<N> numbers{of, rule, ring.at[0], column};
        for (int angle = 0; angle < of.angles; ++angle)
          RC_ASSERT(same_bits(change[numbers.place(angle)], value_of(numbers.change(angle, rate))));
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

TEST(cut_rows, are_the_formulas_of_single_numbers) {
  namespace cut_rows = apsis::cut_rows;
  random_source random(11);
  for (int k = 0; k < 200; ++k) {
    const auto n = static_cast<std::size_t>(1 + k % 19);
    const rows u(2, n, random, any_size), v(2, n, random, any_sign);
    rows slopes(2, n, random, any_sign), beyond(2, n, random, any_sign);
    std::vector<double> size(n), outflow(n), increase(n), share(n), values(n, 7.0), alone(n), to_row(n, 0.5),
        to_line(n, 0.5);
    const std::vector<double> x = slopes.all;
    const bool limited = k % 2 == 0;
    const std::array<std::array<double, 3>, 2> to = {{{0.3, -0.2, 0.0}, {-0.4, 0.1, 0.0}}};
    const auto way_at = [&](std::size_t face) {
      return cut_rows::way_out{{0.6, face == 0 ? 0.8 : -0.8, 0.0}, 1.5, {v.at[0], v.at[1], nullptr}};
    };
    const auto line_to = [&](std::size_t face) {
      return cut_rows::line{u.at[0], {slopes.all.data(), slopes.all.data() + n, nullptr}, to[face], limited};
    };
    const cut_rows::line other{
        u.at[1], {beyond.all.data(), beyond.all.data() + n, nullptr}, {0.2, 0.7, 0.0}, limited};
    const cut_rows::demand_rows demand{size.data(), outflow.data(), increase.data()};
    const cut_rows::extent of{2, static_cast<int>(n)};
    constexpr double step = 0.01;
    const auto kept = drawn(n, random, [](random_source& r) { return r.uniform(0.8, 1.0); });
    for (std::size_t face = 0; face < 2; ++face)
      cut_rows::add_demand(way_at(face), step, line_to(face), of, demand);
    cut_rows::limit(u.at[0], demand, kept.data(), of, line_to(0).slopes);
    cut_rows::project(way_at(0), of, share.data());
    cut_rows::leave(share.data(), line_to(0), of, values.data());
    cut_rows::leave_alone(way_at(0), line_to(0), of, alone.data());
    cut_rows::pass(way_at(0), line_to(0), u.at[1], of, to_row.data());
    cut_rows::pass(way_at(0), line_to(0), other, of, to_line.data());
    for (std::size_t j = 0; j < n; ++j) {
      const auto outward = [&](std::size_t face) {
        return 1.5 * scalar::fma(v.at[1][j], way_at(face).normal[1], v.at[0][j] * 0.6);
      };
      const auto value = [&](double here, double slope_x, double slope_y, const std::array<double, 3>& by) {
        const double correction = scalar::fma(slope_y, by[1], slope_x * by[0]);
        return limited ? scalar::nonnegative_leaving_value(here, correction)
                       : scalar::leaving_value(here, correction);
      };
      scalar::cut_demand<double> sums{0.0, 0.0, 0.0};
      for (std::size_t face = 0; face < 2; ++face) {
        const double first = x[j] * to[face][0], second = x[n + j] * to[face][1];
        sums.add(step * outward(face), first + second, std::abs(first) + std::abs(second));
      }
      const double factor = sums.factor(u.at[0][j], kept[j]);
      ASSERT_EQ(slopes.all[j], factor * x[j]);
      ASSERT_EQ(slopes.all[n + j], factor * x[n + j]);
      ASSERT_EQ(share[j], outward(0));
      const double leaving = value(u.at[0][j], slopes.all[j], slopes.all[n + j], to[0]),
                   entering = value(u.at[1][j], beyond.all[j], beyond.all[n + j], other.vector);
      const bool leaves = outward(0) > 0.0;
      ASSERT_EQ(values[j], leaves ? leaving : 7.0);
      ASSERT_EQ(alone[j], leaves ? leaving : 0.0);
      ASSERT_EQ(to_row[j], scalar::negative_fma(outward(0), leaves ? leaving : u.at[1][j], 0.5));
      ASSERT_EQ(to_line[j], scalar::negative_fma(outward(0), leaves ? leaving : entering, 0.5));
    }
  }
}

}  // namespace semidiscrete_formulas_test
