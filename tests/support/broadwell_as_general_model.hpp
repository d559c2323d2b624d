#pragma once

#include <apsis/model/general_model.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <memory>

/// Broadwell's equations with Q = (q, −q, q), q = f₀² − f₊f₋, as a model without a relaxation form. Its
/// stages need Newton's method.
class broadwell_as_general_model final : public apsis::general_model {
 public:
  int components() const override { return closed_->components(); }
  int space_dimensions() const override { return closed_->space_dimensions(); }
  const apsis::velocity_set& velocities() const override { return closed_->velocities(); }
  void collision(const number* f, number* q) const override {
    q[0] = f[1] * f[1] - f[0] * f[2];
    q[1] = -q[0];
    q[2] = q[0];
  }
  bool admissible(const double* f) const override {
    return std::all_of(f, f + 3, [](double value) { return value >= 0.0; });
  }
  bool positive() const override { return true; }
  std::vector<std::string> invariants() const override { return closed_->invariants(); }
  void invariant_densities(const double* f, double* densities) const override {
    closed_->invariant_densities(f, densities);
  }
  std::vector<apsis::field_group> fields() const override { return closed_->fields(); }
  const std::vector<apsis::initial_data>& initial() const override { return closed_->initial(); }

 private:
  static std::unique_ptr<apsis::model> make() {
    const auto* entry = apsis::try_find_model("broadwell");
    return entry->make(apsis::default_config(*entry));
  }
  std::unique_ptr<apsis::model> closed_ = make();
};
