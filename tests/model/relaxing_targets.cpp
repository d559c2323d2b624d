// Stage solves of models with relaxing moments in their target (Shakhov, ES-BGK) satisfy the equation that
// defines a stage. The derivative Q̇ = Q'Q is a difference quotient.
#include <apsis/model/gas_target.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace relaxing_targets_test {

namespace {

using row = std::vector<double>;

struct gas_and_model {
  std::unique_ptr<apsis::gas> gas;
  std::unique_ptr<apsis::model> equation;
  const apsis::relaxation_model& relaxation() const {
    return dynamic_cast<const apsis::relaxation_model&>(*equation);
  }
};

/// Kinds 1 to 3 are lines in 1 to 3 dimensions, kinds 4 and 5 rings about the third or the first component.
constexpr int first_of_rings = 4, kinds = 5;

/// Returns a gas of one kind of velocities with `points` points of every line.
gas_and_model make(const char* name, int kind, int points, double max = 8.0,
                   const char* tails = "nonnegative") {
  auto parts = apsis::default_config(apsis::find_model(name));
  if (parts.options.contains("tails")) parts.options["tails"] = tails;
  parts.parameters["velocity_dimensions"] = std::min(kind, 3);
  parts.parameters["degrees_of_freedom"] = 3;
  parts.velocity.max = max;
  parts.velocity.points = points;
  if (kind >= first_of_rings) {
    parts.space_dimensions = kind - first_of_rings + 1;
    parts.velocity.rings = points + 4;
    parts.velocity.angles = 24;
  }
  return {std::make_unique<apsis::gas>(parts), apsis::find_model(name).make(parts)};
}

double number(int low, int high) {
  return *rc::gen::inRange(low, high) / 100.0;
}

/// Returns two beams. Their heat flux and stress are a tenth of the pressure or more.
row random_row(const apsis::gas& of) {
  row sum(static_cast<std::size_t>(of.velocities().components()), 0.0), beam(sum.size());
  for (int k = 0; k < 2; ++k) {
    apsis::fluid_state s;
    s.rho = number(20, 100);
    s.T = number(70, 130);
    for (int i = 0; i < of.dimensions(); ++i) s.u[i] = number(-60, 60);
    of.formula(s, 1.0, beam.data());
    for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += beam[j];
  }
  return sum;
}

row collide(const apsis::model& m, const row& u, double epsilon) {
  const auto local = m.make_collision({1, static_cast<std::ptrdiff_t>(u.size()), true});
  row q(u.size());
  local->evaluate({.count = 1, .pitch = static_cast<std::ptrdiff_t>(u.size()), .epsilon = &epsilon}, u.data(),
                  q.data());
  return q;
}

row solved(const apsis::model& m, row u, double a, double b, double epsilon) {
  const auto local = m.make_collision({1, static_cast<std::ptrdiff_t>(u.size()), true});
  local->solve_stage(a, b, {.count = 1, .pitch = static_cast<std::ptrdiff_t>(u.size()), .epsilon = &epsilon},
                     u.data());
  return u;
}

/// Returns the relative error of moments of Gaussians by tails beyond the lines or the midpoint
/// rule on rings.
double error_of_sums(int kind) {
  return kind < first_of_rings ? 1e-7 : 2e-5;
}

double largest(const row& u) {
  double most = 0.0;
  for (const double x : u) most = std::max(most, std::abs(x));
  return most;
}

int points_for(int kind) {
  return kind == 1 ? 32 : kind == 2 ? 24 : 20;
}

void expect_stage_equation(const char* name) {
  const int kind = *rc::gen::inRange(1, kinds + 1);
  const auto m = make(name, kind, points_for(kind), 8.0, "signed");
  const row u = random_row(*m.gas);
  const double epsilon = *rc::gen::element(1.0, 0.3, 0.05), a = number(0, 50), b = -number(0, 20);
  const row v = solved(*m.equation, u, a, b, epsilon);
  const row q = collide(*m.equation, v, epsilon);
  // The central difference along Q has a truncation error h² and a rounding error 1e-16/h.
  const double h = 1e-5 * epsilon;
  row ahead = v, behind = v;
  for (std::size_t j = 0; j < v.size(); ++j) {
    ahead[j] += h * q[j];
    behind[j] -= h * q[j];
  }
  const row q_ahead = collide(*m.equation, ahead, epsilon), q_behind = collide(*m.equation, behind, epsilon);
  double worst = 0.0;
  for (std::size_t j = 0; j < v.size(); ++j) {
    const double derivative = (q_ahead[j] - q_behind[j]) / (2.0 * h);
    worst = std::max(worst, std::abs(v[j] - u[j] - a * q[j] - b * derivative));
  }
  // The target corrects errors of sums, but its derivative does not. A wrong coefficient gives 1e-2.
  const double weights = std::abs(a) / epsilon + std::abs(b) / (epsilon * epsilon);
  RC_ASSERT(worst <= (1e-9 + error_of_sums(kind) * weights) * largest(u));
}

void expect_conservation_and_positivity(const char* name) {
  const int kind = *rc::gen::inRange(1, kinds + 1);
  const auto m = make(name, kind, kind >= 3 ? 10 : 16, 6.0);
  // There are a few molecules anywhere, with energies in h of any size.
  row u(static_cast<std::size_t>(m.equation->components()), 0.0);
  const double scale = std::pow(10.0, *rc::gen::inRange(-4, 5));
  const auto n = static_cast<std::size_t>(m.gas->grid().size());
  for (int k = *rc::gen::inRange(1, 30); k > 0; --k) {
    u[*rc::gen::inRange<std::size_t>(0, n)] += number(1, 100);
    if (m.gas->reduced()) u[n + *rc::gen::inRange<std::size_t>(0, n)] += scale * number(0, 100);
  }
  const double epsilon = *rc::gen::element(0.0, 1e-12, 1e-3, 1.0, 1e6);
  const row v =
      solved(*m.equation, u, *rc::gen::element(0.0, 0.1, 10.0), *rc::gen::element(0.0, -0.1, -10.0), epsilon);
  for (const double x : v) RC_ASSERT(x >= 0.0);
  row before(5), after(5), scales(5);
  m.equation->invariant_densities(u.data(), before.data());
  m.equation->invariant_densities(v.data(), after.data());
  m.equation->invariant_scales(before, scales.data());
  for (std::size_t k = 0; k < m.equation->invariants().size(); ++k)
    RC_ASSERT(std::abs(after[k] - before[k]) <= 3e-14 * scales[k]);
}

/// Expects that a stage conserves the invariants of a gas with these numbers of molecules at some velocities.
void expect_conservation(const char* name, int kind,
                         const std::vector<std::pair<std::size_t, double>>& molecules, double a, double b,
                         double epsilon) {
  const auto m = make(name, kind, 10, 6.0);
  row u(static_cast<std::size_t>(m.equation->components()), 0.0);
  for (const auto& [place, mass] : molecules) u[place] += mass;
  const row v = solved(*m.equation, u, a, b, epsilon);
  row before(5), after(5), scales(5);
  m.equation->invariant_densities(u.data(), before.data());
  m.equation->invariant_densities(v.data(), after.data());
  m.equation->invariant_scales(before, scales.data());
  // The tolerance is that for random molecules above.
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_LE(std::abs(after[k] - before[k]), 3e-14 * scales[k]) << name << " " << k;
}

/// Compares the decay of stress and heat flux in a homogeneous gas over one exact stage with the closed form.
void expect_rates(const char* name, double prandtl, double rate_of_stress, double rate_of_heat) {
  for (int kind = 1; kind <= kinds; ++kind) {
    const auto m = make(name, kind, points_for(kind), 8.0, "signed");
    row u(static_cast<std::size_t>(m.equation->components()), 0.0), beam(u.size());
    for (const double sign : {1.0, -1.0}) {
      apsis::fluid_state s;
      s.rho = sign > 0 ? 0.3 : 0.6;
      s.T = sign > 0 ? 1.3 : 0.8;
      s.u[0] = sign > 0 ? 0.6 : -0.3;
      m.gas->formula(s, 1.0, beam.data());
      for (std::size_t j = 0; j < u.size(); ++j) u[j] += beam[j];
    }
    row omega(5);
    m.gas->moments(u.data(), 0, 1, omega.data());
    const auto state = m.gas->state(omega.data());
    const double A = 0.4, B = 0.3;
    const row v = solved(*m.equation, u, A, -B, 1.0);
    const auto before = compute_central_moments(*m.gas, u.data(), state),
               after = compute_central_moments(*m.gas, v.data(), state);
    const auto decay = [&](double rate) { return 1.0 / (1.0 + rate * A + rate * rate * B); };
    // The heat flux and stress of an equilibrium have the errors of sums.
    EXPECT_NEAR((after.stress[0][0] - state.T) / (before.stress[0][0] - state.T), decay(rate_of_stress),
                error_of_sums(kind))
        << name << kind << prandtl;
    EXPECT_NEAR(after.heat[0] / before.heat[0], decay(rate_of_heat), error_of_sums(kind))
        << name << kind << prandtl;
  }
}

/// Returns the 2-norm of the relaxing moments of a row except the last, or of the difference of two rows.
double size_of_moments(const gas_and_model& m, const row& omega, const row& u, const row* less = nullptr) {
  const auto count = static_cast<std::size_t>(m.relaxation().relaxing_count());
  row s(count), t(count, 0.0);
  m.relaxation().relaxing_moments(u.data(), omega.data(), s.data());
  if (less != nullptr) m.relaxation().relaxing_moments(less->data(), omega.data(), t.data());
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < count; ++k) sum += (s[k] - t[k]) * (s[k] - t[k]);
  return std::sqrt(sum);
}

