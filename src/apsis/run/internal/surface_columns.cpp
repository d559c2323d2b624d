#include <apsis/run/internal/surface_columns.hpp>

#include <apsis/core/index.hpp>
#include <apsis/velocity/component_name.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsis {
namespace {

void add_column(surface_table& table, const std::string& name, const dimension& dims) {
  table.numbers.columns.push_back(name);
  table.dimensions.push_back(dims);
}

}  // namespace

std::optional<std::size_t> place_of_name(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<std::size_t> places_of_momenta(const model& equation) {
  const auto names = equation.invariants();
  const int dimensions = equation.velocities().dimensions();
  std::vector<std::size_t> momenta;
  for (int k = 0; k < dimensions; ++k)
    if (const auto found = place_of_name(names, component_name("momentum", k, dimensions)))
      momenta.push_back(*found);
  if (momenta.size() < at(dimensions)) momenta.clear();
  return momenta;
}

load_columns::load_columns(const model& equation, const std::optional<reference_values>& reference)
    : momenta_(places_of_momenta(equation)), reference_(reference) {
  if (!momenta_.empty()) energy_ = place_of_name(equation.invariants(), "energy");
}

void load_columns::add_names(surface_table& table, const std::vector<dimension>& fluxes) const {
  if (momenta_.empty()) return;
  const bool sheared = momenta_.size() > 1;
  add_column(table, "pressure", fluxes[momenta_.front()]);
  if (sheared) add_column(table, "shear_stress", fluxes[momenta_.front()]);
  if (energy_) add_column(table, "heat_flux", fluxes[*energy_]);
  if (!reference_) return;
  add_column(table, "C_p", dimensions::none);
  if (sheared) add_column(table, "C_f", dimensions::none);
  if (energy_) add_column(table, "C_h", dimensions::none);
}

void load_columns::add(std::vector<double>& row, double pressure, std::optional<double> shear,
                       std::optional<double> heat) const {
  row.push_back(pressure);
  if (shear) row.push_back(*shear);
  if (heat) row.push_back(*heat);
  if (!reference_) return;
  const double of_pressure = reference_->dynamic_pressure();
  row.push_back((pressure - reference_->density * reference_->temperature) / of_pressure);
  if (shear) row.push_back(*shear / of_pressure);
  if (heat) row.push_back(*heat / (of_pressure * reference_->speed()));
}

void load_columns::add_values(std::vector<double>& row, const std::vector<double>& given,
                              const std::array<double, 3>& n,
                              const std::array<double, 3>& wall_velocity) const {
  if (momenta_.empty()) return;
  double normal = 0.0, square = 0.0, work = 0.0;
  for (std::size_t k = 0; k < momenta_.size(); ++k) {
    normal += given[momenta_[k]] * n[k];
    work += wall_velocity[k] * given[momenta_[k]];
  }
  for (std::size_t k = 0; k < momenta_.size(); ++k) {
    const double along = given[momenta_[k]] - normal * n[k];
    square += along * along;
  }
  std::optional<double> shear, heat;
  if (momenta_.size() == 2) shear = n[0] * given[momenta_[1]] - n[1] * given[momenta_[0]];
  if (momenta_.size() == 3) shear = std::sqrt(square);
  if (energy_) heat = given[*energy_] - work;
  add(row, -normal, shear, heat);
}

void load_columns::add_values(std::vector<double>& row, const std::vector<double>& given, const face& where,
                              const std::array<double, 3>& wall_velocity) const {
  if (momenta_.empty()) return;
  const double normal = given[momenta_[at(where.direction)]];
  std::vector<double> along;
  double work = 0.0;
  for (std::size_t k = 0; k < momenta_.size(); ++k) {
    if (k != at(where.direction)) along.push_back(given[momenta_[k]]);
    work += wall_velocity[k] * given[momenta_[k]];
  }
  std::optional<double> shear, heat;
  if (along.size() == 1) shear = along.front();
  if (along.size() == 2) shear = std::hypot(along[0], along[1]);
  if (energy_) heat = given[*energy_] - work;
  add(row, where.upper ? normal : -normal, shear, heat);
}

void gas_columns::add_names(surface_table& table) const {
  if (gas_ == nullptr) return;
  add_column(table, "rho", dimensions::density);
  for (int k = 0; k < directions(); ++k)
    add_column(table, component_name("u", k, directions()), dimensions::velocity);
  add_column(table, "T", dimensions::temperature);
}

void gas_columns::add_values(std::vector<double>& row, std::span<const double> moments) const {
  if (gas_ == nullptr) return;
  fluid_state state;
  if (!moments.empty()) state = gas_->molecules().state(moments.data());
  if (!state.admissible()) {
    row.insert(row.end(), at(directions()) + 2, std::numeric_limits<double>::quiet_NaN());
    return;
  }
  row.push_back(state.rho);
  row.insert(row.end(), state.u, state.u + directions());
  row.push_back(state.T);
}

one_way_columns::one_way_columns(const model& equation) {
  for (const char* name : {"mass", "energy"})
    if (const auto found = place_of_name(equation.invariants(), name)) amounts_.push_back({name, *found});
}

void one_way_columns::add_names(surface_table& table, const std::vector<dimension>& fluxes) const {
  for (const amount& one : amounts_) {
    add_column(table, one.name + "_arriving", fluxes[one.invariant]);
    add_column(table, one.name + "_leaving", fluxes[one.invariant]);
  }
}

void one_way_columns::add_values(std::vector<double>& row, std::span<const double> arriving,
                                 std::span<const double> leaving) const {
  for (const amount& one : amounts_)
    for (const auto& fluxes : {arriving, leaving})
      row.push_back(fluxes.empty() ? std::numeric_limits<double>::quiet_NaN() : fluxes[one.invariant]);
}

wall_temperature_column::wall_temperature_column(const model& equation)
    : equation_(equation),
      mass_(place_of_name(equation.invariants(), "mass")),
      energy_(place_of_name(equation.invariants(), "energy")),
      momenta_(places_of_momenta(equation)) {}

const wall_temperature* wall_temperature_column::of(const boundary* side) const {
  if (side == nullptr || !mass_ || !energy_ || momenta_.empty()) return nullptr;
  return dynamic_cast<const wall_temperature*>(&side->undecorated());
}

void wall_temperature_column::add_name(surface_table& table, const boundary* side) const {
  if (of(side) != nullptr) add_column(table, "T_w", dimensions::temperature);
}

void wall_temperature_column::add_value(std::vector<double>& row, const boundary* side,
                                        const wall_point& where, std::span<const double> arriving) const {
  if (of(side) != nullptr)
    row.push_back(value(side, where, arriving).value_or(std::numeric_limits<double>::quiet_NaN()));
}

std::optional<double> wall_temperature_column::value(const boundary* side, const wall_point& where,
                                                     std::span<const double> arriving) const {
  const wall_temperature* wall = of(side);
  if (wall == nullptr || arriving.empty()) return std::nullopt;
  arriving_gas gas{arriving[*mass_], {}, arriving[*energy_]};
  for (std::size_t k = 0; k < momenta_.size(); ++k) gas.momentum[k] = arriving[momenta_[k]];
  return wall->temperature(where, equation_.velocities(), gas);
}

}  // namespace apsis
