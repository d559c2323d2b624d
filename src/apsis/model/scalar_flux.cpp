#include <apsis/model/scalar_flux.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace apsis {

const std::vector<std::string>& scalar_flux::names() {
  static const std::vector<std::string> all = {"linear", "burgers", "buckley-leverett"};
  return all;
}

scalar_flux::scalar_flux(const std::string& text, double slope, double viscosity_ratio,
                         const formula_constants& constants)
    : text_(text), b_(slope), M_(viscosity_ratio) {
  const auto found = std::find(names().begin(), names().end(), text);
  kind_ = static_cast<kind>(found - names().begin());  // past the last name: a formula
  if (kind_ == kind::formula)
    formula_ = std::make_unique<expression>(text, source_place{}, formula_kind{{"u"}, false, constants});
}

double scalar_flux::operator()(double u) const {
  switch (kind_) {
    case kind::linear:
      return b_ * u;
    case kind::burgers:
      return 0.5 * u * u;
    case kind::buckley_leverett:
      return u * u / (u * u + M_ * (1.0 - u) * (1.0 - u));
    default:
      return formula_->value(u);
  }
}

double scalar_flux::derivative(double u) const {
  switch (kind_) {
    case kind::linear:
      return b_;
    case kind::burgers:
      return u;
    case kind::buckley_leverett: {
      const double denominator = u * u + M_ * (1.0 - u) * (1.0 - u);
      return 2.0 * M_ * u * (1.0 - u) / (denominator * denominator);
    }
    default:
      return slope_of_formula(u);
  }
}

double scalar_flux::slope_of_formula(double u) const {
  // Truncation h⁴ and rounding 1e-16/h are both near 1e-12.
  const double h = 1e-3 * (1.0 + std::abs(u));
  const auto F = [this, u](double by) { return formula_->value(u + by); };
  const double central = (8.0 * (F(h) - F(-h)) - (F(2.0 * h) - F(-2.0 * h))) / (12.0 * h);
  if (std::isfinite(central)) return central;
  // At an end of the interval on which F is defined.
  const auto one_sided = [&F](double s) { return (4.0 * F(s) - F(2.0 * s) - 3.0 * F(0.0)) / (2.0 * s); };
  const double ahead = one_sided(1e-3 * h);
  return std::isfinite(ahead) ? ahead : one_sided(-1e-3 * h);
}

scalar_flux::wave scalar_flux::fastest(double low, double high) const {
  constexpr int intervals = 2000;
  const double step = (high - low) / intervals;
  const auto at = [this](double u) { return wave{u, std::abs(derivative(u))}; };
  wave best = at(low);
  for (int k = 0; k <= intervals; ++k) {
    const wave here = at(k == intervals ? high : low + k * step);
    if (!std::isfinite(here.speed)) return here;
    if (here.speed > best.speed) best = here;
  }
  // Golden-section search on the two intervals around the best point.
  double left = std::max(low, best.u - step), right = std::min(high, best.u + step);
  for (int k = 0; k < 60 && right > left; ++k) {
    const double cut = (right - left) / std::numbers::phi;
    const wave a = at(right - cut), b = at(left + cut);
    (a.speed > b.speed ? right : left) = a.speed > b.speed ? b.u : a.u;
    if (std::max(a.speed, b.speed) > best.speed) best = a.speed > b.speed ? a : b;
  }
  return best;
}

}  // namespace apsis