/// Returns the cut that a solver measures in a stage (a > 0) or in Q/ε (a = 0), and the expected cut. The
/// latter follows from the results of the bounded and of the published target.
std::pair<double, double> measured_and_expected_cut(const char* name, int kind, const row& u, double a,
                                                    double b, double lambda) {
  const auto cut = make(name, kind, points_for(kind), 8.0, "nonnegative"),
             whole = make(name, kind, points_for(kind), 8.0, "signed");
  row omega(5);
  cut.gas->moments(u.data(), 0, 1, omega.data());
  const double epsilon = 1.0;
  const apsis::point_batch at{
      .count = 1, .pitch = static_cast<std::ptrdiff_t>(u.size()), .epsilon = &epsilon};
  const auto local = cut.equation->make_collision({1, at.pitch, true});
  if (a == 0.0) {
    row q(u.size());
    local->evaluate(at, u.data(), q.data());
    const row published = collide(*whole.equation, u, epsilon);
    return {local->take_cut(),
            size_of_moments(cut, omega, q, &published) / (lambda * size_of_moments(cut, omega, u))};
  }
  row v = u;
  local->solve_stage(a, b, at, v.data());
  const row published = solved(*whole.equation, u, a, b, epsilon);
  const double strength = a - b, rate = (lambda * a - lambda * lambda * b) / strength;
  const double measured = local->take_cut();
  EXPECT_EQ(local->take_cut(), 0.0);
  return {measured, size_of_moments(cut, omega, v, &published) * (1.0 + strength) /
                        (strength * rate * size_of_moments(cut, omega, published))};
}

}  // namespace

