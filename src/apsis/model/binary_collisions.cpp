#include <apsis/model/internal/binary_collisions.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/velocity/component_name.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

/// Allowed relative difference of sums of velocities; a case may give velocities with twelve digits.
constexpr double same = 1e-11;

std::string text_of(const std::vector<double>& v) {
  return fmt::format("({:g})", fmt::join(v, ", "));
}

std::string text_of(const binary_collision& c) {
  return fmt::format("[{}, {}, {}, {}]", c.i + 1, c.j + 1, c.k + 1, c.l + 1);
}

double square(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double component : v) sum += component * component;
  return sum;
}

/// Returns a key that is the same for every order of the particles and for both directions of a collision.
std::array<int, 4> key_of(const binary_collision& c) {
  std::array<int, 2> a = {std::min(c.i, c.j), std::max(c.i, c.j)},
                     b = {std::min(c.k, c.l), std::max(c.k, c.l)};
  if (b < a) std::swap(a, b);
  return {a[0], a[1], b[0], b[1]};
}

}  // namespace

binary_collisions::binary_collisions(std::vector<std::vector<double>> velocities,
                                     std::vector<binary_collision> collisions)
    : velocities_(std::move(velocities)), collisions_(std::move(collisions)) {
  check_velocities();
  for (std::size_t c = 0; c < collisions_.size(); ++c) {
    check_collision(collisions_[c]);
    for (std::size_t before = 0; before < c; ++before)
      if (key_of(collisions_[before]) == key_of(collisions_[c]))
        throw input_error(fmt::format(
            "model.collisions has {} and {} (they are the same); give one of them, with the sum of "
            "the rates",
            text_of(collisions_[before]), text_of(collisions_[c])));
  }
  if (collisions_.empty()) add_elastic_collisions();
  compute_invariants();
}

void binary_collisions::check_velocities() const {
  if (velocities_.empty() || velocities_.size() > static_cast<std::size_t>(most_velocities))
    throw input_error(
        fmt::format("model.velocities has {} velocities (from 1 to {} are possible); give others",
                    velocities_.size(), most_velocities));
  const std::size_t d = velocities_.front().size();
  for (std::size_t j = 0; j < velocities_.size(); ++j) {
    const auto& v = velocities_[j];
    if (d < 1 || d > 3 || v.size() != d)
      throw input_error(
          fmt::format("model.velocities has velocity {} with {} component{} ({}); give all velocities the "
                      "same number, 1 to 3",
                      j + 1, v.size(), v.size() == 1 ? "" : "s",
                      j == 0 ? "space has at most three dimensions" : fmt::format("velocity 1 has {}", d)));
    if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); }))
      throw input_error(
          fmt::format("model.velocities has velocity {}, {}, which is not finite; give finite components",
                      j + 1, text_of(v)));
    const auto first = std::find(velocities_.begin(), velocities_.end(), v) - velocities_.begin();
    if (first < static_cast<std::ptrdiff_t>(j))
      throw input_error(
          fmt::format("model.velocities has {2} twice (as velocities {0} and {1}); give one of them",
                      first + 1, j + 1, text_of(v)));
  }
}

bool binary_collisions::elastic(const binary_collision& c) const {
  const auto at = [&](int j) -> const std::vector<double>& {
    return velocities_[static_cast<std::size_t>(j)];
  };
  const double before = square(at(c.i)) + square(at(c.j)), after = square(at(c.k)) + square(at(c.l));
  const double scale = std::max(before, after);
  if (std::abs(before - after) > same * scale) return false;
  for (std::size_t d = 0; d < velocities_.front().size(); ++d)
    if (std::abs((at(c.i)[d] + at(c.j)[d]) - (at(c.k)[d] + at(c.l)[d])) > same * std::sqrt(scale))
      return false;
  return true;
}

