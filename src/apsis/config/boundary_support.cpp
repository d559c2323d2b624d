#include <apsis/config/boundary_support.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/source_reader.hpp>
#include <apsis/config/space_time_formula.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/velocity_line_registry.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The Maxwellian that velocities miss most, of those seen so far.
class worst_maxwellian {
 public:
  explicit worst_maxwellian(const velocity_support& support) : support_(support) {}

  void see(const fluid_state& state, double t) {
    if (!state.admissible()) return;  // the boundary itself reports it
    const velocity_fit fit = support_.fit(state);
    if (!(fit.missed > fit_.missed)) return;
    fit_ = fit;
    state_ = state;
    t_ = t;
  }
  void see_moments(const double* omega, double t) { see(support_.molecules().state(omega), t); }

  /// Returns the warning, or throws, for what the table `path` describes.
  std::optional<std::string> judge(const case_config& config, const std::string& path) const {
    if (!(fit_.missed > velocity_limits::good)) return std::nullopt;
    const velocity_words words = words_of(config, fmt::format("the gas of [{}] at t = {:.4g}", path, t_));
    const std::string problem = velocity_problem(support_.molecules(), state_, fit_, words).problem;
    if (fit_.missed > velocity_limits::bad) throw input_error(place_of(config, path), problem);
    return problem;
  }

 private:
  const velocity_support& support_;
  velocity_fit fit_;
  fluid_state state_;
  double t_ = 0.0;
};

/// Times at which formulas are sampled.
std::vector<double> times_of(const case_config& config, bool steady, int intervals) {
  std::vector<double> times = {0.0};
  for (int n = 1; n <= intervals && !steady; ++n) times.push_back(config.time.end * n / intervals);
  return times;
}

/// The variables of a boundary, by formulas or their defaults.
class emitted_values {
 public:
  emitted_values(const case_config& config, const model& equation, const std::string& kind,
                 const state_formulas& given) {
    const boundary_entry& entry = find_boundary(kind);
    if (entry.variables == nullptr) return;
    for (const data_variable& variable : entry.variables(equation)) {
      value of{variable.value.value_or(0.0), {}};
      if (const auto found = given.find(variable.name); found != given.end())
        for (const auto& text : found->second)
          of.formulas.emplace_back(text, source_place{}, config.constants, equation.space_dimensions(),
                                   variable.of_velocity ? equation.velocities().dimensions() : 0);
      all_.emplace(variable.name, std::move(of));
    }
  }

  bool has(const std::string& name) const { return all_.contains(name); }
  /// Whether no value depends on t.
  bool steady() const {
    return std::all_of(all_.begin(), all_.end(), [](const auto& one) {
      return std::all_of(one.second.formulas.begin(), one.second.formulas.end(),
                         [](const auto& formula) { return formula.is_steady(); });
    });
  }
  /// Returns component k of a variable; the default where it is not given.
  double at(const std::string& name, std::size_t k, double t, const position& x,
            const position& v = {}) const {
    const value& of = all_.at(name);
    return k < of.formulas.size() ? of.formulas[k].at(t, x, v) : of.standard;
  }

 private:
  struct value {
    double standard;
    std::vector<space_time_formula> formulas;
  };
  std::map<std::string, value> all_;
};

/// The state of a wall or an end with a temperature.
fluid_state state_of(const emitted_values& values, int dimensions, double t, const position& x) {
  fluid_state state;
  state.rho = 1.0;
  state.T = values.at("T", 0, t, x);
  for (const char* name : {"u", "velocity"})
    for (std::size_t k = 0; values.has(name) && k < static_cast<std::size_t>(dimensions); ++k)
      state.u[k] = values.at(name, k, t, x);
  return state;
}

/// The moments of functions of the velocity at all velocities.
std::array<double, 5> moments_of(const emitted_values& values, const gas& molecules, double t,
                                 const position& x) {
  const velocity_set& velocities = molecules.velocities();
  const auto n = static_cast<std::size_t>(velocities.size());
  std::vector<double> row(static_cast<std::size_t>(velocities.components()));
  const std::vector<std::string> names =
      molecules.reduced() ? std::vector<std::string>{"g", "h"} : std::vector<std::string>{"f"};
  for (std::size_t set = 0; set < names.size(); ++set)
    for (std::size_t j = 0; j < n; ++j) {
      position v{};
      for (int k = 0; k < velocities.dimensions(); ++k)
        v[static_cast<std::size_t>(k)] = velocities.speeds(k)[j];
      row[set * n + j] = values.at(names[set], 0, t, x, v);
    }
  std::array<double, 5> omega{};
  molecules.moments(row.data(), 0, 1, omega.data());
  return omega;
}

