#include "linear_plates.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace validation_test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

linear_plates::linear_plates(double delta, int cells, int speeds)
    : delta_(delta),
      x_(cells + 1),
      speed_(speeds),
      weight_(speeds),
      of_source_(6, MatrixXd::Zero(cells + 1, cells + 1)),
      of_plate_(6, VectorXd::Zero(cells + 1)) {
  for (int i = 0; i <= cells; ++i) {
    const double s = static_cast<double>(i) / cells;
    x_[i] = s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
  }
  for (int j = 0; j < speeds; ++j) {
    const double s = (j + 0.5) / speeds, c = 6.0 * s * s * s;
    speed_[j] = c;
    weight_[j] = 18.0 * s * s / speeds * std::exp(-c * c) / std::sqrt(std::numbers::pi);
  }
  MatrixXd A = MatrixXd::Zero(cells + 1, cells + 1);  // φ = A source + decay · φ(0)
  VectorXd decay(cells + 1);
  for (int j = 0; j < speeds; ++j) {
    decay[0] = 1.0;
    for (int i = 1; i <= cells; ++i) {
      const double h = delta * (x_[i] - x_[i - 1]) / speed_[j], kept = std::exp(-h);
      // ∫ exp(−(h − s)) (1 − s/h, s/h) ds over [0, h], by series where the differences cancel.
      const double mean = h > 1e-3 ? (1.0 - kept) / h : 1.0 - h / 2.0 + h * h / 6.0;
      A.row(i).head(i) = kept * A.row(i - 1).head(i);
      A(i, i - 1) += h > 1e-3 ? mean - kept : h / 2.0 - h * h / 3.0;
      A(i, i) = h > 1e-3 ? 1.0 - mean : h / 2.0 - h * h / 6.0;
      decay[i] = kept * decay[i - 1];
    }
    double w = weight_[j];
    for (std::size_t k = 0; k < of_source_.size(); ++k, w *= speed_[j]) {
      of_source_[k] += w * A;
      of_plate_[k] += w * decay;
    }
  }
}

double linear_plates::half_range(int k) const {
  return (weight_.array() * speed_.array().pow(k)).sum();
}

VectorXd linear_plates::velocity() const {
  // By symmetry u = up − (up mirrored) with up = M u + V.
  const auto n = x_.size();
  return (MatrixXd::Identity(n, n) - of_source_[0] + of_source_[0].colwise().reverse())
      .partialPivLu()
      .solve(of_plate_[0] - of_plate_[0].reverse());
}

double linear_plates::flow_rate() const {
  // With φ = 2 c_y ψ, c ψ_x = δ (u − ψ) + 1/2. Far from the plates, for s = x − 1/2,
  //     ψ = −δ s²/2 + c s − (c² − 1/2)/δ + δ/8,   u = −δ s²/2 + δ/8.
  // The plates emit ψ = 0. The remainder, a layer, thus has the emission −ψ of this solution.
  const auto n = x_.size();
  const MatrixXd both = of_source_[0] + of_source_[0].colwise().reverse();
  const VectorXd emitted = 0.5 * of_plate_[1] + (of_plate_[2] - 0.5 * of_plate_[0]) / delta_;
  const VectorXd u = (MatrixXd::Identity(n, n) - both).partialPivLu().solve(emitted + emitted.reverse());
  double layer = 0.0;
  for (Eigen::Index i = 1; i < n; ++i) layer += (x_[i] - x_[i - 1]) * (u[i] + u[i - 1]);
  return delta_ / 6.0 + layer;
}

double linear_plates::shear_stress() const {
  const VectorXd u = velocity(), up = of_source_[1] * u + of_plate_[1];
  return (up[0] + up[up.size() - 1]) / (2.0 * half_range(1));
}

double linear_plates::heat_flux() const {
  const auto n = x_.size();
  const auto& M = of_source_;
  const auto& V = of_plate_;
  // g is the mean of φ over the tangential components, h that of (c_t² − 1) φ. Their sources are ρ + (c²
  // − 1/2) τ and τ. The plate at 0 emits a + (c² − 1/2)/2 and 1/2. Then ρ = ⟨g⟩ and (3/2) τ = ⟨(c² − 1/2)
  // g + h⟩.
  const MatrixXd with_energy = M[2] - 0.5 * M[0], energy_energy = M[4] - M[2] + 1.25 * M[0];
  const VectorXd plate = V[2] - 0.5 * V[0], plate_energy = V[4] - V[2] + 1.25 * V[0];
  const auto odd = [](const MatrixXd& up) -> MatrixXd { return up - up.colwise().reverse(); };
  MatrixXd system = MatrixXd::Zero(2 * n + 1, 2 * n + 1);
  VectorXd right = VectorXd::Zero(2 * n + 1);
  system.block(0, 0, n, n) = MatrixXd::Identity(n, n) - odd(M[0]);
  system.block(0, n, n, n) = -odd(with_energy);
  system.block(n, 0, n, n) = -odd(with_energy);
  system.block(n, n, n, n) = 1.5 * MatrixXd::Identity(n, n) - odd(energy_energy);
  system.block(0, 2 * n, n, 1) = -odd(V[0]);
  system.block(n, 2 * n, n, 1) = -odd(plate);
  right.head(n) = 0.5 * odd(plate);
  right.segment(n, n) = 0.5 * odd(plate_energy);
  // No mass crosses the plate at 0. The molecules that arrive there are mirror images of those at 1.
  const auto ends = [n](const auto& up) { return (up.row(0) + up.row(n - 1)).eval(); };
  system.block(2 * n, 0, 1, n) = ends(M[1]);
  system.block(2 * n, n, 1, n) = ends(M[3]) - 0.5 * ends(M[1]);
  system(2 * n, 2 * n) = ends(V[1])[0];
  right[2 * n] = -0.5 * (ends(V[3]) - 0.5 * ends(V[1]))[0];
  const VectorXd solution = system.partialPivLu().solve(right);
  const VectorXd rho = solution.head(n), tau = solution.segment(n, n);
  const double emitted = solution[2 * n];
  const double heat =
      ((ends(M[3]) - 0.5 * ends(M[1])) * rho + (ends(M[5]) - ends(M[3]) + 1.25 * ends(M[1])) * tau)[0] +
      emitted * (ends(V[3]) - 0.5 * ends(V[1]))[0] + 0.5 * (ends(V[5]) - ends(V[3]) + 1.25 * ends(V[1]))[0];
  // Without collisions ⟨c (c² − 1/2) g + c h⟩ = 1/√π, from half Maxwellians of ±1/2 with equal mass fluxes.
  return heat * std::sqrt(std::numbers::pi);
}

}  // namespace validation_test
