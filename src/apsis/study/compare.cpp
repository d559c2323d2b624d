#include <apsis/study/compare.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

const std::map<std::string, error_norm>& norms() {
  static const std::map<std::string, error_norm> names = {
      {"l1", error_norm::l1}, {"l2", error_norm::l2}, {"linf", error_norm::linf}};
  return names;
}

[[noreturn]] void not_comparable(const std::string& key, const std::string& why) {
  throw input_error(
      fmt::format("a run and its reference differ in '{}' ({}); leave it the same in both", key, why));
}

double norm_of(const std::vector<double>& a, const std::vector<double>& b, double volume, error_norm norm) {
  double sum = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double d = std::abs(a[k] - b[k]);
    sum += norm == error_norm::l2 ? d * d : d;
    largest = std::max(largest, d);
  }
  if (std::isnan(sum)) return sum;
  if (norm == error_norm::linf) return largest;
  return norm == error_norm::l2 ? std::sqrt(sum * volume) : sum * volume;
}

/// Returns one macroscopic field of a state [cells][components].
std::vector<double> field_of(const case_config& config, const std::vector<double>& state,
                             const std::string& name) {
  const run_setup setup(config);
  std::vector<std::string> names;
  const field_group group = setup.equation->fields().front();
  for (const auto& field : group.names) names.push_back(field.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw input_error(fmt::format("no quantity '{}' (model '{}' has no such field); {}", name.substr(0, 60),
                                  config.model.name, suggest(name, names)));
  const auto components = static_cast<std::size_t>(setup.equation->components());
  std::vector<double> values(names.size()), out;
  for (std::size_t k = 0; k < state.size(); k += components) {
    group.compute({state.data() + k}, values.data());
    out.push_back(values[static_cast<std::size_t>(found - names.begin())]);
  }
  return out;
}

void check_meshes(const case_config& run, const case_config& reference) {
  const model_entry* entry = try_find_model(run.model.name);
  if (entry == nullptr || !has_space(*entry)) return;
  if (run.space.domain != reference.space.domain) not_comparable("space.domain", "they have no common mesh");
  const cell_unknown &unknown = discretization_of(run).unknown(),
                     &other = discretization_of(reference).unknown();
  if (&unknown != &other)
    not_comparable(discretization_key,
                   fmt::format("one has {}, the other {}", unknown.plural(), other.plural()));
  const int cells = make_mesh(run).size(), fine = make_mesh(reference).size();
  if (const std::string why = unknown.why_not_restricted(fine, cells); !why.empty())
    throw input_error(
        fmt::format("a reference with {} cells cannot be compared with a run of {} ({}); choose numbers of "
                    "cells that are multiples",
                    fine, cells, why));
}

}  // namespace

error_norm find_norm(const std::string& name) {
  const auto found = norms().find(name);
  if (found != norms().end()) return found->second;
  std::vector<std::string> names;
  for (const auto& item : norms()) names.push_back(item.first);
  throw input_error(
      fmt::format("no norm '{}' (there is no such norm); {}", name.substr(0, 60), suggest(name, names)));
}

std::string to_string(error_norm norm) {
  for (const auto& [name, value] : norms())
    if (value == norm) return name;
  return "";
}

void check_comparable(const case_config& run, const case_config& reference, const std::string& quantity) {
  if (run.model.name != reference.model.name) not_comparable("model.name", "they have other unknowns");
  if (run.time.end != reference.time.end) not_comparable("time.end", "they end at different times");
  if (!quantity.empty())
    field_of(run, {}, quantity);
  else if (run.velocity.points != reference.velocity.points || run.velocity.max != reference.velocity.max)
    not_comparable("velocity", "they have other velocities, so only macroscopic fields can be compared");
  check_meshes(run, reference);
}

std::vector<double> on_mesh_of(const outcome& run, const outcome& finer) {
  check_meshes(run.config, finer.config);
  if (run.cells == finer.cells) return finer.state;
  const bool periodic = make_boundaries(run.config, make_model(run.config)).front()[0]->periodic();
  return discretization_of(run.config)
      .unknown()
      .restricted(finer.state, finer.components, run.cells, periodic);
}

double difference_norm(const outcome& run, const std::vector<double>& state, error_norm norm,
                       const std::string& quantity) {
  if (quantity.empty()) {
    if (state.size() != run.state.size()) not_comparable("velocity", "their states have different sizes");
    return norm_of(run.state, state, run.cell_volume * run.component_weight, norm);
  }
  return norm_of(field_of(run.config, run.state, quantity), field_of(run.config, state, quantity),
                 run.cell_volume, norm);
}

double difference_norm(const outcome& run, const outcome& finer, error_norm norm,
                       const std::string& quantity) {
  check_comparable(run.config, finer.config, quantity);
  const auto state = on_mesh_of(run, finer);
  if (quantity.empty()) return difference_norm(run, state, norm);
  return norm_of(field_of(run.config, run.state, quantity), field_of(finer.config, state, quantity),
                 run.cell_volume, norm);
}

}  // namespace apsis