void binary_collisions::check_collision(const binary_collision& c) const {
  for (const int j : {c.i, c.j, c.k, c.l})
    if (j < 0 || j >= size())
      throw input_error(fmt::format(
          "model.collisions has {}, which names velocity {} (there are {}, numbered from 1); change it",
          text_of(c), j + 1, size()));
  if (!(c.rate > 0.0 && std::isfinite(c.rate)))
    throw input_error(
        fmt::format("model.collisions has {} with the rate {:g} (not a finite number above 0); change it",
                    text_of(c), c.rate));
  if (std::minmax(c.i, c.j) == std::minmax(c.k, c.l))
    throw input_error(fmt::format("model.collisions has {} (it changes no velocity); remove it", text_of(c)));
  if (elastic(c)) return;
  const auto at = [&](int j) -> const std::vector<double>& {
    return velocities_[static_cast<std::size_t>(j)];
  };
  const auto sum = [&](int a, int b) {
    std::vector<double> total = at(a);
    for (std::size_t d = 0; d < total.size(); ++d) total[d] += at(b)[d];
    return text_of(total);
  };
  throw input_error(
      fmt::format("model.collisions has {}, which does not conserve momentum and energy (sums of velocities "
                  "{} and {}, of "
                  "their squares {:g} and "
                  "{:g}); change it",
                  text_of(c), sum(c.i, c.j), sum(c.k, c.l), square(at(c.i)) + square(at(c.j)),
                  square(at(c.k)) + square(at(c.l))));
}

/// Two pairs of velocities that collide have equal values of E + a·P, where E and P are the sums of |v|² and
/// of v. Sorting by this value makes them neighbours. With a vector a that fits no lattice, few other pairs
/// have equal values.
void binary_collisions::add_elastic_collisions() {
  struct pair {
    double value;
    int first, second;
  };
  static constexpr std::array<double, 3> a = {0.7320508075688772, 0.4142135623730951, 0.2360679774997897};
  double largest = 0.0;
  for (const auto& v : velocities_) largest = std::max(largest, 2.0 * square(v));
  const double speed = std::sqrt(largest),
               window = 3.0 * same * largest;  // elastic() accepts only smaller differences
  std::vector<pair> pairs;
  for (int i = 0; i < size(); ++i)
    for (int j = i + 1; j < size(); ++j) {
      const auto &v = velocities_[static_cast<std::size_t>(i)], &w = velocities_[static_cast<std::size_t>(j)];
      pair one{square(v) + square(w), i, j};
      for (std::size_t d = 0; d < v.size(); ++d) one.value += a[d] * speed * (v[d] + w[d]);
      pairs.push_back(one);
    }
  std::sort(pairs.begin(), pairs.end(), [](const pair& p, const pair& q) { return p.value < q.value; });
  for (auto p = pairs.begin(); p != pairs.end(); ++p)
    for (auto q = p + 1; q != pairs.end() && q->value - p->value <= window; ++q) {
      const pair &one = p->first < q->first ? *p : *q, &other = p->first < q->first ? *q : *p;
      const binary_collision found{one.first, one.second, other.first, other.second};
      const bool shared = found.i == found.k || found.j == found.k || found.j == found.l;
      if (!shared && elastic(found)) collisions_.push_back(found);
    }
  std::sort(collisions_.begin(), collisions_.end(), [](const binary_collision& x, const binary_collision& y) {
    return std::array{x.i, x.j, x.k, x.l} < std::array{y.i, y.j, y.k, y.l};
  });
  if (collisions_.empty())
    throw input_error(
        "model.velocities admits no collision (no two pairs of the velocities have the same momentum and "
        "energy); give "
        "more "
        "velocities, with four at the corners of a rectangle");
}

