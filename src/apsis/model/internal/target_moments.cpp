#include <apsis/model/internal/target_moments.hpp>

#include <Eigen/Dense>

namespace apsis {

target_correction correction_of(const target_defect& found, int d, double variance) {
  target_correction by{};
  by.a = -(found.energy - 0.5 * d * found.mass) / (d * variance);
  by.k = -found.mass - by.a * d * variance;
  for (std::size_t i = 0; i < static_cast<std::size_t>(d); ++i)
    by.l[i] = -found.momentum[i] / std::sqrt(variance);
  return by;
}

moments_of_product::moments_of_product(const line_moments& lines, int dimensions)
    : lines_(lines), d_(static_cast<std::size_t>(dimensions)) {
  for (std::size_t k = 0; k < d_; ++k) square_ += lines.of[k][2];
  for (std::size_t k = 0; k < d_; ++k) {
    const auto& of = lines.of[k];
    of_square_[k] = of[3] + of[1] * (square_ - of[2]);
    fourth_ += of[4] + of[2] * (square_ - of[2]);
  }
}

bool moments_of_product::correct(target_shape& shape) const {
  switch (d_) {
    case 1:
      return correct_in<1>(shape);
    case 2:
      return correct_in<2>(shape);
    default:
      return correct_in<3>(shape);
  }
}

template <std::size_t D>
bool moments_of_product::correct_in(target_shape& shape) const {
  target_defect found = defect_of<D>(shape);
  double best = 1e300;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const double size = found.size();
    if (size <= target_rounding) return true;
    if (!(size < 0.7 * best)) return size <= target_accuracy;
    best = size;
    const target_correction by = correction_of(found, static_cast<int>(d_), shape.variance);
    by.add_to(shape.of_g, static_cast<int>(d_));
    add(by, shape.variance, found);
  }
  return false;
}

/// ⟨Π c_k^p_k⟩.
template <std::size_t D>
double moments_of_product::mean(const powers& p) const {
  double product = 1.0;
  for (std::size_t k = 0; k < D; ++k) product *= lines_.of[k][p[k]];
  return product;
}

/// ⟨P Π c_k^p_k⟩.
template <std::size_t D>
double moments_of_product::mean(const target_polynomial& polynomial, const powers& p) const {
  double sum = polynomial.k * mean<D>(p);
  for (std::size_t k = 0; k < D; ++k) {
    powers with = p;
    ++with[k];
    sum += polynomial.l[k] * mean<D>(with);
    for (std::size_t l = 0; l < D; ++l) {
      powers pair = with;
      ++pair[l];
      sum += polynomial.a[k][l] * mean<D>(pair);
      ++pair[l];
      sum += polynomial.w[k] * mean<D>(pair);
    }
  }
  return sum;
}

template <std::size_t D>
target_defect moments_of_product::defect_of(const target_shape& shape) const {
  target_defect found;
  found.mass = mean<D>(shape.of_g, {}) - 1.0;
  double energy = lines_.others > 0.0 ? lines_.others * (mean<D>(shape.of_h, {}) - 1.0) : 0.0;
  for (std::size_t k = 0; k < D; ++k) {
    powers p{};
    p[k] = 1;
    found.momentum[k] = mean<D>(shape.of_g, p) / std::sqrt(shape.variance);
    p[k] = 2;
    energy += mean<D>(shape.of_g, p) - mean<D>(p);
  }
  found.energy = 0.5 * energy / shape.variance;
  return found;
}

/// Adds the moments of a correction.
void moments_of_product::add(const target_correction& by, double variance, target_defect& found) const {
  const double speed = std::sqrt(variance);
  double mean = 0.0, energy = by.k * square_ + by.a * fourth_;
  for (std::size_t k = 0; k < d_; ++k) {
    mean += by.l[k] * lines_.of[k][1];
    energy += by.l[k] * of_square_[k];
  }
  for (std::size_t k = 0; k < d_; ++k) {
    const auto& of = lines_.of[k];
    // ⟨c_k β·c⟩
    const double with_mean = of[1] * (by.k + mean - by.l[k] * of[1]) + by.l[k] * of[2];
    found.momentum[k] += (with_mean + by.a * of_square_[k]) / speed;
  }
  found.mass += by.k + mean + by.a * square_;
  found.energy += 0.5 * energy / variance;
}

