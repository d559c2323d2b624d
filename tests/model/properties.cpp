// Properties 2–5 of the paper for every relaxation model of the registry: a model added tomorrow is tested by
// being there. States are random and nonnegative, some components exactly zero.
#include <apsis/core/relaxation_weights.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace {

using apsis::relaxation_model;

struct named_model {
  const apsis::model_entry* entry;
  std::unique_ptr<apsis::model> made;
  const relaxation_model* relaxation;
};

std::vector<named_model> relaxation_models() {
  std::vector<named_model> all;
  for (const auto* entry : apsis::model_entries()) {
    apsis::model_config config;
    for (const auto& p : entry->parameters) config.parameters[p.name] = p.value;
    config.velocity = {8.0, 40, "auto"};
    auto made = entry->make(config);
    const auto* relaxation = dynamic_cast<const relaxation_model*>(made.get());
    if (relaxation != nullptr) all.push_back({entry, std::move(made), relaxation});
  }
  return all;
}

/// One of the model's initial data at a random place, disturbed by up to 90 % in every component.
std::vector<double> random_state(const relaxation_model& m) {
  std::vector<double> u(static_cast<std::size_t>(m.components()));
  const auto& data = m.initial()[*rc::gen::inRange<std::size_t>(0, m.initial().size())];
  data.point_value(*rc::gen::inRange(0, 2000) * 1e-3, u);
  for (double& value : u) value *= 1.0 + 0.9e-3 * *rc::gen::inRange(-1000, 1001);
  return u;
}

std::vector<double> moments(const relaxation_model& m, const std::vector<double>& u) {
  std::vector<double> omega(static_cast<std::size_t>(m.moment_count()));
  m.moments(u.data(), omega.data());
  return omega;
}

/// Q(u) = C(ω)(E(ω) − u).
std::vector<double> collision(const relaxation_model& m, const std::vector<double>& u) {
  const auto omega = moments(m, u);
  std::vector<double> q(u.size());
  EXPECT_TRUE(m.equilibrium(omega.data(), q.data()));
  const double rate = m.rate(omega.data());
  for (std::size_t k = 0; k < u.size(); ++k) q[k] = rate * (q[k] - u[k]);
  return q;
}

double norm(const std::vector<double>& u) {
  double largest = 0.0;
  for (const double value : u) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

TEST(claims, C14_property_3_collisions_conserve_the_moments) {
  for (const auto& m : relaxation_models()) {
    check_property(m.entry->name, [&] {
      const auto u = random_state(*m.relaxation);
      const auto q = moments(*m.relaxation, collision(*m.relaxation, u));
      // Sums of up to a hundred terms, each with its rounding.
      RC_ASSERT(norm(q) <= 1e-12 * (1.0 + norm(moments(*m.relaxation, u))));
    });
  }
}

TEST(claims, C14_property_4_equilibrium_is_where_the_collision_vanishes) {
  for (const auto& m : relaxation_models()) {
    check_property(m.entry->name, [&] {
      const auto omega = moments(*m.relaxation, random_state(*m.relaxation));
      std::vector<double> e(static_cast<std::size_t>(m.relaxation->components()));
      RC_ASSERT(m.relaxation->equilibrium(omega.data(), e.data()));
      RC_ASSERT(norm(collision(*m.relaxation, e)) <= 1e-12 * norm(e));
      const auto back = moments(*m.relaxation, e);
      for (std::size_t k = 0; k < omega.size(); ++k)
        RC_ASSERT(std::abs(back[k] - omega[k]) <= 1e-13 * (1.0 + norm(omega)));
    });
  }
}

TEST(claims, C14_property_5_derivative_along_the_collision_is_minus_rate_times_it) {
  for (const auto& m : relaxation_models()) {
    check_property(m.entry->name, [&] {
      const auto u = random_state(*m.relaxation);
      const auto q = collision(*m.relaxation, u);
      const double rate = m.relaxation->rate(moments(*m.relaxation, u).data());
      // Q'(u)Q(u) by a fourth-order difference; Q is linear along q, so the step may be large.
      const double h = 1e-2;
      const auto at = [&](double s) {
        auto v = u;
        for (std::size_t k = 0; k < v.size(); ++k) v[k] += s * q[k];
        return collision(*m.relaxation, v);
      };
      const auto p1 = at(h), m1 = at(-h), p2 = at(2 * h), m2 = at(-2 * h);
      for (std::size_t k = 0; k < u.size(); ++k) {
        const double derivative = (8.0 * (p1[k] - m1[k]) - (p2[k] - m2[k])) / (12.0 * h);
        RC_ASSERT(std::abs(derivative + rate * q[k]) <= 1e-11 * (1.0 + rate) * (1.0 + norm(u) + norm(q)));
      }
    });
  }
}

TEST(claims, C15_property_2_backward_euler_on_the_collision_keeps_every_value_nonnegative) {
  for (const auto& m : relaxation_models()) {
    if (!m.relaxation->positive()) continue;
    check_property(m.entry->name, [&] {
      auto u = random_state(*m.relaxation);
      for (double& value : u)
        if (*rc::gen::inRange(0, 5) == 0) value = 0.0;
      const auto omega = moments(*m.relaxation, u);
      std::vector<double> e(u.size());
      RC_PRE(m.relaxation->equilibrium(omega.data(), e.data()));
      const double lambda = std::pow(10.0, *rc::gen::inRange(-12, 13));
      const auto w = apsis::relax_weights(lambda, 0.0, m.relaxation->rate(omega.data()), 1.0);
      for (std::size_t k = 0; k < u.size(); ++k) RC_ASSERT(w.stay * u[k] + w.relax * e[k] >= 0.0);
    });
  }
}

TEST(models, inadmissible_moments_are_refused_with_a_reason) {
  for (const auto& m : relaxation_models()) {
    std::vector<double> omega(static_cast<std::size_t>(m.relaxation->moment_count()), std::nan(""));
    std::vector<double> e(static_cast<std::size_t>(m.relaxation->components()));
    EXPECT_FALSE(m.relaxation->equilibrium(omega.data(), e.data())) << m.entry->name;
    EXPECT_FALSE(m.relaxation->why_inadmissible(omega.data()).empty()) << m.entry->name;
  }
}

TEST(models, bgk_says_how_its_velocity_grid_must_change) {
  const auto complaint = [](double max, int points) {
    apsis::model_config config;
    config.parameters = {{"velocity_dimensions", 1.0}};
    config.velocity = {max, points, "auto"};
    const auto m = apsis::find_model("bgk")->make(config);
    std::vector<double> u(static_cast<std::size_t>(m->components()));
    m->initial()[0].point_value(0.3, u);
    return m->unfit(u.data()).problem;
  };
  EXPECT_EQ(complaint(15.0, 150), "");
  EXPECT_NE(complaint(2.0, 40).find("velocity.max = 2 is too small"), std::string::npos)
      << complaint(2.0, 40);
  EXPECT_NE(complaint(60.0, 20).find("velocity.points = 20 is too few"), std::string::npos)
      << complaint(60.0, 20);
}
