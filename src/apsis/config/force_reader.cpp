#include <apsis/config/force_reader.hpp>

#include <apsis/config/checked_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr const char* acceleration_key = "force.acceleration";

/// The components of an acceleration.
using formulas = std::vector<std::shared_ptr<const expression>>;

formulas compile(const case_config& config, const model& equation) {
  formula_kind kind = formula_of_position(equation.space_dimensions(), false, config.constants);
  kind.variables.insert(kind.variables.begin(), "t");
  formulas all;
  for (const auto& text : *config.force.acceleration)
    all.push_back(std::make_shared<const expression>(text, place_of(config, acceleration_key), kind));
  return all;
}

std::array<double, 3> value_of(const formulas& all, double t, const position& x) {
  std::array<double, 3> a{};
  for (std::size_t k = 0; k < all.size(); ++k)
    a[k] = all[k]->evaluate(std::array<double, 4>{t, x[0], x[1], x[2]});
  return a;
}

/// Returns the number of times at which the bound is sampled: many, as long as that takes a
/// fraction of a second.
int samples_in_time(int cells) {
  constexpr int most = 2000, least = 20, evaluations = 2'000'000;
  return std::clamp(evaluations / cells, least, most);
}

}  // namespace

std::optional<acceleration> make_acceleration(const case_config& config, const model& equation) {
  if (!config.force.acceleration) return std::nullopt;
  const auto given = config.force.acceleration->size(), possible = equation.lattice().points.size();
  if (given > possible)
    throw input_error(
        place_of(config, acceleration_key),
        fmt::format("'{}' has {} formulas (model '{}' has {} velocity dimension{}); give at most {}",
                    acceleration_key, given, config.model.name, possible, possible == 1 ? "" : "s",
                    possible));
  const formulas all = compile(config, equation);
  acceleration of;
  of.value = [all](double t, const position& x) { return value_of(all, t, x); };
  const bool constant =
      std::all_of(all.begin(), all.end(), [](const auto& one) { return one->is_constant(); });
  const grid mesh = make_mesh(config);
  const int times = constant ? 0 : samples_in_time(mesh.size());
  for (int n = 0; n <= times; ++n)
    for (int cell = 0; cell < (constant ? 1 : mesh.size()); ++cell) {
      const double t = times == 0 ? 0.0 : config.time.end * n / times;
      const auto a = of.value(t, mesh.centre(cell));
      for (std::size_t k = 0; k < a.size(); ++k) of.largest[k] = std::max(of.largest[k], std::abs(a[k]));
    }
  constexpr double margin = 1.01;  // for values between the samples
  if (!constant)
    for (double& bound : of.largest) bound *= margin;
  with_place_of_key(config, [&] { check_velocities(of, equation.lattice()); });
  return of;
}

}  // namespace apsis
