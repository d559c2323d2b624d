#include <apsis/model/scalar_flux.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace apsis {

namespace {

double value_of(const system_flux& formula, double u) {
  double F = 0.0;
  formula.evaluate(&u, 1, &F);
  return F;
}

double slope_of(const system_flux& formula, double u, double size) {
  double slope = 0.0;
  return formula.differentiate(&u, 0, size, &slope) ? slope : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

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
    formula_ = std::make_unique<system_flux>(std::vector<std::string>{"u"}, std::vector{text}, constants);
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
      return value_of(*formula_, u);
  }
}

double scalar_flux::derivative(double u, double size) const {
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
      return slope_of(*formula_, u, size);
  }
}

scalar_flux::wave scalar_flux::fastest(double low, double high) const {
  constexpr int intervals = 2000;
  const double step = (high - low) / intervals;
  const double largest = std::max(std::abs(low), std::abs(high)), size = largest > 0.0 ? largest : 1.0;
  const auto at = [this, size](double u) { return wave{u, std::abs(derivative(u, size))}; };
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
