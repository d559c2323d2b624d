#include <apsis/boundary/prescribed_state.hpp>

#include <apsis/boundary/face_value_error.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <utility>

#include <boost/container/small_vector.hpp>
#include <fmt/format.h>

namespace apsis {

data_form maxwellian_form(const model& equation, const std::string& boundary_name) {
  for (auto& form : equation.data_forms()) {
    const auto& all = form.variables;
    const auto is = [&](std::size_t k, const char* name) { return k < all.size() && all[k].name == name; };
    if (all.size() == 3 && is(0, "rho") && is(1, "u") && is(2, "T")) return form;
  }
  throw input_error(
      fmt::format("boundary '{}' cannot be used (the model has no Maxwellians); choose another "
                  "kind, see: apsis list boundaries",
                  boundary_name));
}

prescribed_state::prescribed_state(data_form form, std::vector<face_quantity> values, int components)
    : form_(std::move(form)), values_(std::move(values)), components_(components) {
  if (!std::all_of(values_.begin(), values_.end(), [](const auto& value) { return value.is_constant(); }))
    return;
  std::vector<double> row(static_cast<std::size_t>(components));
  compute(0.0, {}, row);
  constant_ = std::move(row);
}

void prescribed_state::compute(double t, const position& x, std::span<double> row) const {
  constexpr std::size_t usual = 8;  // needs no heap
  boost::container::small_vector<double, usual> numbers;
  for (const auto& value : values_) numbers.push_back(value.at(t, x));
  write_other({numbers.data(), numbers.size()}, t, x, row);
}

void prescribed_state::write_other(std::span<const double> numbers, double t, const position& x,
                                   std::span<double> row) const {
  const std::string problem = try_other(numbers, row);
  if (problem.empty()) return;
  const face_quantity& value = values_[index_of_problem(problem)];
  refuse_value(value,
               fmt::format("{} has no {} at {} ({}); change its values", surface_of(value, "the boundary"),
                           form_.description, time_and_point(value, t, x), problem));
}

/// Returns the index of the value that caused a problem. The problem begins with the first word of the
/// description of its variable. If no such value comes from a case, returns the last value that does.
std::size_t prescribed_state::index_of_problem(const std::string& problem) const {
  const auto first_word = [](const std::string& text) { return text.substr(0, text.find(' ')); };
  std::size_t found = values_.size() - 1, first = 0;
  for (std::size_t k = 0; k < values_.size(); ++k)
    if (values_[k].origin() != nullptr) found = k;
  for (const data_variable& variable : form_.variables) {
    if (first_word(variable.doc) == first_word(problem) && values_[first].origin() != nullptr) return first;
    first += static_cast<std::size_t>(variable.size);
  }
  return found;
}

void prescribed_state::write(double t, const position& x, double* row) const {
  const double* values = at(t, x, {row, static_cast<std::size_t>(components_)});
  if (values != row) std::copy_n(values, components_, row);
}

const double* prescribed_state::at(double t, const position& x, std::span<double> buffer) const {
  if (!constant_.empty()) return constant_.data();
  compute(t, x, buffer);
  return buffer.data();
}

}  // namespace apsis
