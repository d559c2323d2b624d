#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/model/model_registry.hpp>

#include <cstddef>
#include <string>

namespace apsis {

/// Checks of a case that involve several keys. Each throws input_error at the place of the key that must
/// change. The arguments of the constructor must outlive the object.
class case_checks {
 public:
  /// `config` has the values of the keys of `text`, which was read from `file`.
  case_checks(const case_text& text, const std::string& file, const model_entry& model,
              const case_config& config)
      : text_(text), file_(file), model_(model), config_(config) {}

  /// Checks that there is one number of cells and one interval for each dimension of the model.
  void check_dimensions() const;
  /// Checks all other combinations of keys.
  void check_together() const;

 private:
  void check_step_rule() const;
  std::string example_of_step() const;
  void check_mesh() const;
  void check_interval(const interval& ends, int cells) const;
  void check_discretization() const;
  void check_axis() const;
  void check_radial_sides() const;
  const std::string& kind_of_face(std::size_t face) const;
  void check_solids() const;
  void check_body(std::size_t k, const boundary& wall) const;
  void check_faces() const;
  void check_epsilon() const;
  void check_fields() const;

  const case_text& text_;
  const std::string& file_;
  const model_entry& model_;
  const case_config& config_;
};

}  // namespace apsis
