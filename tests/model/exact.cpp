// Exact solutions of models start from the initial data. Without space they satisfy u' = S + Q.
#include <apsis/model/general_model.hpp>
#include <apsis/model/model_registry.hpp>

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace exact_test {

namespace {

std::unique_ptr<apsis::model> make(const apsis::model_entry& entry) {
  apsis::model_config config = apsis::default_config(entry);
  config.velocity = {8.0, 40, apsis::equilibrium_choice::automatic};
  return entry.make(config);
}

std::vector<double> collision(const apsis::general_model& m, const std::vector<double>& u) {
  std::vector<apsis::general_model::number> in(u.begin(), u.end()), out(u.size());
  m.collision(in.data(), out.data());
  std::vector<double> q;
  for (const auto& value : out) q.push_back(static_cast<double>(value));
  return q;
}

}  // namespace

TEST(exact_solution, starts_from_the_initial_data) {
  int known = 0;
  for (const auto* entry : apsis::model_entries()) {
    const auto m = make(*entry);
    for (const auto& data : m->initial()) {
      if (!data.exact) continue;
      ++known;
      check_property(entry->name + ", " + data.name, [&] {
        std::vector<double> u(static_cast<std::size_t>(m->components())), v = u;
        const double x = *rc::gen::inRange(-2000, 2000) * 1e-3;
        data.point_value({x}, u);
        data.exact(0.0, {x}, v);
        RC_ASSERT(u == v);
      });
    }
  }
  EXPECT_GE(known, 1);
}

TEST(exact_solution, of_the_decay_model_satisfies_its_equation) {
  const auto m = make(apsis::find_model("decay"));
  const auto& general = dynamic_cast<const apsis::general_model&>(*m);
  const auto& exact = m->initial().front().exact;
  check_property("u' = Q(u)", [&] {
    const double t = *rc::gen::inRange(1, 2000) * 1e-3, h = 1e-4 * t;
    std::vector<double> before(1), now(1), after(1);
    exact(t - h, {}, before);
    exact(t, {}, now);
    exact(t + h, {}, after);
    const double derivative = (after[0] - before[0]) / (2.0 * h), q = collision(general, now)[0];
    // The central difference has the error h²u'''/6 ≤ (h/t)² u', plus a rounding error of about 1e-16/1e-4.
    RC_ASSERT(std::abs(derivative - q) <= 1e-7 * std::abs(q));
  });
}

}  // namespace exact_test