void binary_collisions::compute_invariants() {
  const Eigen::Index n = size();
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(collisions_.size()));
  for (std::size_t c = 0; c < collisions_.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    for (const int j : {collisions_[c].k, collisions_[c].l}) changes(j, column) += 1.0;
    for (const int j : {collisions_[c].i, collisions_[c].j}) changes(j, column) -= 1.0;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposition(changes);
  const Eigen::MatrixXd q = decomposition.householderQ() * Eigen::MatrixXd::Identity(n, n);
  reachable_ = q.leftCols(decomposition.rank());
  projected_ = reachable_.transpose() * changes;

  // An orthonormal basis grows by the part of each candidate outside the span of earlier ones.
  std::vector<Eigen::VectorXd> basis;
  const auto add = [&](const std::string& name, const Eigen::VectorXd& weights) {
    Eigen::VectorXd rest = weights;
    for (int repetition = 0; repetition < 2; ++repetition)
      for (const auto& one : basis) rest -= one.dot(rest) * one;
    if (!(rest.norm() > 1e-9 * weights.norm())) return;
    basis.push_back(rest.normalized());
    invariants_.push_back({name, weights});
  };
  add("mass", Eigen::VectorXd::Ones(n));
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(n);
  for (int d = 0; d < dimensions(); ++d) {
    Eigen::VectorXd component(n);
    for (Eigen::Index j = 0; j < n; ++j)
      component[j] = velocities_[static_cast<std::size_t>(j)][static_cast<std::size_t>(d)];
    energy += 0.5 * component.cwiseAbs2();
    add(component_name("momentum", d, dimensions()), component);
  }
  add("energy", energy);
  int spurious = 0;
  for (Eigen::Index k = decomposition.rank(); k < n; ++k) {
    Eigen::VectorXd rest = q.col(k);
    for (int repetition = 0; repetition < 2; ++repetition)
      for (const auto& one : basis) rest -= one.dot(rest) * one;
    // Columns in the span of the basis leave only rounding errors.
    if (rest.norm() > 1e-7) add(fmt::format("spurious_{}", ++spurious), rest.normalized());
  }
  functionals_.resize(static_cast<Eigen::Index>(invariants_.size()), n);
  for (std::size_t k = 0; k < invariants_.size(); ++k)
    functionals_.row(static_cast<Eigen::Index>(k)) = invariants_[k].weights;
}

void binary_collisions::change(const double* f, double* q) const {
  std::fill_n(q, size(), 0.0);
  for (const auto& c : collisions_) {
    const double rate = c.rate * (f[c.i] * f[c.j] - f[c.k] * f[c.l]);
    q[c.i] -= rate;
    q[c.j] -= rate;
    q[c.k] += rate;
    q[c.l] += rate;
  }
}

void binary_collisions::derivative(const double* f, Eigen::MatrixXd& scratch, Eigen::MatrixXd& result) const {
  scratch.resize(static_cast<Eigen::Index>(collisions_.size()), reachable_.cols());
  for (std::size_t number = 0; number < collisions_.size(); ++number) {
    const auto& c = collisions_[number];
    scratch.row(static_cast<Eigen::Index>(number)) =
        c.rate * (f[c.j] * reachable_.row(c.i) + f[c.i] * reachable_.row(c.j) - f[c.l] * reachable_.row(c.k) -
                  f[c.k] * reachable_.row(c.l));
  }
  result.noalias() = projected_ * scratch;
}

double binary_collisions::frequency(const double* f) const {
  std::array<double, most_velocities> each{};
  for (const auto& c : collisions_) {
    const auto meet = [&](int a, int b) {
      each[static_cast<std::size_t>(a)] += c.rate * std::abs(f[b]);
      each[static_cast<std::size_t>(b)] += c.rate * std::abs(f[a]);
    };
    meet(c.i, c.j);
    meet(c.k, c.l);
  }
  return *std::max_element(each.begin(), each.begin() + size());
}

