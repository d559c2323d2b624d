#include <apsis/scheme/cell_polynomials.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace apsis {
namespace {

/// Returns the value of a cell from −1 to `cells`. Beyond the ends it extrapolates by the parabola through
/// three cells, or the line through two.
double continued(const line_rows& rows, int cell, int k) {
  const int n = rows.cells;
  if (cell >= 0 && cell < n) return rows.at(cell, k);
  const int step = cell < 0 ? 1 : -1, first = cell + step;
  if (n == 1) return rows.at(first, k);
  if (n == 2) return 2.0 * rows.at(first, k) - rows.at(first + step, k);
  return 3.0 * (rows.at(first, k) - rows.at(first + step, k)) + rows.at(first + 2 * step, k);
}

/// Returns the minimum of value + a ξ + b (ξ² − offset) on |ξ| ≤ ½.
double smallest(double value, double a, double b, double offset) {
  const double end = value - 0.5 * std::abs(a) + b * (0.25 - offset);
  if (!(b > 0.0) || std::abs(a) >= b) return end;
  return value - 0.25 * a * a / b - b * offset;
}

}  // namespace

double line_rows::at(int cell, int k) const {
  return values[static_cast<std::size_t>(cell) * static_cast<std::size_t>(components) +
                static_cast<std::size_t>(k)];
}

cell_polynomials::cell_polynomials(const line_rows& rows, bool nonnegative)
    : lower_(rows.lower), width_(rows.width()), cells_(rows.cells), components_(rows.components) {
  const double offset = rows.second_moment;
  std::vector<double> scales(static_cast<std::size_t>(components_));
  for (int cell = 0; cell < cells_; ++cell)
    for (int k = 0; k < components_; ++k) {
      double& scale = scales[static_cast<std::size_t>(k)];
      scale = std::max(scale, std::abs(rows.at(cell, k)));
    }
  of_.reserve(rows.values.size());
  for (int cell = 0; cell < cells_; ++cell)
    for (int k = 0; k < components_; ++k) {
      const double value = rows.at(cell, k), scale = scales[static_cast<std::size_t>(k)] / cells_;
      if (scale == 0.0) {
        of_.push_back({value, 0.0, 0.0});
        continue;
      }
      // Differences are in units of the scale, so that their squares neither overflow nor vanish.
      const double left = (value - continued(rows, cell - 1, k)) / scale,
                   right = (continued(rows, cell + 1, k) - value) / scale;
      const double slope = 0.5 * (left + right), bend = right - left;
      const auto weight = [](double linear, double smoothness) {
        return linear / ((1.0 + smoothness) * (1.0 + smoothness));
      };
      const double w_left = weight(0.25, left * left), w_right = weight(0.25, right * right),
                   w_centre = weight(0.5, slope * slope + 13.0 / 3.0 * bend * bend);
      const double total = w_left + w_right + w_centre;
      double a = scale * (w_left * left + w_right * right + w_centre * slope) / total,
             b = scale * w_centre * bend / total;
      if (nonnegative) {
        const double lowest = smallest(value, a, b, offset);
        // Scales slightly more than necessary, so that the minimum is not negative after rounding.
        constexpr double margin = 1.0 - 1e-14;
        const double keep = value <= 0.0 ? 0.0 : lowest < 0.0 ? margin * value / (value - lowest) : 1.0;
        a *= keep;
        b *= keep;
      }
      of_.push_back({value - b * offset, a, b});
    }
}

void cell_polynomials::operator()(double x, std::span<double> u) const {
  const double place = (x - lower_) / width_;
  const int cell = static_cast<int>(std::clamp(std::floor(place), 0.0, cells_ - 1.0));
  const double xi = std::clamp(place - (cell + 0.5), -0.5, 0.5);
  const parabola* of =
      of_.data() + static_cast<std::ptrdiff_t>(cell) * static_cast<std::ptrdiff_t>(components_);
  for (int k = 0; k < components_; ++k)
    u[static_cast<std::size_t>(k)] = of[k].c0 + xi * (of[k].c1 + xi * of[k].c2);
}

std::vector<double> cell_polynomials::jumps() const {
  std::vector<double> faces;
  for (int cell = 1; cell < cells_; ++cell) faces.push_back(lower_ + cell * width_);
  return faces;
}

}  // namespace apsis
