#include <apsis/config/boundary_support.hpp>

#include <apsis/config/space_time_formula.hpp>
#include <apsis/core/errors.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr int intervals = 200;

/// A variable of a face at a time; the default where the face does not give it.
class face_values {
 public:
  face_values(const case_config& config, const model& equation, const face_table& table) {
    for (const auto& [name, texts] : table.values)
      for (const auto& text : texts)
        if (name == "rho" || name == "T" || name == "u" || name == "velocity")
          formulas_[name].emplace_back(text, source_place{}, config.constants, equation.space_dimensions());
  }

  /// Whether no value depends on t.
  bool steady() const {
    for (const auto& [name, all] : formulas_)
      for (const auto& one : all)
        if (!one.is_steady()) return false;
    return true;
  }
  double at(const std::string& name, std::size_t k, double t, const position& x, double otherwise) const {
    const auto found = formulas_.find(name);
    return found == formulas_.end() || k >= found->second.size() ? otherwise : found->second[k].at(t, x);
  }

 private:
  std::map<std::string, std::vector<space_time_formula>> formulas_;
};

/// The form of Maxwellians of a gas.
std::optional<data_form> maxwellians(const model& equation) {
  for (auto& form : equation.data_forms())
    if (form.variables.size() == 3 && form.variables.front().name == "rho" &&
        form.variables.back().name == "T")
      return form;
  return std::nullopt;
}

std::string problem_of(const face_values& face, const data_form& form, const model& equation, double t,
                       const position& x) {
  std::vector<double> state = {face.at("rho", 0, t, x, 1.0)};
  for (std::size_t k = 0; k < static_cast<std::size_t>(form.variables[1].size); ++k)
    state.push_back(face.at("u", k, t, x, face.at("velocity", k, t, x, 0.0)));
  state.push_back(face.at("T", 0, t, x, 1.0));
  std::vector<double> row(static_cast<std::size_t>(equation.components()));
  if (!form.row(state, row).empty()) return "";  // the boundary itself reports it
  return equation.check_supported(row.data()).problem;
}

/// Points on a face at the ends, the middle and the quarters of its sides.
std::vector<position> points_of_face(const case_config& config, const face& where) {
  constexpr int parts = 4;
  std::vector<position> points = {position{}};
  for (std::size_t k = 0; k < config.space.domain.size(); ++k) {
    const auto [lower, upper] = config.space.domain[k];
    const bool normal = k == static_cast<std::size_t>(where.direction);
    std::vector<position> more;
    for (position x : points)
      for (int part = 0; part <= (normal ? 0 : parts); ++part) {
        x[k] = normal ? (where.upper ? upper : lower) : lower + (upper - lower) * part / parts;
        more.push_back(x);
      }
    points = std::move(more);
  }
  return points;
}

}  // namespace

std::string unsupported_boundary(const case_config& config, const model& equation) {
  const auto form = maxwellians(equation);
  if (!form || config.space.cells.empty()) return "";
  for (std::size_t k = 0; k < 2 * config.space.cells.size(); ++k) {
    if (config.faces[k].values.empty()) continue;
    const face_values face(config, equation, config.faces[k]);
    const int last = face.steady() ? 0 : intervals;
    for (const position& x : points_of_face(config, face_of(k)))
      for (int n = 0; n <= last; ++n) {
        const double t = last == 0 ? 0.0 : config.time.end * n / last;
        if (const std::string problem = problem_of(face, *form, equation, t, x); !problem.empty())
          return fmt::format("the velocities do not hold the gas of [boundary.{}] at t = {:.4g}: {}",
                             face_names[k], t, problem);
      }
  }
  return "";
}

}  // namespace apsis