void binary_collisions::gain_over_loss(const double* u, double alpha, double* v) const {
  if (!std::isfinite(alpha)) return;
  std::array<double, most_velocities> gain{}, loss{};
  const auto at = [&](int j) { return std::max(v[j], 0.0); };
  for (const auto& c : collisions_) {
    const auto become = [&](int a, int b, int to, int and_to) {
      for (const int j : {to, and_to}) gain[static_cast<std::size_t>(j)] += c.rate * (at(a) * at(b));
      loss[static_cast<std::size_t>(a)] += c.rate * at(b);
      loss[static_cast<std::size_t>(b)] += c.rate * at(a);
    };
    become(c.i, c.j, c.k, c.l);
    become(c.k, c.l, c.i, c.j);
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(size()); ++j) {
    const double whole = 1.0 + alpha * loss[j], next = u[j] / whole + alpha * gain[j] / whole;
    if (std::isfinite(whole) && std::isfinite(next)) v[j] = next;
  }
}

namespace {

/// The dual of entropy minimization: the minimum over λ of the convex function Σ_j exp(λ·φ_j) − λ·ω.
class pair_dual {
 public:
  /// `functionals`: φ_kj; `moments`: ω with ω_0 = 1.
  pair_dual(Eigen::MatrixXd functionals, Eigen::VectorXd moments)
      : phi_(std::move(functionals)),
        moments_(std::move(moments)),
        lambda_(Eigen::VectorXd::Zero(moments_.size())) {
    lambda_[0] = -std::log(static_cast<double>(phi_.cols()));
    f_ = density(lambda_);
  }

  /// Runs Newton's method with backtracking until rounding stops it. Returns true if the densities have the
  /// moments. Where the minimum has zeros, densities decrease by a factor e in every iteration.
  bool solve() {
    constexpr int most_iterations = 400;
    constexpr double rounding = 1e-15, accepted = 1e-14;
    for (int iteration = 0; iteration < most_iterations && defect() > rounding; ++iteration)
      if (!iterate()) break;
    for (int repetition = 0; repetition < 3 && defect() > rounding; ++repetition) correct();
    return defect() < accepted;
  }

  const Eigen::VectorXd& densities() const { return f_; }

 private:
  Eigen::VectorXd density(const Eigen::VectorXd& at) const { return (phi_.transpose() * at).array().exp(); }
  double value(const Eigen::VectorXd& at) const { return density(at).sum() - at.dot(moments_); }

  /// Returns the largest difference of a moment, relative to the largest value of this moment for density 1.
  double defect() const {
    return ((phi_ * f_ - moments_).array().abs() / phi_.cwiseAbs().rowwise().maxCoeff().array()).maxCoeff();
  }

  Eigen::VectorXd newton_step() const {
    const Eigen::MatrixXd hessian = phi_ * f_.asDiagonal() * phi_.transpose();
    return hessian.ldlt().solve(moments_ - phi_ * f_);
  }

  bool iterate() {
    const Eigen::VectorXd step = newton_step();
    if (!step.allFinite()) return false;
    const double here = value(lambda_), slope = (phi_ * f_ - moments_).dot(step);
    for (double t = 1.0; t > 1e-12; t *= 0.5) {
      const Eigen::VectorXd next = lambda_ + t * step;
      const double there = value(next);
      if (!(there <= here + 1e-4 * t * slope + 4e-16 * std::abs(here))) continue;
      lambda_ = next;
      f_ = density(lambda_);
      return true;
    }
    return false;
  }

  /// Corrects the moments to first order. Each density is multiplied by nearly 1.
  void correct() {
    const Eigen::VectorXd step = newton_step();
    if (step.allFinite()) f_.array() *= 1.0 + (phi_.transpose() * step).array().max(-0.5);
  }

  Eigen::MatrixXd phi_;
  Eigen::VectorXd moments_, lambda_, f_;
};

}  // namespace

bool binary_collisions::minimize_entropy(const Eigen::VectorXd& moments, double* e) const {
  if (!(moments[0] > 0.0) || !moments.allFinite()) return false;
  pair_dual dual(functionals_.topRows(moments.size()), moments / moments[0]);
  if (!dual.solve()) return false;
  Eigen::Map<Eigen::VectorXd>(e, size()) = moments[0] * dual.densities();
  return true;
}

}  // namespace apsis
