// What models refuse. (Properties 2–5 of the paper: tests/study/model_properties.cpp.)
#include <apsis/model/model_registry.hpp>

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

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
    config.velocity = {8.0, 40, "auto"};
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
