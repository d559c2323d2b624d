// Loops over lattices and rings of velocities have the bits of their formulas on single numbers.
#include <apsis/semidiscrete/formulas/lattice.hpp>
#include <apsis/semidiscrete/formulas/rotation.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>
#include <apsis/semidiscrete/lattice_rows.hpp>
#include <apsis/semidiscrete/rotation_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <semidiscrete/number_rows.hpp>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace semidiscrete_formulas_test {
namespace scalar = apsis::scalar;

namespace {

/// A row on a lattice along one direction of motion. Outside of the lattice there is a vacuum.
template <class N>
struct line_of_lattice {
  const apsis::lattice_rows::layout& at;
  const apsis::lattice_rows::flux_rule& rule;
  const double* row;

  int steps(int i) const { return rule.forward ? i : -i; }
  /// Returns the value i points downstream of a point.
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
  /// Returns the flux out of a point by the formulas of add_limited(). The last point has no flux.
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
    // Lines of contiguous points are passed together.
    const apsis::lattice_rows::layout at{*rc::gen::inRange(1, 22), *rc::gen::inRange(1, 22),
                                         random.one_in(2) ? 1 : *rc::gen::inRange(1, 14)};
    const auto n = static_cast<std::size_t>(at.blocks * at.block());
    rows row(3, n, random, any_size);
    // Some rows vary little, as in the bulk of a gas. Most of their points are not limited.
    if (random.one_in(2))
      for (std::size_t i = 0; i < n; ++i) row.all[i] = 1.0 + 0.1 * random.uniform(0.0, 1.0);
    const bool fresh = random.one_in(2);
    const apsis::lattice_rows::flux_rule rule{random.one_in(2), random.one_in(2), random.one_in(2),
                                              random.one_in(4) ? 1.0 : random.uniform(1.0, 30.0)};
    const double rate = random.uniform(0.0, 3.0), beta = random.magnitude(-12.0, 0.0);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      std::vector<double> sum(row.at[1], row.at[1] + n), acc(row.at[2], row.at[2] + n), into_last(at.lines()),
          scratch(apsis::lattice_rows::scratch_size(at.points));
      apsis::lattice_rows::add_changes(at, rule, rate, row.at[0], fresh, sum.data(), into_last.data(),
                                       scratch.data());
      apsis::lattice_rows::add(sum.data(), -beta, static_cast<int>(n), acc.data());
      const line_of_lattice<N> line{at, rule, row.at[0]};
      const int last = rule.forward ? at.points - 1 : 0;
      std::size_t j = 0;
      for (int block = 0; block < at.blocks; ++block)
        for (int point = 0; point < at.points; ++point)
          for (int column = 0; column < at.apart; ++column, ++j) {
            const N flux = line.flux(block, point, column);
            const N upstream = line.flux(block, point - line.steps(1), column);
            const N change = fma(N(rate), upstream - flux, N(fresh ? 0.0 : row.at[1][j]));
            RC_ASSERT(same_bits(sum[j], value_of(change)));
            RC_ASSERT(same_bits(acc[j], value_of(scalar::with_change(N(row.at[2][j]), N(-beta), change))));
            if (point == last)
              RC_ASSERT(same_bits(into_last[static_cast<std::size_t>(block * at.apart + column)],
                                  value_of(upstream)));
          }
      RC_ASSERT(j == n);
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
  /// Returns the fluxes through an edge between the angles edge − 1 and edge, in the direction of a half.
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
  /// Returns the flux through an edge in the direction of a half.
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
    // Some rings vary little. Most of their angles are not limited.
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

}  // namespace semidiscrete_formulas_test
