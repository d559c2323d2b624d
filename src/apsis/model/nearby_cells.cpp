#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/nearby_cells.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/nearby_cells.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/exec/transpose-inl.hpp>
#include <apsis/model/formulas/line.hpp>
#include <apsis/model/formulas/nearby.hpp>

#include <algorithm>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using nearby_cells::together;

/// Returns Σ_j b_j x_j c_j^p of every cell in the order of powers_on_line(): number j is in chain j mod 8,
/// and the chains are added by halves. The call next(j, c) returns the numbers x_j of the cells.
template <class Next>
HWY_INLINE sums_of_six_powers<octet> powers_of_cells(const line_powers::points& line, const octet& u,
                                                     const Next& next) {
  static constexpr int by_halves[sum_chains] = {0, 4, 2, 6, 1, 5, 3, 7};
  sums_of_six_powers<octet> waiting[3], chain;  // sums of 1, 2 and 4 chains
  for (int i = 0; i < sum_chains; ++i) {
    chain = {};
    for (int j = by_halves[i]; j < line.n; j += sum_chains) {
      const octet c = octet(line.v[j]) - u, x = next(j, c);
      chain.add(line.b == nullptr ? x : x * octet(line.b[j]), c);
    }
    int level = 0;
    for (; (i >> level & 1) != 0; ++level)
      for (int p = 0; p < 6; ++p) chain.of[p] = waiting[level].of[p] + chain.of[p];
    if (level < 3) waiting[level] = chain;
  }
  return chain;
}

/// Weights along one direction in memory, eight cells side by side.
class lanes_of_direction {
 public:
  lanes_of_direction(const nearby_cells::direction& of, double* lanes)
      : of_(of), u_(octet::load(of.u)), lanes_(lanes) {}

  HWY_INLINE void read() const {
    for (int j = 0; j < of_.line.n; j += together)
      transpose_eight(
          [&](int cell, int k)
              APSIS_PACKED { return load_some(of_.rows[cell] + j + k, std::max(of_.line.n - j - k, 0)); },
          [&](int k, int cell, const pack<wide>& w) APSIS_PACKED { w.store(at(j + k) + cell); });
  }
  HWY_INLINE void write() const {
    for (int j = 0; j < of_.line.n; j += together)
      transpose_eight([&](int k, int cell) APSIS_PACKED { return pack<wide>::load(at(j + k) + cell); },
                      [&](int cell, int k, const pack<wide>& w) APSIS_PACKED {
                        if (const int count = of_.line.n - j - k; count > 0)
                          store_some(w, count, of_.rows[cell] + j + k);
                      });
  }
  HWY_INLINE sums_of_six_powers<octet> sum() const {
    return powers_of_cells(of_.line, u_,
                           [&](int j, const octet&) APSIS_PACKED { return octet::load(at(j)); });
  }
  /// Multiplies the weights by e^(βc + γc²), and returns their sums.
  HWY_INLINE sums_of_six_powers<octet> change(const octet& beta, const octet& gamma) const {
    return powers_of_cells(of_.line, u_, [&](int j, const octet& c) APSIS_PACKED {
      const octet w = changed_weight(octet::load(at(j)), c, beta, gamma);
      w.store(at(j));
      return w;
    });
  }
  HWY_INLINE void multiply(const octet& factor) const {
    for (int j = 0; j < of_.line.n; ++j) (factor * octet::load(at(j))).store(at(j));
  }
  /// Returns v − u.
  HWY_INLINE octet distance(double v) const { return octet(v) - u_; }

 private:
  HWY_INLINE double* at(int j) const { return lanes_ + j * together; }

  const nearby_cells::direction& of_;
  octet u_;
  double* lanes_;
};

void solve(nearby_cells::problem& cells) {
  double speed[together];
  for (int i = 0; i < together; ++i) speed[i] = std::sqrt(cells.T[i]);
  auto newton = nearby_newton<octet>::start(cells.dimensions, octet::load(cells.T), octet::load(speed));
  double* lanes[3];
  double* free = cells.lanes;
  for (int k = 0; k < cells.dimensions; ++k) {
    const auto& line = cells.of[k].line;
    lanes[k] = free;
    free += nearby_cells::numbers_for(line.n);
    const lanes_of_direction direction(cells.of[k], lanes[k]);
    newton.of[k].set_ends(direction.distance(line.v[0]), direction.distance(line.v[line.n - 1]));
    direction.read();
    const auto sums = direction.sum();
    for (int p = 0; p < 6; ++p) newton.of[k].sums[p] = sums.of[p];
  }
  while (newton.advance())
    for (int k = 0; k < cells.dimensions; ++k) {
      const auto sums = lanes_of_direction(cells.of[k], lanes[k]).change(newton.beta[k], newton.gamma);
      for (int p = 0; p < 6; ++p) newton.of[k].sums[p] = sums.of[p];
    }
  newton.found.store(cells.found);
  const octet factor = octet::load(cells.rho) / (octet(cells.weight_of_grid) * newton.mass());
  factor.store(cells.factor);
  for (int k = 0; k < cells.dimensions; ++k) {
    const lanes_of_direction direction(cells.of[k], lanes[k]);
    if (cells.dimensions == 1) direction.multiply(factor);
    direction.write();
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(solve);
}  // namespace

void nearby_cells::solve(problem& of) {
  HWY_DYNAMIC_DISPATCH(solve)(of);
}

}  // namespace apsis
#endif
