#pragma once

#include <apsis/core/random_source.hpp>
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/integrate/array_state.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace apsis {

/// Problems for largest_step on which methods lose a property soon after the guaranteed step. Dimensionless,
/// Δt_FE = 1.

/// u_i' = u_{i−1} − u_i on a ring: advection by first-order upwind. For τ ≤ 1 a forward Euler step u + τT(u)
/// is a convex combination of u and u shifted by one cell. It preserves every convex functional that is
/// invariant under the shift. Q = 0.
class ring_advection {
 public:
  using state = std::vector<double>;  ///< u around the ring
  using real = double;                ///< number type of time and coefficients

  /// acc ← (fresh ? 0 : acc) + α u + β T(u) for every target.
  void add_transport(double, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& {
      work_.resize(u.size());
      for (std::size_t i = 0; i < u.size(); ++i) work_[i] = u[(i + u.size() - 1) % u.size()] - u[i];
      return work_;
    });
  }
  /// Leaves u unchanged: Q = 0.
  void solve_collision(double, double, double, state&) {}
  /// Leaves u unchanged.
  void advance_collision(double, double, state&) {}
  /// acc ← (fresh ? 0 : acc) + α u for every target.
  void add_collision(double, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& {
      work_.assign(u.size(), 0.0);
      return work_;
    });
  }
  /// Δt_FE = 1.
  double forward_euler_step(double, const state&) const { return 1.0; }

 private:
  state work_;
};

/// Returns a step, a spike, a comb and `random` random rows in [0, 1], each of `cells` numbers.
std::vector<std::vector<double>> adversarial_rows(std::size_t cells, int random);

/// A problem whose T and Q are different operators at every stage. The theory allows this, and on such
/// problems its bounds are sharp. The last number of the state is a clock, θ' = θ, whose value identifies the
/// stage. The other numbers z have
///   T(u) = S_θ z − z,   Q(u) = (E_θ(mass z) − z)/ε.
/// The linear map S_θ and the equilibrium E_θ preserve the property. Both may depend on θ arbitrarily, and Q
/// conserves θ. Properties 1–5 of the paper therefore hold, with Δt_FE = 1. Clock values are numbered 0, 1, …
/// in the order of their occurrence.
class staged_problem {
 public:
  using state = std::vector<double>;  ///< z, followed by the clock
  using real = double;                ///< number type of time and coefficients
  /// out ← S_k z for the k-th value of the clock; `out` has the size of z.
  using motion = std::function<void(int k, std::span<const double> z, std::span<double> out)>;
  /// out ← E_k(mass), for the k-th value of the clock.
  using equilibrium = std::function<void(int k, double mass, std::span<double> out)>;

  /// With ε = infinity there are no collisions, and E is not used. Throws input_error unless ε > 0.
  staged_problem(motion move, equilibrium relax, double epsilon);

  /// acc ← (fresh ? 0 : acc) + α u + β T(u) for every target.
  void add_transport(double t, const state& u, std::span<const target<state, double>> targets);
  /// u ← v with v = u + a Q(v) + b Q̇(v), in closed form.
  void solve_collision(double t, double a, double b, state& u);
  /// u ← v(s) of v' = Q(v), v(0) = u.
  void advance_collision(double t, double s, state& u);
  /// acc ← (fresh ? 0 : acc) + α u + β Q(u) for every target.
  void add_collision(double t, const state& u, std::span<const target<state, double>> targets);
  /// Δt_FE = 1.
  double forward_euler_step(double, const state&) const { return 1.0; }

 private:
  int number_of(double clock);
  void relax(const relaxation_weights<double>& weights, state& u);

  motion move_;
  equilibrium relax_;
  double epsilon_;
  std::map<double, int> seen_;
  state work_;
};

/// Returns the staged problem that is worst for positivity. Cells are words: the last `memory` operators that
/// acted on one of `letters` equilibria or on the initial data. The alphabet of the operators has `letters`
/// shifts. S_k prepends the letter k to every word, and E_k puts all mass into the word of its equilibrium
/// alone. Contributions along different paths therefore do not mix: a negative coefficient of the method
/// becomes a negative number in a cell. Methods with more stages than letters reuse letters.
staged_problem word_problem(int letters, int memory, double epsilon);

/// Returns data with all mass on the word of the initial data; the clock is 1.
std::vector<double> word_data(int letters, int memory);

/// Returns a staged problem with random permutations of `cells` cells, and the mean as equilibrium. A
/// symmetric convex functional of the cells cannot grow.
staged_problem permutation_problem(int cells, double epsilon, std::uint64_t seed);

/// Returns a step, a spike, a comb and random rows of `cells` numbers, each followed by the clock.
std::vector<std::vector<double>> permutation_data(int cells, int random);

/// Returns Σ_i h(u_i) over all but the last `ignored` numbers, with h the maximum of a few
/// random affine functions.
std::function<double(const std::vector<double>&)> random_symmetric_functional(random_source& random,
                                                                              std::size_t ignored = 0);

/// Returns the distance of the smallest number below 0 as a functional for stays_inside. The last `ignored`
/// numbers do not count.
std::function<double(const std::vector<double>&)> negative_part(std::size_t ignored = 0);

/// Returns Σ_i |u_i − u_{i−1}| on a ring.
double total_variation(const std::vector<double>& u);
/// Returns max |u_i|.
double maximum_norm(const std::vector<double>& u);

}  // namespace apsis