template <std::size_t D>
double moments_of_row::mean(const target_polynomial& polynomial, const central_sums::exponents& p) const {
  double sum = polynomial.k * sums_[p];
  for (std::size_t k = 0; k < D; ++k) {
    central_sums::exponents with = p;
    ++with[k];
    sum += polynomial.l[k] * sums_[with];
    for (std::size_t l = 0; l < D; ++l) {
      central_sums::exponents pair = with;
      ++pair[l];
      sum += polynomial.a[k][l] * sums_[pair];
    }
  }
  return sum / contents_.rho;
}

template <std::size_t D>
target_defect moments_of_row::defect_of(const target_shape& shape) const {
  target_defect found;
  found.mass = mean<D>(shape.of_g, {}) - 1.0;
  double energy = contents_.others * mean<D>(shape.of_h, {}) - contents_.energy;
  for (std::size_t k = 0; k < D; ++k) {
    central_sums::exponents p{};
    p[k] = 1;
    found.momentum[k] = mean<D>(shape.of_g, p) / std::sqrt(shape.variance);
    p[k] = 2;
    energy += mean<D>(shape.of_g, p);
  }
  found.energy = 0.5 * energy / shape.variance;
  return found;
}

/// The moments of functions φ = (1, c_k/√V, ½|c|²/V) times each other give the correction Σ y_i φ_i.
template <int size>
target_correction moments_of_row::correction_of_row(const target_defect& found, double variance) const {
  using matrix = Eigen::Matrix<double, size, size>;
  using vector = Eigen::Matrix<double, size, 1>;
  constexpr int energy = size - 1;
  const double speed = std::sqrt(variance);
  matrix products = matrix::Zero();
  vector defect;
  products(0, 0) = sums_.along({});
  defect[0] = found.mass;
  defect[energy] = found.energy;
  for (std::size_t k = 0; k < d_; ++k) {
    const auto row = static_cast<Eigen::Index>(k) + 1;
    defect[row] = found.momentum[k];
    products(row, 0) = sums_.along({k}) / speed;
    products(energy, 0) += 0.5 * sums_.along({k, k}) / variance;
    for (std::size_t l = 0; l < d_; ++l) {
      products(row, static_cast<Eigen::Index>(l) + 1) = sums_.along({k, l}) / variance;
      products(energy, row) += 0.5 * sums_.along({k, l, l}) / (variance * speed);
      products(energy, energy) += 0.25 * sums_.along({k, k, l, l}) / (variance * variance);
    }
  }
  const vector y = -contents_.rho * products.template selfadjointView<Eigen::Lower>().llt().solve(defect);
  target_correction by{};
  by.k = y[0];
  for (std::size_t k = 0; k < d_; ++k) by.l[k] = y[static_cast<Eigen::Index>(k) + 1] / speed;
  by.a = 0.5 * y[energy] / variance;
  return by;
}

/// The equations are linear: the correction of a small defect is exact to rounding, unless they are singular
/// because nearly all of the row is at a few points.
template <int size>
bool moments_of_row::correct_by(target_shape& shape) const {
  constexpr double small = 1e-2;
  for (int iteration = 0; iteration < 4; ++iteration) {
    const target_defect found = defect_of<size - 2>(shape);
    if (found.size() <= target_rounding) return true;
    correction_of_row<size>(found, shape.variance).add_to(shape.of_g, static_cast<int>(d_));
    if (found.size() < small) return defect_of<size - 2>(shape).size() <= target_accuracy;
  }
  return false;
}

bool moments_of_row::correct(target_shape& shape) const {
  switch (d_) {
    case 1:
      return correct_by<3>(shape);
    case 2:
      return correct_by<4>(shape);
    default:
      return correct_by<5>(shape);
  }
}

}  // namespace apsis