/// Points of a box at the ends, the middle and the quarters of its sides; `flat`: a direction without extent.
std::vector<position> points_of_box(const std::vector<std::array<double, 2>>& sides, int flat) {
  constexpr int parts = 4;
  std::vector<position> points = {position{}};
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto [lower, upper] = sides[k];
    std::vector<position> more;
    for (position x : points)
      for (int part = 0; part <= (static_cast<int>(k) == flat ? 0 : parts); ++part) {
        x[k] = lower + (upper - lower) * part / parts;
        more.push_back(x);
      }
    points = std::move(more);
  }
  return points;
}

std::vector<position> points_of_face(const case_config& config, const face& where) {
  auto sides = config.space.domain;
  auto& normal = sides[static_cast<std::size_t>(where.direction)];
  if (where.upper) normal[0] = normal[1];
  return points_of_box(sides, where.direction);
}

class emitter_check {
 public:
  emitter_check(const case_config& config, const model& equation, const velocity_support& support)
      : config_(config), equation_(equation), support_(support) {}

  void surface(const std::string& path, const std::string& kind, const state_formulas& given,
               const std::vector<position>& points) {
    const emitted_values values(config_, equation_, kind, given);
    const gas& molecules = support_.molecules();
    const bool by_functions = values.has("f") || values.has("g");
    if (!by_functions && !values.has("T")) return;
    const int intervals = by_functions ? 20 : 200;
    worst_maxwellian worst(support_);
    for (const double t : times_of(config_, values.steady(), intervals))
      for (const position& x : points) {
        if (by_functions)
          worst.see_moments(moments_of(values, molecules, t, x).data(), t);
        else
          worst.see(state_of(values, molecules.dimensions(), t, x), t);
      }
    note(worst, path);
  }

  void source() {
    const auto rate = make_source(config_, equation_);
    if (!rate) return;
    constexpr int intervals = 50, most_cells = 64;
    const grid mesh = make_mesh(config_);
    const int stride = std::max(1, mesh.size() / most_cells);
    std::vector<double> row(static_cast<std::size_t>(equation_.components()));
    std::array<double, 5> omega{};
    worst_maxwellian worst(support_);
    for (const double t : times_of(config_, rate->steady, intervals))
      for (int cell = 0; cell < mesh.size(); cell += stride) try {
          rate->value(t, mesh.centre(cell), {}, row);
          support_.molecules().moments(row.data(), 0, 1, omega.data());
          worst.see_moments(omega.data(), t);
        } catch (const numerical_error&) {
          continue;  // reported by the step that meets it
        }
    note(worst, "source");
  }

  std::vector<std::string> warnings;

 private:
  void note(const worst_maxwellian& worst, const std::string& path) {
    if (const auto warning = worst.judge(config_, path)) warnings.push_back(*warning);
  }

  const case_config& config_;
  const model& equation_;
  const velocity_support& support_;
};

}  // namespace

velocity_words words_of(const case_config& config, const std::string& subject) {
  const auto& sets = config.velocity.set;
  return {.subject = subject,
          .scales = config.scales ? &*config.scales : nullptr,
          .from_file = std::any_of(sets.begin(), sets.end(), is_velocity_file)};
}

std::vector<std::string> check_emitted_gas(const case_config& config, const model& equation) {
  const auto support = support_of(equation);
  if (!support || equation.space_dimensions() == 0) return {};
  emitter_check check(config, equation, *support);
  for (std::size_t k = 0; k < 2 * config.space.cells.size(); ++k)
    check.surface("boundary." + face_names[k], config.faces[k].kind.value_or(config.space.boundary),
                  config.faces[k].values, points_of_face(config, face_of(k)));
  for (std::size_t k = 0; k < config.solids.size(); ++k) {
    const solid_table& solid = config.solids[k];
    std::vector<std::array<double, 2>> sides;
    for (std::size_t d = 0; d < solid.from.size(); ++d) sides.push_back({solid.from[d], solid.to[d]});
    check.surface(fmt::format("space.solid.{}", k + 1), solid.kind, solid.values, points_of_box(sides, -1));
  }
  check.source();
  return check.warnings;
}

}  // namespace apsis
