#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <mutex>

#include <fmt/format.h>

namespace apsis {

std::vector<data_form> model::data_forms() const {
  return {};
}

const velocity_set& model::velocities() const {
  static const velocity_set none;
  return none;
}

double model::cfl_rate(std::span<const double> spacing) const {
  double fastest = 0.0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(velocities().size()); ++j) {
    double rate = 0.0;
    for (std::size_t k = 0; k < spacing.size(); ++k)
      rate += std::abs(speeds(static_cast<int>(k))[j]) / spacing[k];
    fastest = std::max(fastest, rate);
  }
  return fastest;
}

void model::source(const double*, double* s) const {
  for (int k = 0; k < components(); ++k) s[k] = 0.0;
}

void model::invariant_scales(std::span<const double> densities, double* scales) const {
  for (std::size_t k = 0; k < densities.size(); ++k) scales[k] = std::abs(densities[k]);
}

unsupported_initial_data model::check_supported(const double*) const {
  return {};
}

unsupported_initial_data model::check_supported_range(const double*, const double*) const {
  return {};
}

double model::automatic_value(const std::string&, const std::vector<std::vector<double>>&) const {
  return std::numeric_limits<double>::quiet_NaN();
}

void relaxation_model::moments_of_rows(const double* u, std::ptrdiff_t pitch, int rows, double* omega) const {
  for (int p = 0; p < rows; ++p) moments(u + p * pitch, omega + p * moment_count());
}

int relaxation_model::equilibria(const double* omega, int rows, double* e, std::ptrdiff_t pitch) const {
  for (int p = 0; p < rows; ++p)
    if (!equilibrium(omega + p * moment_count(), e + p * pitch)) return p;
  return rows;
}

model_config default_config(const model_entry& entry) {
  model_config config;
  for (const auto& p : entry.parameters) config.parameters[p.name] = p.value;
  for (const auto& t : entry.options) config.options[t.name] = t.value;
  for (const auto& l : entry.lists) config.lists[l.name] = l.value;
  if (entry.has_velocity_grid) config.velocity = {.max = 8.0, .points = 16};
  return config;
}

const model& prototype(const model_entry& entry) {
  static std::mutex mutex;
  static std::map<const model_entry*, std::unique_ptr<model>> made;
  const std::lock_guard lock(mutex);
  auto& equation = made[&entry];
  if (!equation) equation = entry.make(default_config(entry));
  return *equation;
}

std::vector<std::string> initial_names(const model_entry& entry) {
  std::vector<std::string> names;
  for (const auto& data : prototype(entry).initial()) names.push_back(data.name);
  return names;
}

const model_entry* try_find_model(const std::string& name) {
  for (const model_entry* entry : model_entries())
    if (entry->name == name) return entry;
  return nullptr;
}

const model_entry& find_model(const std::string& name) {
  if (const model_entry* found = try_find_model(name)) return *found;
  std::vector<std::string> names;
  for (const model_entry* entry : model_entries()) names.push_back(entry->name);
  throw input_error(
      fmt::format("unknown model '{}' (there is no such name); {}", printable(name), suggest(name, names)));
}

std::vector<dimension> model::invariant_dimensions() const {
  return std::vector<dimension>(invariants().size());
}

void relaxation_model::relaxing_moments(const double*, const double*, double*) const {}

void relaxation_model::relax(const stage_coefficients&, double*) const {}

bool relaxation_model::target(const double* omega, const double*, const double*, double, double* e,
                              double&) const {
  return equilibrium(omega, e);
}

}  // namespace apsis
