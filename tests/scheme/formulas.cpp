// Kernels and their formulas on single numbers have the same bits in every instruction set, at every point.
#include <apsis/core/random_source.hpp>
#include <apsis/scheme/formulas/limiter.hpp>
#include <apsis/scheme/formulas/row.hpp>
#include <apsis/scheme/formulas/teno5.hpp>
#include <apsis/scheme/formulas/upwind.hpp>
#include <apsis/scheme/formulas/weno5_js.hpp>
#include <apsis/scheme/formulas/weno5_z.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/scheme/row_check.hpp>

#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace scheme_formulas_test {

namespace {

using apsis::random_source;
namespace scalar = apsis::scalar;

struct edges {
  double left, right, outflow;
};

using stencil5 = std::array<double, 5>;

/// Returns the edges of the middle cell. `outflow` is the edge in the direction of motion.
template <class Weights, class N>
edges weno5_edges(const stencil5& u, bool forward) {
  namespace weno5 = scalar::weno5;
  const auto fraction_of = [](const stencil5& c, auto of) {
    using fraction = decltype(of);
    const weno5::window<Weights, N> window(c[0], c[1], c[2], c[3], c[4]);
    fraction cell(weno5::edge_terms<Weights, N>{window});
    if constexpr (!Weights::of_any_size)
      cell.replace_if_too_large(fraction(weno5::edge_terms<weno5::scaled<Weights>, N>(window)));
    return cell;
  };
  using none = weno5::edge_terms<Weights, N>;
  const none any(weno5::window<Weights, N>(0.0, 0.0, 0.0, 0.0, 0.0));
  N left(0.0), right(0.0);
  fraction_of(u, weno5::both_fractions<N>(any)).edges(left, right);
  const stencil5 seen = forward ? u : stencil5{u[4], u[3], u[2], u[1], u[0]};
  const N out = fraction_of(seen, weno5::right_fraction<N>(any)).edge();
  return {value_of(left), value_of(right), value_of(out)};
}

template <class N>
edges edges_of(const std::string& scheme, const stencil5& u, bool forward) {
  if (scheme == "teno5") return weno5_edges<scalar::weights_teno, N>(u, forward);
  if (scheme == "weno5-z") return weno5_edges<scalar::weights_z, N>(u, forward);
  if (scheme == "weno5-z-smooth") return weno5_edges<scalar::weights_z_smooth, N>(u, forward);
  if (scheme == "weno5-js") return weno5_edges<scalar::weights_js, N>(u, forward);
  edges of{};
  if (scheme == "upwind1") {
    of.left = of.right = value_of(scalar::upwind1_edge<N>(u[2]));
  } else if (scheme == "upwind5") {
    of.left = value_of(scalar::upwind5_edge<N>(u[4], u[3], u[2], u[1], u[0]));
    of.right = value_of(scalar::upwind5_edge<N>(u[0], u[1], u[2], u[3], u[4]));
  } else {
    ADD_FAILURE() << scheme << " has no formula here";
  }
  of.outflow = forward ? of.right : of.left;
  return of;
}

}  // namespace

TEST(formulas, edges_are_those_of_single_numbers) {
  for (const std::string name : {"upwind1", "upwind5", "weno5-js", "weno5-z", "weno5-z-smooth"})
    check_property(name, [&name] {
      const int width = *rc::gen::inRange(1, 28), cells = *rc::gen::inRange(1, 9);
      random_source random(*rc::gen::arbitrary<std::uint32_t>());
      const auto scheme = apsis::find_reconstruction(name).make();
      const auto n = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(cells) + 4;
      const auto u = drawn(rows * n, random, any_sign);
      std::vector<double> forward;
      const bool mixed = random.uniform(0.0, 1.0) < 0.5;
      for (std::size_t k = 0; k < n; ++k)
        forward.push_back(mixed ? std::floor(random.uniform(0.0, 2.0)) : k < n / 2 ? 0.0 : 1.0);
      std::vector<const double*> at;
      for (std::size_t i = 0; i < rows; ++i) at.push_back(u.data() + i * n);
      for_each_number([&](auto number, int) {
        std::vector<double> left((rows - 4) * n), right(left), out(left);
        scheme->edges(at.data() + 2, cells, width, left.data(), right.data());
        scheme->outflow_edges(at.data() + 2, cells, width, forward.data(), out.data());
        for (std::size_t i = 0; i < rows - 4; ++i)
          for (std::size_t k = 0; k < n; ++k) {
            const stencil5 c{at[i][k], at[i + 1][k], at[i + 2][k], at[i + 3][k], at[i + 4][k]};
            const edges of = edges_of<decltype(number)>(name, c, forward[k] > 0.5);
            RC_ASSERT(same_bits(left[i * n + k], of.left));
            RC_ASSERT(same_bits(right[i * n + k], of.right));
            RC_ASSERT(same_bits(out[i * n + k], of.outflow));
          }
      });
    });
}

TEST(formulas, limited_edges_are_those_of_single_numbers) {
  check_property("limited edges", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    const auto c = drawn(n, random, any_size), l = drawn(n, random, any_sign), r = drawn(n, random, any_sign);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      auto left = l, right = r;
      apsis::limiter::apply(c.data(), static_cast<int>(n), left.data(), right.data());
      for (std::size_t k = 0; k < n; ++k) {
        N of_left(l[k]), of_right(r[k]);
        scalar::limiter::limit_edges(N(c[k]), of_left, of_right);
        RC_ASSERT(same_bits(left[k], value_of(of_left)));
        RC_ASSERT(same_bits(right[k], value_of(of_right)));
      }
    });
  });
}

TEST(formulas, contents_of_a_row_are_those_of_single_numbers) {
  check_property("contents", [] {
    random_source random(*rc::gen::arbitrary<std::uint32_t>());
    const auto n = static_cast<std::size_t>(*rc::gen::inRange(1, 40));
    auto row = drawn(n, random, any_sign);
    if (random.uniform(0.0, 1.0) < 0.3) row[n / 2] = std::numeric_limits<double>::infinity();
    for_each_number([&](auto number, int) {
      scalar::row_contents<decltype(number)> of(std::numeric_limits<double>::infinity(), 0.0, 0.0);
      for (const double x : row) of.add(x);
      const auto found = apsis::compute_extremes(row.data(), static_cast<int>(n));
      RC_ASSERT(std::isnan(found.lowest) == std::isnan(value_of(of.not_finite)));
      if (!std::isnan(found.lowest)) {
        RC_ASSERT(found.lowest == value_of(of.lowest));  // of zeros, either sign
      }
      RC_ASSERT(found.negative == static_cast<long>(value_of(of.negative)));
    });
    const auto other = drawn(n, random, any_sign);
    for_each_number([&](auto number, int) {
      using N = decltype(number);
      constexpr std::size_t chains = 8;  // in every instruction set
      std::vector<scalar::sums_of_squares<N>> of(chains);
      for (std::size_t k = 0; k < n; ++k) of[k % chains].add(N(row[k]), N(other[k]));
      std::vector<N> difference, size;
      for (const auto& chain : of) {
        difference.push_back(chain.difference);
        size.push_back(chain.size);
      }
      const auto found = apsis::compute_squares(row.data(), other.data(), static_cast<int>(n));
      RC_ASSERT(same_bits(found.difference, sum_of_lanes(difference)));
      RC_ASSERT(same_bits(found.size, sum_of_lanes(size)));
    });
  });
}

}  // namespace scheme_formulas_test
