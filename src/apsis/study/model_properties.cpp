#include <apsis/study/model_properties.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace apsis {
namespace {

using row = std::vector<double>;

double norm(const row& u) {
  double largest = 0.0;
  for (const double value : u) largest = maximum(largest, std::abs(value));
  return largest;
}

row moments_of(const relaxation_model& m, const row& u) {
  row omega(static_cast<std::size_t>(m.moment_count()));
  m.moments(u.data(), omega.data());
  return omega;
}

row equilibrium_of(const relaxation_model& m, const row& omega) {
  row e(static_cast<std::size_t>(m.components()));
  if (!m.equilibrium(omega.data(), e.data()))
    throw numerical_error("the state has no equilibrium (" + m.why_inadmissible(omega.data()) +
                          "); choose nonnegative data");
  return e;
}

/// Returns Q(u) = C(ω)(E(ω) − u).
row collision_of(const relaxation_model& m, const row& u) {
  const row omega = moments_of(m, u);
  row q = equilibrium_of(m, omega);
  const double rate = m.rate(omega.data());
  for (std::size_t k = 0; k < u.size(); ++k) q[k] = rate * (q[k] - u[k]);
  return q;
}

/// Returns ‖Q'(u)Q(u) + C Q(u)‖. Q is linear along Q(u), where the moments are constant. The differences
/// may therefore be wide.
double derivative_defect(const relaxation_model& m, const row& u, const row& q, double rate) {
  constexpr double h = 1e-2;
  const auto at = [&](double s) {
    row v = u;
    for (std::size_t k = 0; k < v.size(); ++k) v[k] += s * q[k];
    return collision_of(m, v);
  };
  const row ahead = at(h), behind = at(-h), far_ahead = at(2 * h), far_behind = at(-2 * h);
  double worst = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double derivative = (8.0 * (ahead[k] - behind[k]) - (far_ahead[k] - far_behind[k])) / (12.0 * h);
    worst = maximum(worst, std::abs(derivative + rate * q[k]));
  }
  return worst;
}

made_model make_with(const model_entry& entry, const std::map<std::string, std::string>& texts) {
  model_config config = default_config(entry);
  config.velocity = {8.0, 40, equilibrium_choice::automatic};
  for (const auto& [name, value] : texts) config.options.at(name) = value;
  auto made = entry.make(config);
  const auto* relaxation = made->as_relaxation();
  return {&entry, std::move(made), relaxation};
}

}  // namespace

std::vector<made_model> all_models() {
  std::vector<made_model> all;
  for (const auto* entry : model_entries()) all.push_back(make_with(*entry, {}));
  return all;
}

std::vector<made_model> nonnegative_models() {
  std::vector<made_model> all;
  for (const auto* entry : model_entries()) {
    made_model made = make_with(*entry, {});
    if (!made.equation->positive()) continue;
    if (!made.equation->collisions_keep_sign() && default_config(*entry).options.contains("tails"))
      made = make_with(*entry, {{"tails", "nonnegative"}});
    all.push_back(std::move(made));
  }
  return all;
}

relaxation_defects defects_of(const relaxation_model& m, const std::vector<double>& u) {
  const row omega = moments_of(m, u), e = equilibrium_of(m, omega), q = collision_of(m, u);
  const double rate = m.rate(omega.data());
  row moved = moments_of(m, e);
  for (std::size_t k = 0; k < moved.size(); ++k) moved[k] -= omega[k];
  const double size = std::max(norm(e), std::numeric_limits<double>::min());  // 0 can be its own equilibrium
  return {norm(moments_of(m, q)) / (1.0 + norm(omega)),
          maximum(norm(collision_of(m, e)) / size, norm(moved) / (1.0 + norm(omega))),
          derivative_defect(m, u, q, rate) / ((1.0 + rate) * (1.0 + norm(u) + norm(q)))};
}

std::vector<double> backward_euler_on_collision(const model& m, const std::vector<double>& u, double lambda) {
  const double epsilon = 1.0;
  const std::ptrdiff_t pitch = m.components();
  std::vector<double> v = u;
  m.make_collision({.points = 1, .pitch = pitch})
      ->solve_stage(lambda, 0.0, {.count = 1, .pitch = pitch, .epsilon = &epsilon}, v.data());
  return v;
}

}  // namespace apsis
