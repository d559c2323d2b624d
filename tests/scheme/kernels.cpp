// Kernels of every instruction set agree with scalar implementations of the published formulas.
#include <apsis/core/random_source.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/instruction_sets.hpp>

namespace kernels_test {

namespace {

using apsis::aligned_vector;
using stencil5 = std::array<long double, 5>;

/// Returns the smoothness indicators of Jiang & Shu 1996, (2.16) and (2.17).
std::array<long double, 3> indicators(const stencil5& u) {
  const auto [a, b, c, d, e] = u;
  const auto square = [](long double x) { return x * x; };
  return {13.0L / 12 * square(a - 2 * b + c) + 0.25L * square(a - 4 * b + 3 * c),
          13.0L / 12 * square(b - 2 * c + d) + 0.25L * square(b - d),
          13.0L / 12 * square(c - 2 * d + e) + 0.25L * square(3 * c - 4 * d + e)};
}

/// Returns the value at the right edge with weights (linear weight) × g(k, β).
long double right_edge(const stencil5& u, const std::function<long double(std::size_t)>& g) {
  const auto [a, b, c, d, e] = u;
  const std::array<long double, 3> linear = {0.1L, 0.6L, 0.3L};
  const std::array<long double, 3> candidate = {(2 * a - 7 * b + 11 * c) / 6, (-b + 5 * c + 2 * d) / 6,
                                                (2 * c + 5 * d - e) / 6};
  long double sum = 0, weights = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += linear[k] * g(k) * candidate[k];
    weights += linear[k] * g(k);
  }
  return sum / weights;
}

/// Expected value and tolerance of a kernel. Its smoothness indicators have rounding errors.
struct expected {
  double value, uncertainty;
};

expected jiang_shu(const stencil5& u) {
  const auto beta = indicators(u);
  const auto value =
      right_edge(u, [&](std::size_t k) { return 1 / ((beta[k] + 1e-6L) * (beta[k] + 1e-6L)); });
  return {static_cast<double>(value), 0.0};
}

/// τ is a difference that may consist entirely of rounding errors of β₀ and β₂.
expected borges(const stencil5& u) {
  const auto beta = indicators(u);
  const long double delta = 1e-200L + 1e-6L * u[2] * u[2];
  const auto with = [&](long double tau) {
    return right_edge(u, [&](std::size_t k) { return 1 + std::pow(tau / (beta[k] + delta), 2.0L); });
  };
  const long double tau = std::abs(beta[0] - beta[2]), lost = 1e-15L * (beta[0] + beta[2]);
  return {static_cast<double>(with(tau)), static_cast<double>(std::abs(with(tau + lost) - with(tau)))};
}

/// The scheme of Fu, Hu & Adams 2016, (9) to (13), with C_T = 1e-5 and q = 6. A candidate at the cutoff may
/// be used or not.
expected fu_hu_adams(const stencil5& u) {
  const auto beta = indicators(u);
  const long double delta = 1e-200L + 1e-6L * u[2] * u[2];
  const auto with = [&](long double tau, long double cutoff) {
    std::array<long double, 3> gamma{};
    for (std::size_t k = 0; k < 3; ++k) gamma[k] = std::pow(1 + tau / (beta[k] + delta), 6.0L);
    const long double sum = gamma[0] + gamma[1] + gamma[2];
    return right_edge(u, [&](std::size_t k) { return gamma[k] < cutoff * sum ? 0.0L : 1.0L; });
  };
  const long double tau = std::abs(beta[0] - beta[2]), lost = 1e-15L * (beta[0] + beta[2]);
  const long double value = with(tau, 1e-5L);
  long double uncertainty = 0.0L;
  for (const long double by : {1 - 1e-9L, 1 + 1e-9L})
    uncertainty = std::max(uncertainty, std::abs(with(tau + (by - 1) * 1e9L * lost, by * 1e-5L) - value));
  return {static_cast<double>(value), static_cast<double>(uncertainty)};
}

/// Perturbed rows of a velocity distribution with tails below 1e-150, zeros, and isolated spikes of the
/// height `spike`.
struct pencil {
  int width, cells, ghosts;
  aligned_vector<double> u;
  std::vector<const double*> rows;
};

pencil draw(int width, int cells, int ghosts, std::uint64_t seed, double spike) {
  pencil p{width, cells, ghosts, {}, {}};
  apsis::random_source random(seed);
  for (int i = 0; i < cells + 2 * ghosts; ++i)
    for (int k = 0; k < width; ++k) {
      const double v = 40.0 * (k + 0.5) / width - 20.0, x = 0.2 * i;
      double value = (1.0 + 0.2 * std::sin(x)) * std::exp(-v * v);
      const double kind = random.uniform(0.0, 1.0);
      if (kind < 0.1) value = 0.0;
      if (kind > 0.98) value = spike;
      if (kind > 0.5 && kind < 0.9) value *= random.uniform(0.0, 2.0);
      p.u.push_back(value);
    }
  for (int i = 0; i < cells + 2 * ghosts; ++i) p.rows.push_back(p.u.data() + i * width);
  return p;
}

/// Returns cells i−2 … i+2 of component k.
stencil5 around(const pencil& p, int i, int k) {
  stencil5 u{};
  for (int j = -2; j <= 2; ++j)
    u[static_cast<std::size_t>(j + 2)] = p.rows[static_cast<std::size_t>(i + p.ghosts + j)][k];
  return u;
}

stencil5 mirrored(stencil5 u) {
  std::swap(u[0], u[4]);
  std::swap(u[1], u[3]);
  return u;
}

/// A relative change of β by a few rounding errors changes an edge by that share of the largest value in the
/// stencil. The floor of β, 1e-40 of the largest β, is much smaller.
constexpr double rounding = 2e-14;

void expect_edges(const std::string& name, expected (*formula)(const stencil5&), int width, double spike) {
  const auto scheme = apsis::find_reconstruction(name).make();
  const pencil p = draw(width, 20, scheme->ghost_width(), static_cast<std::uint64_t>(width), spike);
  const auto count = static_cast<std::size_t>(p.cells * width);
  aligned_vector<double> left(count), right(count), out(count), forward;
  for (int k = 0; k < width; ++k) forward.push_back(k % 3 == 0 ? 0.0 : 1.0);
  scheme->edges(p.rows.data() + p.ghosts, p.cells, width, left.data(), right.data());
  scheme->outflow_edges(p.rows.data() + p.ghosts, p.cells, width, forward.data(), out.data());
  for (int i = 0; i < p.cells; ++i)
    for (int k = 0; k < width; ++k) {
      const auto at = static_cast<std::size_t>(i * width + k);
      const auto u = around(p, i, k);
      double size = 0.0;
      for (const auto x : u) size = std::max(size, static_cast<double>(x));
      const auto expect_near = [&](double edge, const expected& from) {
        ASSERT_NEAR(edge, from.value, rounding * size + 2.0 * from.uncertainty)
            << name << " " << testing::PrintToString(u);
      };
      const expected l = formula(mirrored(u)), r = formula(u);
      expect_near(left[at], l);
      expect_near(right[at], r);
      expect_near(out[at], k % 3 == 0 ? l : r);
    }
}

}  // namespace

