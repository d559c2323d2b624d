#include <apsis/boundary/prescribed_state.hpp>

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
  constexpr std::size_t usual = 8;  // not on the heap
  boost::container::small_vector<double, usual> numbers;
  for (const auto& value : values_) numbers.push_back(value.at(t, x));
  write_other({numbers.data(), numbers.size()}, t, row);
}

void prescribed_state::write_other(std::span<const double> numbers, double t, std::span<double> row) const {
  if (const std::string problem = form_.row(numbers, row); !problem.empty())
    throw input_error(fmt::format("the boundary has no {} at t = {:.10g} ({}); change its values",
                                  form_.description, t, problem));
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
