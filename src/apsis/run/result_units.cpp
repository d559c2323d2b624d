#include <apsis/run/result_units.hpp>

#include <apsis/run/body_loads.hpp>
#include <apsis/run/found_walls.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

/// Returns a label such as "density (dimensionless)" with another unit.
std::string with_unit(const std::string& label, const std::string& unit) {
  const std::string none = "(dimensionless)";
  const auto at = label.rfind(none);
  return at == std::string::npos ? label : label.substr(0, at) + "(" + unit + ")";
}

void multiply(std::vector<double>& values, double factor) {
  for (double& x : values) x *= factor;
}

}  // namespace

result_units::result_units(const case_config& config)
    : scales_(config.output.units == units_choice::si ? config.scales : std::nullopt),
      of_time_(config.steady_state.tolerance ? dimensions::none : dimensions::time) {}

std::string result_units::suffix(const dimension& dims) const {
  return are_si() && dims != dimensions::none ? " " + unit_of(dims) : "";
}

std::string result_units::suffix_of_amount(const dimension& dims, int lacking) const {
  return are_si() && dims != dimensions::none ? " " + unit_of_amount(dims, lacking) : "";
}

field_series result_units::convert(field_series fields) const {
  if (!are_si()) return fields;
  for (auto& axis : fields.axes) multiply(axis.centres, factor(dimensions::length));
  fields.unit_of_x = unit_of(dimensions::length);
  if (of_time_ != dimensions::none) fields.unit_of_t = unit_of(of_time_);
  fields.units.clear();
  for (std::size_t k = 0; k < fields.names.size(); ++k) {
    const dimension& dims = fields.dimensions[k];
    fields.units.push_back(unit_of(dims));
    fields.labels[k] = with_unit(fields.labels[k], fields.units[k]);
    for (auto& snapshot : fields.snapshots) multiply(snapshot.values[k], factor(dims));
  }
  for (auto& snapshot : fields.snapshots) snapshot.t *= factor(of_time_);
  return fields;
}

surface_table result_units::convert(surface_table surface) const {
  if (!are_si()) return surface;
  for (auto& row : surface.numbers.rows)
    for (std::size_t k = 0; k < row.size(); ++k) row[k] *= factor(surface.dimensions[k]);
  for (auto& piece : surface.corners)
    for (position& corner : piece)
      for (double& x : corner) x *= factor(dimensions::length);
  return surface;
}

numeric_table result_units::convert(numeric_table history, const simulation& run) const {
  if (!are_si()) return history;
  for (const auto& [name, dims, unit] : history_units(run)) {
    const auto found = std::find(history.columns.begin(), history.columns.end(), name);
    if (found == history.columns.end()) continue;
    const auto column = static_cast<std::size_t>(found - history.columns.begin());
    const double by = factor(dims);
    for (auto& row : history.rows) row[column] *= by;
  }
  return history;
}

dimension dimension_of_integral(dimension density, const grid& mesh) {
  for (int k = 0; k < mesh.dimensions_of_integrals(); ++k) density = density * dimensions::length;
  return density;
}

int lacking_directions(const grid& mesh) {
  return 3 - mesh.dimensions_of_integrals();
}

std::vector<history_unit> history_units(const simulation& run) {
  using dimensions::time;
  std::vector<history_unit> all;
  const auto add = [&](std::string column, const dimension& dims) {
    all.push_back({std::move(column), dims, unit_of(dims)});
  };
  const auto add_amount = [&](std::string column, const dimension& dims) {
    all.push_back({std::move(column), dims, unit_of_amount(dims, lacking_directions(run.mesh()))});
  };
  if (!run.config().steady_state.tolerance) {
    add("t", time);
    add("dt", time);
    add("change", dimensions::none / time);
  }
  const auto names = run.setup().equation->invariants();
  const auto densities = run.setup().equation->invariant_dimensions();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const dimension amount = dimension_of_integral(densities[k], run.mesh());
    add_amount("total_" + names[k], amount);
    if (run.config().force.acceleration && k > 0) add_amount("lost_force_" + names[k], amount / time);
    for (const auto& face : run.setup().open_faces()) {
      add_amount("received_" + face + "_" + names[k], amount);
      add_amount("flux_" + face + "_" + names[k], amount / time);
    }
  }
  for (auto& column : temperature_columns(run.setup())) add(std::move(column), dimensions::temperature);
  for (auto& one : load_units(run)) all.push_back(std::move(one));
  return all;
}

numeric_table result_history(const numeric_table& history, const simulation& run) {
  return result_units(run.config()).convert(with_loads(history, run), run);
}

}  // namespace apsis
