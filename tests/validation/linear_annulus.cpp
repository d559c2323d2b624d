#include "linear_annulus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>

namespace validation_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double outer_radius = 2.0;
constexpr double pi = std::numbers::pi;

/// T_n(x) = ∫ w^n exp(−w² − x/w) dw over w > 0, for n = 0 to 5.
using transmissions = std::array<double, 6>;

/// Interpolates the transmissions on a grid with x = s⁴. In s, x log x is smooth enough.
class transmission_table {
 public:
  explicit transmission_table(double largest) : scale_(std::pow(largest, 0.25) / cells) {
    for (int i = 0; i <= cells; ++i) values_.push_back(integrated(std::pow(scale_ * i, 4)));
  }
  transmissions at(double x) const {
    const double place = std::sqrt(std::sqrt(x)) / scale_;
    const int i = std::clamp(static_cast<int>(place), 0, cells - 1);
    const double share = place - i;
    transmissions out{};
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n] = (1.0 - share) * values_[static_cast<std::size_t>(i)][n] +
               share * values_[static_cast<std::size_t>(i) + 1][n];
    return out;
  }

 private:
  static constexpr int cells = 4000;

  static transmissions integrated(double x) {
    constexpr int points = 200;
    transmissions out{};
    for (int k = 0; k < points; ++k) {
      // For w = 6 s³ the integrand and its derivatives vanish at w = 0. At w = 6 it is below rounding.
      const double s = (k + 0.5) / points, w = 6.0 * s * s * s;
      double value = 18.0 * s * s / points * std::exp(-w * w - x / w);
      for (double& each : out) {
        each += value;
        value *= w;
      }
    }
    return out;
  }

  double scale_;
  std::vector<transmissions> values_;
};

/// Nodes and weights of Gauss's rule with four points on [0, 1].
constexpr std::array<std::array<double, 2>, 4> four_points = {{{0.069431844202973712, 0.173927422568726929},
                                                               {0.330009478207571868, 0.326072577431273071},
                                                               {0.669990521792428132, 0.326072577431273071},
                                                               {0.930568155797026288, 0.173927422568726929}}};

/// Calls use(x, weight) for a composite rule on [low, high] with panels graded towards both ends.
template <class Use>
void integrate(double low, double high, int panels, const Use& use) {
  const auto edge = [&](int k) {
    const double s = static_cast<double>(k) / panels;
    return low + (high - low) * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
  };
  for (int k = 0; k < panels; ++k)
    for (const auto& [x, weight] : four_points)
      use(std::lerp(edge(k), edge(k + 1), x), weight * (edge(k + 1) - edge(k)));
}

/// A ray that arrives at the radius r, with its beginning and its distance from the axis.
struct ray {
  double angle;   ///< angle from the radius, 0 to π; below π/2 it arrives from inside
  double weight;  ///< weight of the angle, for both signs of it
  double length;
  bool from_inner;
};

/// Returns rays of all angles that arrive at r. At the walls they are those from the gas.
std::vector<ray> rays_at(double r, int panels) {
  std::vector<ray> all;
  // Rays below this angle begin at the inner cylinder.
  const double grazing = r > 1.0 ? std::asin(1.0 / r) : 0.5 * pi;
  const auto add = [&](double from, double to) {
    integrate(from, to, panels, [&](double angle, double weight) {
      const double b = r * std::sin(angle), along = r * std::cos(angle);
      const bool inner = angle < grazing;
      const double start = std::sqrt(std::max((inner ? 1.0 : outer_radius * outer_radius) - b * b, 0.0));
      all.push_back({angle, 2.0 * weight, inner ? along - start : along + start, inner});
    });
  };
  if (r > 1.0) add(0.0, grazing);
  if (r < outer_radius || grazing < 0.5 * pi) add(grazing, 0.5 * pi);
  if (r < outer_radius) add(0.5 * pi, pi);
  return all;
}

/// Radii graded towards the walls, and weights of linear interpolation.
class radial_nodes {
 public:
  explicit radial_nodes(int cells) : r_(cells + 1), cells_(cells) {
    for (int i = 0; i <= cells; ++i) {
      const double s = static_cast<double>(i) / cells;
      r_[i] = 1.0 + s * s * (3.0 - 2.0 * s);
    }
    r_[cells] = outer_radius;
  }
  const VectorXd& all() const { return r_; }
  int size() const { return cells_ + 1; }
  /// Calls use(node, weight) for both neighbours of r.
  template <class Use>
  void neighbours(double r, const Use& use) const {
    const auto next =
        std::clamp<Eigen::Index>(std::upper_bound(r_.begin(), r_.end(), r) - r_.begin(), 1, cells_);
    const double share = std::clamp((r - r_[next - 1]) / (r_[next] - r_[next - 1]), 0.0, 1.0);
    use(next - 1, 1.0 - share);
    use(next, share);
  }

 private:
  VectorXd r_;
  int cells_;
};

constexpr int angle_panels = 12, way_panels = 24;

/// Moments of molecules that arrive at a point, as shares of each source and wall.
class arrivals {
 public:
  arrivals(double delta, int cells) : delta_(delta), nodes_(cells), table_(delta * 2.0 * outer_radius) {}

  const radial_nodes& nodes() const { return nodes_; }

  /// Calls wall(ray, T at its length) and source(ray, node, δ · weight, T at the distance) for all rays to r.
  template <class Wall, class Source>
  void visit(double r, const Wall& wall, const Source& source) const {
    for (const ray& one : rays_at(r, angle_panels)) {
      wall(one, table_.at(delta_ * one.length));
      const double along = r * std::cos(one.angle), b = r * std::sin(one.angle);
      integrate(0.0, one.length, way_panels, [&](double s, double weight) {
        const transmissions T = table_.at(delta_ * s);
        nodes_.neighbours(std::hypot(along - s, b), [&](Eigen::Index node, double share) {
          source(one, node, delta_ * weight * share, T);
        });
      });
    }
  }

