#include <apsis/study/compare.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/mesh/cut_cells.hpp>
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

bool is_in_space(const case_config& config) {
  const model_entry* entry = try_find_model(config.model.name);
  return entry != nullptr && has_space(*entry);
}

[[noreturn]] void not_comparable(const std::string& key, const std::string& why) {
  throw input_error(
      fmt::format("a run and its reference differ in '{}' ({}); leave it the same in both", key, why));
}

/// Returns the volume of gas of every cell in multiples of grid::cell_volume(). A group of cut cells has its
/// volume in its first cell. Empty if all are 1.
std::vector<double> shares_of_gas(const case_config& config) {
  if (!is_in_space(config)) return {};
  const grid mesh = make_mesh(config);
  if (!mesh.has_axis() && mesh.obstacles() == 0) return {};
  std::vector<double> shares;
  for (int cell = 0; cell < mesh.size(); ++cell) {
    const int group = mesh.cut_group(cell);
    const double share = !has_unknown(mesh, cell) ? 0.0
                         : group < 0              ? 1.0
                                     : mesh.cut()->groups()[at(group)].volume / mesh.cell_volume();
    shares.push_back(share * mesh.measure() * mesh.radius(mesh.centre(cell)));
  }
  return shares;
}

double norm_of(const std::vector<double>& a, const std::vector<double>& b, double volume,
               const std::vector<double>& shares, error_norm norm) {
  double sum = 0.0, largest = 0.0;
  const std::size_t components = shares.empty() ? 1 : a.size() / shares.size();
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double share = shares.empty() ? 1.0 : shares[k / components];
    if (share == 0.0) continue;
    const double d = std::abs(a[k] - b[k]);
    sum += share * (norm == error_norm::l2 ? d * d : d);
    largest = std::max(largest, d);
  }
  if (std::isnan(sum)) return sum;
  if (norm == error_norm::linf) return largest;
  return norm == error_norm::l2 ? std::sqrt(sum * volume) : sum * volume;
}

/// Returns one macroscopic field of a state [cells][components]; 0 in cells without a share of gas.
std::vector<double> compared_field(const case_config& config, const std::vector<double>& state,
                                   const std::vector<double>& shares, const std::string& name) {
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
  for (std::size_t cell = 0; cell < state.size() / components; ++cell) {
    const bool has_gas = shares.empty() || shares[cell] > 0.0;
    if (has_gas) group.compute({state.data() + cell * components}, values.data());
    out.push_back(has_gas ? values[static_cast<std::size_t>(found - names.begin())] : 0.0);
  }
  return out;
}

/// Returns the name of a direction in space.
char axis_name(const case_config& config, std::size_t direction) {
  return config.is_axisymmetric() && direction + 1 == config.space.cells.size() ? 'r' : "xyz"[direction];
}

bool have_equal_boxes(const case_config& a, const case_config& b) {
  const auto equal = [](const solid_table& one, const solid_table& other) {
    return one.from == other.from && one.to == other.to;
  };
  return std::equal(a.solids.begin(), a.solids.end(), b.solids.begin(), b.solids.end(), equal);
}

/// Returns whether two meshes with equal numbers of cells have the same gas in every cell.
bool have_equal_bodies(const grid& a, const grid& b) {
  for (int cell = 0; cell < a.size(); ++cell)
    if ((a.solid(cell) < 0) != (b.solid(cell) < 0) || a.cut_group(cell) != b.cut_group(cell) ||
        a.gas_share(cell) != b.gas_share(cell))
      return false;
  return true;
}

void check_obstacles(const case_config& run, const case_config& reference) {
  if (!have_equal_boxes(run, reference)) not_comparable("space.solid", "they have no common mesh");
  if (run.bodies.empty() && reference.bodies.empty()) return;
  if (run.space.cells != reference.space.cells)
    not_comparable("space.cells", "meshes past a body have different cut cells");
  if (!have_equal_bodies(make_mesh(run), make_mesh(reference)))
    not_comparable("space.body", "they have no common mesh");
}

bool have_equal_velocities(const case_config& a, const case_config& b) {
  velocity_config one = velocities_of(a), other = velocities_of(b);
  for (velocity_config* of : {&one, &other}) {
    of->equilibrium = equilibrium_choice::automatic;  // it has no part in the velocities
    if (of->set.empty()) of->set = {"uniform"};
  }
  return one == other;
}

void check_meshes(const case_config& run, const case_config& reference) {
  if (!is_in_space(run)) return;
  if (run.space.domain != reference.space.domain) not_comparable("space.domain", "they have no common mesh");
  if (run.is_axisymmetric() != reference.is_axisymmetric())
    not_comparable("space.geometry", "one is axisymmetric");
  const cell_unknown &unknown = discretization_of(run).unknown(),
                     &other = discretization_of(reference).unknown();
  if (&unknown != &other)
    not_comparable(discretization_key,
                   fmt::format("one has {}, the other {}", unknown.plural(), other.plural()));
  check_obstacles(run, reference);
  for (std::size_t k = 0; k < run.space.cells.size(); ++k) {
    const int cells = run.space.cells[k], fine = reference.space.cells.at(k);
    if (const std::string why = unknown.why_not_restricted(fine, cells); !why.empty())
      throw input_error(fmt::format(
          "a reference with {0} cells along {1} cannot be compared with a run of {2} ({3}); choose a "
          "multiple of {2} along {1}",
          fine, axis_name(run, k), cells, why));
  }
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
    compared_field(run, {}, {}, quantity);
  else if (!have_equal_velocities(run, reference))
    not_comparable("velocity", "they have other velocities, so only macroscopic fields can be compared");
  check_meshes(run, reference);
}

std::vector<double> on_mesh_of(const outcome& run, const outcome& finer) {
  check_meshes(run.config, finer.config);
  if (!is_in_space(run.config) || run.config.space.cells == finer.config.space.cells) return finer.state;
  std::array<bool, 3> periodic{};
  const auto sides = make_boundaries(run.config, make_model(run.config));
  for (std::size_t k = 0; k < sides.size(); ++k) periodic[k] = sides[k][0]->periodic();
  return discretization_of(run.config)
      .unknown()
      .restricted_to_mesh(finer.state, finer.components, make_mesh(finer.config), make_mesh(run.config),
                          periodic);
}

double difference_norm(const outcome& run, const std::vector<double>& state, error_norm norm,
                       const std::string& quantity) {
  const auto shares = shares_of_gas(run.config);
  if (quantity.empty()) {
    if (state.size() != run.state.size()) not_comparable("velocity", "their states have different sizes");
    return norm_of(run.state, state, run.cell_volume * run.component_weight, shares, norm);
  }
  return norm_of(compared_field(run.config, run.state, shares, quantity),
                 compared_field(run.config, state, shares, quantity), run.cell_volume, shares, norm);
}

double difference_norm(const outcome& run, const outcome& finer, error_norm norm,
                       const std::string& quantity) {
  check_comparable(run.config, finer.config, quantity);
  const auto state = on_mesh_of(run, finer);
  if (quantity.empty()) return difference_norm(run, state, norm);
  const auto shares = shares_of_gas(run.config);
  return norm_of(compared_field(run.config, run.state, shares, quantity),
                 compared_field(finer.config, state, shares, quantity), run.cell_volume, shares, norm);
}

}  // namespace apsis