RC_GTEST_PROP(relaxing_targets, the_cut_is_the_change_of_the_relaxation_of_the_moments, ()) {
  const char* name = *rc::gen::element("shakhov", "es-bgk");
  const int kind = *rc::gen::inRange(1, kinds + 1);
  const auto m = make(name, kind, points_for(kind));
  const row u = random_row(*m.gas);
  row omega(5);
  m.gas->moments(u.data(), 0, 1, omega.data());
  RC_PRE(size_of_moments(m, omega, u) > 1e-3);  // else a quotient of rounding errors
  const double a = *rc::gen::element(0.0, 0.05, 0.5, 5.0), b = a == 0.0 ? 0.0 : -number(0, 200);
  const auto [measured, expected] =
      measured_and_expected_cut(name, kind, u, a, b, std::string(name) == "shakhov" ? 2.0 / 3.0 : 1.5);
  // The moments beyond the grid are 1e-9. They are divided by those of the row and by the weights of a stage,
  // which are at least a twentieth.
  RC_ASSERT(std::abs(measured - expected) <= 1e-4 * (1.0 + expected));
}

TEST(relaxing_targets, a_strong_heat_flux_is_cut_and_a_weak_one_is_not) {
  for (int kind = 1; kind <= kinds; ++kind) {
    const auto m = make("shakhov", kind, points_for(kind));
    row u(static_cast<std::size_t>(m.equation->components())), beam(u.size());
    const auto beams = [&](double hot) {
      apsis::fluid_state s;
      s.rho = s.T = 1.0;
      m.gas->formula(s, 1.0, u.data());
      s.rho = 0.1;
      s.T = hot;
      s.u[0] = hot - 1.0;
      m.gas->formula(s, 1.0, beam.data());
      for (std::size_t j = 0; j < u.size(); ++j) u[j] += beam[j];
      return measured_and_expected_cut("shakhov", kind, u, 0.0, 0.0, 2.0 / 3.0).first;
    };
    EXPECT_GT(beams(3.0), 1e-3) << kind;
    EXPECT_EQ(beams(1.0001), 0.0) << kind;
  }
}

RC_GTEST_PROP(relaxing_targets, shakhov_stages_satisfy_their_equation, ()) {
  expect_stage_equation("shakhov");
}

RC_GTEST_PROP(relaxing_targets, es_bgk_stages_satisfy_their_equation, ()) {
  expect_stage_equation("es-bgk");
}

TEST(relaxing_targets, of_few_molecules_conserve) {
  // Two molecules have a stress in one direction only. For Pr = 2/3 the Gaussian of ES-BGK is then flat.
  expect_conservation("es-bgk", 3, {{55, 0.07}, {476, 0.09}}, 10.0, -10.0, 1e6);
  // A single molecule has the temperature 0, up to the rounding of sums.
  expect_conservation("shakhov", first_of_rings, {{1, 0.01}}, 0.0, -0.1, 0.0);
}

RC_GTEST_PROP(relaxing_targets, shakhov_stages_conserve_and_stay_nonnegative, ()) {
  expect_conservation_and_positivity("shakhov");
}

RC_GTEST_PROP(relaxing_targets, es_bgk_stages_conserve_and_stay_nonnegative, ()) {
  expect_conservation_and_positivity("es-bgk");
}

TEST(relaxing_targets, stress_and_heat_flux_relax_at_the_rates_of_the_prandtl_number) {
  expect_rates("shakhov", 2.0 / 3.0, 1.0, 2.0 / 3.0);
  expect_rates("es-bgk", 2.0 / 3.0, 1.5, 1.0);
  expect_rates("bgk", 1.0, 1.0, 1.0);
}

}  // namespace relaxing_targets_test