 private:
  double delta_;
  radial_nodes nodes_;
  transmission_table table_;
};

}  // namespace

linear_annulus::linear_annulus(double delta, int radii) : delta_(delta), radii_(radii) {}

double linear_annulus::torque() const {
  // By symmetry φ is odd in the angle, ρ = τ = 0, and u = r ω along the circles. On a ray at the distance b
  // from the axis, c·u = w b ω. The inner wall emits 2 w b, the outer one 0.
  const arrivals paths(delta_, radii_);
  const int n = paths.nodes().size();
  MatrixXd system = MatrixXd::Identity(n, n);
  VectorXd right = VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) {
    const auto factor = [&](const ray& one) {
      return one.weight * 2.0 / pi * std::pow(std::sin(one.angle), 2);
    };
    paths.visit(
        paths.nodes().all()[i],
        [&](const ray& one, const transmissions& T) {
          if (one.from_inner) right[i] += factor(one) * T[3];
        },
        [&](const ray& one, Eigen::Index node, double weight, const transmissions& T) {
          system(i, node) -= factor(one) * weight * T[2];
        });
    // A wall emits one half of the directions with its own velocity.
    if (i == 0) right[i] += 0.5;
  }
  const VectorXd omega = system.partialPivLu().solve(right);
  double arriving = 0.0;
  paths.visit(
      1.0, [](const ray&, const transmissions&) {},
      [&](const ray& one, Eigen::Index node, double weight, const transmissions& T) {
        const double s = std::sin(one.angle), c = std::abs(std::cos(one.angle));
        arriving += one.weight * 2.0 / pi * s * s * c * weight * T[3] * omega[node];
      });
  // For free molecules 1/(2√π) leaves and none arrives.
  return 1.0 - 2.0 * std::sqrt(pi) * arriving;
}

double linear_annulus::heat() const {
  // The unknowns are ρ and τ at the radii, and σ of the inner wall. This wall emits σ + c² − 2, and the
  // outer one 0, as a constant in ρ is free. The equations are means over c_z of 1, of q = c² − 3/2, and
  // of their products.
  const arrivals paths(delta_, radii_);
  const int n = paths.nodes().size();
  MatrixXd system = MatrixXd::Identity(2 * n + 1, 2 * n + 1);
  VectorXd right = VectorXd::Zero(2 * n + 1);
  // The sums Σ over powers of w are ⟨1⟩ = 1, ⟨q⟩ = w² − 1, ⟨q²⟩ = (w² − 1)² + 1/2, with a factor w^k.
  const auto one_of = [](const transmissions& T, std::size_t k) { return T[k]; };
  const auto q_of = [](const transmissions& T, std::size_t k) { return T[k + 2] - T[k]; };
  const auto qq_of = [](const transmissions& T, std::size_t k) {
    return T[k + 4] - 2.0 * T[k + 2] + 1.5 * T[k];
  };
  for (int i = 0; i < n; ++i) {
    paths.visit(
        paths.nodes().all()[i],
        [&](const ray& one, const transmissions& T) {
          if (!one.from_inner) return;
          const double factor = one.weight / pi;
          // c² − 2 = q − 1/2.
          system(i, 2 * n) -= factor * one_of(T, 1);
          right[i] += factor * (q_of(T, 1) - 0.5 * one_of(T, 1));
          system(n + i, 2 * n) -= factor * q_of(T, 1) * 2.0 / 3.0;
          right[n + i] += factor * (qq_of(T, 1) - 0.5 * q_of(T, 1)) * 2.0 / 3.0;
        },
        [&](const ray& one, Eigen::Index node, double weight, const transmissions& T) {
          const double factor = one.weight / pi * weight;
          system(i, node) -= factor * one_of(T, 0);
          system(i, n + node) -= factor * q_of(T, 0);
          system(n + i, node) -= factor * q_of(T, 0) * 2.0 / 3.0;
          system(n + i, n + node) -= factor * qq_of(T, 0) * 2.0 / 3.0;
        });
  }
  // Half of the directions leave the inner wall: ⟨1⟩ = 1/2, ⟨q⟩ = 0, ⟨q²⟩ = 3/4.
  system(0, 2 * n) -= 0.5;
  right[0] += -0.25;
  right[n] += 0.5;
  // No mass crosses the inner wall. σ/(2√π) leaves it.
  const auto arriving = [&](const auto& use) {
    paths.visit(
        1.0, [](const ray&, const transmissions&) {},
        [&](const ray& one, Eigen::Index node, double weight, const transmissions& T) {
          use(one.weight / pi * std::abs(std::cos(one.angle)) * weight, node, T);
        });
  };
  system(2 * n, 2 * n) = 0.5 / std::sqrt(pi);
  arriving([&](double factor, Eigen::Index node, const transmissions& T) {
    system(2 * n, node) -= factor * one_of(T, 1);
    system(2 * n, n + node) -= factor * q_of(T, 1);
  });
  const VectorXd solution = system.partialPivLu().solve(right);
  double energy = 0.0;
  arriving([&](double factor, Eigen::Index node, const transmissions& T) {
    // c² = q + 3/2.
    energy += factor * (solution[node] * (q_of(T, 1) + 1.5 * one_of(T, 1)) +
                        solution[n + node] * (qq_of(T, 1) + 1.5 * q_of(T, 1)));
  });
  // (2σ + 2)/(2√π) leaves. Free molecules of the outer wall bring back 2σ/(2√π).
  return (2.0 * solution[2 * n] + 2.0 - 2.0 * std::sqrt(pi) * energy) / 2.0;
}

}  // namespace validation_test
