// Inputs that models refuse, and the same bits of batches and single rows. Properties 2–5 of the paper
// are in tests/study/model_properties.cpp.
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace properties_test {

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
    apsis::model_config config = apsis::default_config(*entry);
    config.velocity = {8.0, 40, apsis::equilibrium_choice::automatic};
    auto made = entry->make(config);
    const auto* relaxation = dynamic_cast<const relaxation_model*>(made.get());
    if (relaxation != nullptr) all.push_back({entry, std::move(made), relaxation});
  }
  return all;
}

}  // namespace

TEST(models, inadmissible_moments_are_refused_with_a_reason) {
  for (const auto& m : relaxation_models()) {
    std::vector<double> omega(static_cast<std::size_t>(m.relaxation->moment_count()), std::nan(""));
    std::vector<double> e(static_cast<std::size_t>(m.relaxation->components()));
    EXPECT_FALSE(m.relaxation->equilibrium(omega.data(), e.data())) << m.entry->name;
    EXPECT_FALSE(m.relaxation->why_inadmissible(omega.data()).empty()) << m.entry->name;
  }
}

TEST(models, batches_of_rows_give_the_bits_of_single_rows) {
  for (const auto& m : relaxation_models()) {
    const relaxation_model& model = *m.relaxation;
    const auto moments = static_cast<std::size_t>(model.moment_count());
    const auto size = static_cast<std::size_t>(model.components()), pitch = size + 3;
    constexpr int rows = 21;  // more than one batch, and a multiple of no vector width
    std::vector<double> u(rows * pitch), e(rows * pitch, -7.0), omega(rows * moments);
    for (std::size_t p = 0; p < rows; ++p)
      model.initial().front().point_value({0.07 * static_cast<double>(p)}, {u.data() + p * pitch, size});
    model.moments_of_rows(u.data(), static_cast<std::ptrdiff_t>(pitch), rows, omega.data());
    ASSERT_EQ(model.equilibria(omega.data(), rows, e.data(), static_cast<std::ptrdiff_t>(pitch)), rows);
    std::vector<double> one(size), of_one(moments);
    for (std::size_t p = 0; p < rows; ++p) {
      model.moments(u.data() + p * pitch, of_one.data());
      EXPECT_TRUE(std::equal(of_one.begin(), of_one.end(), omega.data() + p * moments)) << m.entry->name;
      ASSERT_TRUE(model.equilibrium(of_one.data(), one.data()));
      EXPECT_TRUE(std::equal(one.begin(), one.end(), e.data() + p * pitch)) << m.entry->name << " " << p;
      EXPECT_EQ(e[p * pitch + size], -7.0) << "padding between the rows is left alone";
    }
    for (const std::size_t bad : {std::size_t{0}, std::size_t{5}, std::size_t{17}}) {
      auto spoilt = omega;
      spoilt[bad * moments] = std::nan("");
      EXPECT_EQ(model.equilibria(spoilt.data(), rows, e.data(), static_cast<std::ptrdiff_t>(pitch)),
                static_cast<int>(bad))
          << m.entry->name;
    }
  }
}

TEST(models, consistent_data_are_the_equilibrium_of_their_namesake) {
  // "smooth-consistent" has the same moments as "smooth", and it is E of them.
  int found = 0;
  for (const auto& m : relaxation_models()) {
    const auto& all = m.relaxation->initial();
    for (const auto& consistent : all) {
      const auto end = consistent.name.rfind("-consistent");
      if (end == std::string::npos) continue;
      const auto base = std::find_if(all.begin(), all.end(), [&](const auto& data) {
        return data.name == consistent.name.substr(0, end);
      });
      ASSERT_NE(base, all.end()) << m.entry->name;
      ++found;
      for (double x = 0.05; x < 2.0; x += 0.1) {
        const auto size = static_cast<std::size_t>(m.relaxation->components());
        const auto count = static_cast<std::size_t>(m.relaxation->moment_count());
        std::vector<double> u(size), v(size), e(size), omega_u(count), omega_v(count);
        base->point_value({x}, u);
        consistent.point_value({x}, v);
        m.relaxation->moments(u.data(), omega_u.data());
        m.relaxation->moments(v.data(), omega_v.data());
        ASSERT_TRUE(m.relaxation->equilibrium(omega_v.data(), e.data()));
        // The moments are sums of forty terms of size 1.
        for (std::size_t k = 0; k < count; ++k) EXPECT_NEAR(omega_u[k], omega_v[k], 1e-14) << m.entry->name;
        for (std::size_t k = 0; k < size; ++k) EXPECT_NEAR(e[k], v[k], 1e-13) << m.entry->name;
      }
    }
  }
  EXPECT_GE(found, 3);
}

TEST(models, initial_data_have_distinct_names_and_sorted_jumps) {
  for (const auto* entry : apsis::model_entries()) {
    const auto names = apsis::initial_names(*entry);
    EXPECT_FALSE(names.empty()) << entry->name;
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << entry->name;
    for (const auto& data : apsis::prototype(*entry).initial())
      EXPECT_TRUE(std::is_sorted(data.jumps.begin(), data.jumps.end())) << data.name;
  }
  EXPECT_EQ(apsis::initial_names(apsis::find_model("bgk")).front(), "mixed-v");
  EXPECT_EQ(apsis::initial_names(apsis::find_model("decay")), std::vector<std::string>{"start"});
}

TEST(models, a_row_has_one_value_per_velocity_and_component) {
  for (const auto* entry : apsis::model_entries()) {
    const auto& m = apsis::prototype(*entry);
    EXPECT_EQ(apsis::has_space(*entry), m.velocities().size() > 0) << entry->name;
    if (!apsis::has_space(*entry)) continue;
    EXPECT_EQ(m.velocities().components(), m.components()) << entry->name;
  }
}

TEST(models, the_ode_starts_at_the_given_values) {
  auto config = apsis::default_config(apsis::find_model("ode"));
  config.parameters["u1"] = -0.25;
  config.parameters["u2"] = 3.0;
  std::vector<double> u(2);
  const auto ode = apsis::find_model("ode").make(config);
  ode->initial().back().point_value({}, u);
  EXPECT_EQ(ode->initial().back().name, "given");
  EXPECT_EQ(u, (std::vector<double>{-0.25, 3.0}));
}

TEST(models, bgk_reports_how_its_velocity_grid_must_change) {
  const auto complaint = [](double max, int points) {
    apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
    config.velocity = {max, points, apsis::equilibrium_choice::automatic};
    const auto m = apsis::find_model("bgk").make(config);
    std::vector<double> u(static_cast<std::size_t>(m->components()));
    m->initial()[0].point_value({0.3}, u);
    return m->check_supported(u.data()).problem;
  };
  EXPECT_EQ(complaint(15.0, 150), "");
  EXPECT_NE(complaint(2.0, 40).find("velocity.max = 2 is too small"), std::string::npos)
      << complaint(2.0, 40);
  EXPECT_NE(complaint(60.0, 20).find("velocity.points = 20 is too few"), std::string::npos)
      << complaint(60.0, 20);
}

}  // namespace properties_test