TEST(kernels, a_scheme_that_defines_both_edges_alone_gets_its_outflow_edges_from_them) {
  class plain final : public apsis::reconstruction {
   public:
    int ghost_width() const override { return scheme_->ghost_width(); }
    int order() const override { return scheme_->order(); }
    void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
      scheme_->edges(rows, count, width, left, right);
    }

   private:
    std::unique_ptr<apsis::reconstruction> scheme_ = apsis::find_reconstruction("weno5-z").make();
  };
  const plain scheme;
  EXPECT_EQ(scheme.operations(true), 0.0) << "not counted";
  for (const int width : {1, 3, 8}) {
    const pencil p = draw(width, 20, scheme.ghost_width(), static_cast<std::uint64_t>(width), 1e3);
    const auto count = static_cast<std::size_t>(p.cells * width);
    aligned_vector<double> left(count), right(count), out(count), forward;
    for (int k = 0; k < width; ++k) forward.push_back(k % 3 == 0 ? 0.0 : 1.0);
    scheme.edges(p.rows.data() + p.ghosts, p.cells, width, left.data(), right.data());
    scheme.outflow_edges(p.rows.data() + p.ghosts, p.cells, width, forward.data(), out.data());
    for (std::size_t at = 0; at < count; ++at)
      ASSERT_EQ(out[at], at % static_cast<std::size_t>(width) % 3 == 0 ? left[at] : right[at]) << at;
  }
}

TEST(kernels, edges_agree_with_the_literature_for_every_instruction_set) {
  for_each_instruction_set([] {
    // For a spike of 1e60 products of the indicators overflow. For 1e37 only numerators do.
    for (const int width : {1, 3, 8, 40, 152})
      for (const double spike : {1e3, 1e37, 1e60}) {
        expect_edges("weno5-z", borges, width, spike);
        expect_edges("weno5-js", jiang_shu, width, spike);
        expect_edges("teno5", fu_hu_adams, width, spike);
      }
  });
}

TEST(kernels, edges_depend_on_their_own_stencil_alone_whatever_the_size_of_other_data) {
  // Otherwise results would depend on the partition into pencils, and thus on the number of threads.
  for_each_instruction_set([] {
    for (const char* name : {"weno5-z", "weno5-js", "teno5"})
      for (const int width : {1, 3, 8, 40})
        for (const double spike : {1e3, 1e20, 1e60}) {
          const auto scheme = apsis::find_reconstruction(name).make();
          const pencil p = draw(width, 20, scheme->ghost_width(), static_cast<std::uint64_t>(width), spike);
          const auto all = static_cast<std::size_t>(p.cells * width), one = static_cast<std::size_t>(width);
          aligned_vector<double> left(all), right(all), out(all), own_left(one), own_right(one), own_out(one);
          const aligned_vector<double> forward(one, 1.0);
          const double* const* rows = p.rows.data() + p.ghosts;
          scheme->edges(rows, p.cells, width, left.data(), right.data());
          scheme->outflow_edges(rows, p.cells, width, forward.data(), out.data());
          for (int i = 0; i < p.cells; ++i) {
            scheme->edges(rows + i, 1, width, own_left.data(), own_right.data());
            scheme->outflow_edges(rows + i, 1, width, forward.data(), own_out.data());
            for (std::size_t k = 0; k < one; ++k) {
              const std::size_t at = static_cast<std::size_t>(i) * one + k;
              ASSERT_EQ(left[at], own_left[k]) << name << " " << spike << " " << i << " " << k;
              ASSERT_EQ(right[at], own_right[k]) << name << " " << spike << " " << i << " " << k;
              ASSERT_EQ(out[at], own_out[k]) << name << " " << spike << " " << i << " " << k;
            }
          }
        }
  });
}

/// One run may use both instruction sets. The flux limiter and the limiter of averages use the same edges.
TEST(kernels, are_tested_for_the_baseline_and_at_least_one_other_instruction_set) {
  int sets = 0;
  for_each_instruction_set([&sets] { ++sets; });
  EXPECT_GE(sets, 2);
}

}  // namespace kernels_test
