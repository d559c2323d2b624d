#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace reconstruction_test {

namespace {

using apsis::reconstruction;

/// Edge values of the middle of several cells with rows of width one.
struct edges {
  double left, right;
};
edges edges_of(const reconstruction& scheme, const std::vector<double>& cells) {
  std::vector<const double*> rows;
  for (const double& c : cells) rows.push_back(&c);
  edges e{};
  scheme.edges(rows.data() + cells.size() / 2, 1, 1, &e.left, &e.right);
  return e;
}

/// Returns the largest edge error for cell averages of f(x) = exp(sin 2πx) on n cells of [0, 1]. The averages
/// come from a ten times finer Simpson rule, with an error below 1e-15 here.
double edge_error(const reconstruction& scheme, int n) {
  const auto f = [](double x) { return std::exp(std::sin(2.0 * std::numbers::pi * x)); };
  const double h = 1.0 / n;
  const auto average = [&](int i) {
    constexpr int parts = 100;
    double sum = 0.0;
    for (int k = 0; k < parts; ++k) {
      const double a = h * (i + static_cast<double>(k) / parts), d = h / parts;
      sum += (f(a) + 4.0 * f(a + 0.5 * d) + f(a + d)) / (6.0 * parts);
    }
    return sum;
  };
  double worst = 0.0;
  for (int i = 0; i < n; ++i) {
    const int g = scheme.ghost_width();
    std::vector<double> cells;
    for (int k = -g; k <= g; ++k) cells.push_back(average(i + k));
    const edges e = edges_of(scheme, cells);
    worst = std::max({worst, std::abs(e.left - f(h * i)), std::abs(e.right - f(h * (i + 1)))});
  }
  return worst;
}

}  // namespace

TEST(reconstruction, says_whether_it_is_linear) {
  // There are jumps everywhere, because weights of TENO are constant for sufficiently smooth data.
  const std::vector<double> a = {0.6, 0.3, 1.1, 0.2, 0.9, 0.4, 0.5};
  for (const auto* entry : apsis::reconstruction_entries()) {
    const auto scheme = entry->make();
    double defect = 0.0;
    for (std::size_t jump = 1; jump < a.size(); ++jump) {
      std::vector<double> b(a.size(), 0.0), sum = a;
      for (std::size_t k = jump; k < a.size(); ++k) {
        b[k] = 1e3;
        sum[k] += 2.0 * b[k];
      }
      defect = std::max(defect, std::abs(edges_of(*scheme, sum).right - edges_of(*scheme, a).right -
                                         2.0 * edges_of(*scheme, b).right));
    }
    EXPECT_EQ(defect < 1e-9, entry->linear) << entry->name << ": " << defect;  // rounding of 1e3
  }
}

TEST(reconstruction, every_scheme_reaches_its_order_at_the_edges) {
  for (const auto* entry : apsis::reconstruction_entries()) {
    const auto scheme = entry->make();
    // In the maximum norm Jiang–Shu weights lose order near smooth extrema unless 1e-6 dominates β. Meshes of
    // 80 and 160 cells are fine enough for that.
    const double slope = std::log2(edge_error(*scheme, 80) / edge_error(*scheme, 160));
    EXPECT_GT(slope, scheme->order() - 0.25) << entry->name;
  }
}

TEST(reconstruction, is_exact_for_constants_and_mirror_symmetric) {
  for (const auto* entry : apsis::reconstruction_entries()) {
    const auto scheme = entry->make();
    check_property(entry->name + " mirrors", [&] {
      const int n = 2 * scheme->ghost_width() + 1;
      std::vector<double> cells;
      for (int i = 0; i < n; ++i) cells.push_back(*rc::gen::inRange(-1000, 1000) * 1e-3);
      const std::vector<double> mirrored(cells.rbegin(), cells.rend());
      const edges a = edges_of(*scheme, cells), b = edges_of(*scheme, mirrored);
      // The order of summation differs, with a few rounding errors of numbers of size one.
      RC_ASSERT(std::abs(a.left - b.right) <= 1e-13);
      RC_ASSERT(std::abs(a.right - b.left) <= 1e-13);
      const edges c = edges_of(*scheme, std::vector<double>(static_cast<std::size_t>(n), 0.7));
      RC_ASSERT(std::abs(c.left - 0.7) <= 1e-15);
      RC_ASSERT(std::abs(c.right - 0.7) <= 1e-15);
    });
  }
}

TEST(reconstruction, uses_the_linear_weights_for_tiny_data) {
  // At 1e-150 every β underflows. The edge value must be that of the fifth-order polynomial, (2a − 13b + 47c
  // + 27d − 3e)/60, as for weights of smooth data.
  for (const char* name : {"weno5-z", "weno5-js"}) {
    const auto scheme = apsis::find_reconstruction(name).make();
    const std::vector<double> shape = {1.0, 0.9, 0.7, 0.65, 0.2};
    std::vector<double> cells;
    for (const double s : shape) cells.push_back(s * 1e-150);
    const double expected =
        (2 * shape[0] - 13 * shape[1] + 47 * shape[2] + 27 * shape[3] - 3 * shape[4]) / 60.0;
    EXPECT_NEAR(edges_of(*scheme, cells).right / 1e-150, expected, 1e-14) << name;
  }
}

TEST(reconstruction, has_finite_edges_for_any_finite_data) {
  for (const auto* entry : apsis::reconstruction_entries()) {
    const auto scheme = entry->make();
    check_property(entry->name + " finite", [&] {
      std::vector<double> cells;
      for (int i = 0; i < 2 * scheme->ghost_width() + 1; ++i) {
        const int exponent = *rc::gen::inRange(-320, 100);
        cells.push_back(*rc::gen::element(0.0, 1.0, 3.7) * std::pow(10.0, exponent));
      }
      const edges e = edges_of(*scheme, cells);
      RC_ASSERT(std::isfinite(e.left));
      RC_ASSERT(std::isfinite(e.right));
    });
  }
}

TEST(reconstruction, does_not_oscillate_at_a_jump) {
  for (const char* name : {"weno5-z", "weno5-js"}) {
    const auto scheme = apsis::find_reconstruction(name).make();
    const edges e = edges_of(*scheme, {1.0, 1.0, 1.0, 0.0, 0.0});
    // The stencils that cross the jump keep weights of about 1e-6 (JS) and below.
    EXPECT_NEAR(e.right, 1.0, 1e-3) << name;
    EXPECT_NEAR(e.left, 1.0, 1e-3) << name;
  }
}

}  // namespace reconstruction_test
