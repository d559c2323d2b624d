#include "arrays.hpp"
#include "callback.hpp"
#include "given_data.hpp"
#include "kinetic_description.hpp"
#include "library_call.hpp"
#include "march.hpp"
#include "problem_pool.hpp"
#include "quantities.hpp"

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/config/choices.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/model/velocity_support.hpp>
#include <apsis/run/cfl_limit.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace apsis::python {
namespace {

/// Tells the limiter of a problem which steps an integration makes; other calls mean the longest ones.
class limited_steps {
 public:
  limited_steps(semidiscrete_problem& of, double share) : of_(of) { of_.limit_for_steps(share); }
  ~limited_steps() { of_.limit_for_steps(1.0); }
  limited_steps(const limited_steps&) = delete;
  limited_steps& operator=(const limited_steps&) = delete;

 private:
  semidiscrete_problem& of_;
};

/// A model on a mesh, by the problem_builder of the library. Threads may share the object: what its calls
/// write is their own.
class kinetic_problem {
 public:
  kinetic_problem(const kinetic_description& of, const py::object& epsilon)
      : equation_(make_equation(of)), builder_(*equation_) {
    if (builder_.has_space()) {
      builder_.on(make_grid(of));
      for (std::size_t k = 0; k < 2 * of.boundary.size(); ++k) {
        const std::string name = fmt::format("boundary['{}']", apsis::face_names[k]);
        builder_.with_boundary(face_of(k), make_face(of.boundary[k / 2][k % 2], *equation_, name));
      }
      if (auto force = make_acceleration(of, *equation_)) builder_.with_force(std::move(*force));
      builder_.with_discretization(of.discretization);
      builder_.with_collisions_at(of.collisions);
      if (of.positivity) builder_.with_positivity_limiter();
      scheme_ = find_reconstruction(of.reconstruction).make();
      builder_.with_reconstruction(find_reconstruction(of.reconstruction).make());
    }
    // The function of the user is called here, once for each point, and not by the threads of a step.
    if (PyCallable_Check(epsilon.ptr()) != 0) {
      const callback function(py::reinterpret_borrow<py::function>(epsilon), "epsilon");
      const int dimensions = equation_->space_dimensions();
      builder_.with_epsilon([function, dimensions](const position& x) {
        return function.number(function(*coordinates(x, dimensions)));
      });
    } else {
      builder_.with_epsilon([value = epsilon.cast<double>()](const position&) { return value; });
    }
    const interruptible building(raise_pending_signals);
    implicit_.take();
  }

  int components() const { return equation_->components(); }
  std::vector<py::ssize_t> shape() const { return {builder_.mesh().size(), components()}; }

  py::array_t<double> centres() const {
    const int dimensions = equation_->space_dimensions();
    std::vector<double> all;
    for (int cell = 0; cell < builder_.mesh().size(); ++cell) {
      const position x = builder_.mesh().centre(cell);
      all.insert(all.end(), x.begin(), x.begin() + dimensions);
    }
    const auto n = static_cast<py::ssize_t>(dimensions > 0 ? builder_.mesh().size() : 0);
    return dimensions > 1 ? to_array(std::move(all), {n, dimensions}) : to_array(std::move(all));
  }

  py::array_t<double> velocities() const {
    const velocity_set& set = equation_->velocities();
    std::vector<double> all;
    for (int j = 0; j < set.components(); ++j)
      for (int k = 0; k < set.dimensions(); ++k) all.push_back(set.speeds(k)[static_cast<std::size_t>(j)]);
    return set.dimensions() > 1 ? to_array(std::move(all), {set.components(), set.dimensions()})
                                : to_array(std::move(all));
  }

  py::array_t<double> epsilon() const { return to_array(builder_.epsilon_at_centres()); }

  py::array_t<double> sample_named(const std::string& name) const {
    const auto& all = equation_->initial();
    std::vector<std::string> names;
    for (const auto& data : all) {
      if (data.name == name) {
        field u;
        const interruptible sampling(raise_pending_signals);
        {
          const py::gil_scoped_release others;
          u = builder_.sample(data.point_value, data.jumps);
        }
        return checked(u);
      }
      names.push_back(data.name);
    }
    throw input_error(fmt::format("unknown initial data '{}' (there is no such name); {}", name.substr(0, 60),
                                  suggest(name, names)));
  }

  py::array_t<double> sample_function(const py::function& function, const std::vector<double>& jumps) const {
    const callback data(function, "initial");
    const interruptible sampling(raise_pending_signals);
    const int dimensions = equation_->space_dimensions();
    std::vector<double> row(static_cast<std::size_t>(components()));
    return checked(builder_.sample(
        [&](const position& x, std::span<double> u) {
          data.numbers(data(*coordinates(x, dimensions)), {components()}, row);
          std::copy(row.begin(), row.end(), u.begin());
        },
        jumps));
  }

  py::array_t<double> state(const py::dict& variables, const std::vector<double>& jumps) const {
    const interruptible sampling(raise_pending_signals);
    return checked(make_state(variables, *equation_, builder_, jumps, "state"));
  }

  py::dict fields(const array& u) const {
    const field state = to_field(u);
    const field_group group = equation_->fields().front();
    const auto& names = group.names;
    std::vector<std::vector<double>> columns(names.size());
    std::vector<double> values(names.size());
    for (int cell = 0; cell < state.cells(); ++cell) {
      group.compute({state.row(cell)}, values.data());
      for (std::size_t k = 0; k < names.size(); ++k) columns[k].push_back(values[k]);
    }
    py::dict out;
    for (std::size_t k = 0; k < names.size(); ++k)
      out[py::str(names[k].name)] = to_array(std::move(columns[k]));
    return out;
  }

  py::array_t<double> velocity_missed(const array& u) const {
    const field state = to_field(u);
    const auto support = support_of(*equation_);
    std::vector<double> missed(static_cast<std::size_t>(state.cells()),
                               std::numeric_limits<double>::quiet_NaN());
    if (!support) return to_array(std::move(missed));
    const gas& molecules = support->molecules();
    std::vector<double> omega(static_cast<std::size_t>(molecules.moment_count()));
    fluid_state of_cell;
    for (int cell = 0; cell < state.cells(); ++cell) {
      molecules.moments(state.row(cell), 0, 1, omega.data());
      if (const auto fit = support->fit_of_moments(omega.data(), of_cell))
        missed[static_cast<std::size_t>(cell)] = fit->missed;
    }
    return to_array(std::move(missed));
  }

  py::array_t<double> transport(const array& u, double t) {
    field result = to_field(u);
    const field state = result;
    const target<field, double> to{&result, 0.0, 1.0, true};
    call(state, [&](semidiscrete_problem& of) { of.add_transport(t, state, {&to, 1}); });
    return from_field(result);
  }

  py::array_t<double> collision(const array& u, double t) {
    field result = to_field(u);
    const field state = result;
    const target<field, double> to{&result, 0.0, 1.0, true};
    call(state, [&](semidiscrete_problem& of) { of.add_collision(t, state, {&to, 1}); });
    return from_field(result);
  }

  py::array_t<double> solve_collision(const array& u, double a, double b, double t) {
    field state = to_field(u);
    call(state, [&](semidiscrete_problem& of) { of.solve_collision(t, a, b, state); });
    return from_field(state);
  }

  py::array_t<double> project_to_equilibrium(const array& u, double t) {
    field state = to_field(u);
    call(state, [&](semidiscrete_problem& of) { of.project_to_equilibrium(t, state); });
    return from_field(state);
  }

  double forward_euler_step(const array& u) {
    const field state = to_field(u);
    double dt = 0.0;
    call(state, [&](const semidiscrete_problem& of) { dt = of.forward_euler_step(0.0, state); });
    return dt;
  }

  /// Returns the stable part of r: r Δt_FE may exceed the linear stability limit.
  double stable_fraction(const method& m) const {
    if (!scheme_) return 1.0;
    return std::min(
        1.0, cfl_limit(amplification(m), *scheme_) / (builder_.cfl_number() * m.coefficients<double>().r));
  }

  /// Returns the share of r Δt_FE that the limiter is for, as in a run of a case: 1 where steps are not
  /// known.
  static double limiter_share(const semidiscrete_problem& of, const field& u, const method& m,
                              const step_choice& choice) {
    if (choice.tolerance) return 1.0;
    const double r = m.coefficients<double>().r, t = 0.0;
    const double dt = choice.dt.value_or(choice.safety * (r * of.forward_euler_step(t, u)));
    return of.share_of_longest_step(r, dt, t, u);
  }

  py::tuple integrate(const array& u0, const std::vector<double>& t, const method& m,
                      const step_choice& choice, std::optional<int> threads) {
    field u = to_field(u0);
    const library_call own(threads.value_or(threads_for(u)));
    const auto problem = problems_for(m.kind).take();
    step_choice stable = choice;
    if (!choice.dt) stable.safety *= stable_fraction(m);
    std::vector<double> all;
    append(u, all);
    step_count count;
    {
      const py::gil_scoped_release others;
      const limited_steps during(*problem, limiter_share(*problem, u, m, stable));
      count = march_through(
          *problem, u, t, m, stable, true, largest_difference, [&all](const field& now) { append(now, all); },
          raise_pending_signals);
    }
    return py::make_tuple(
        to_array(std::vector<double>(t)),
        to_array(std::move(all), {static_cast<py::ssize_t>(t.size()), shape()[0], shape()[1]}), count.steps,
        count.rejected);
  }

  py::tuple solve_steady(const array& u0, const steady_options& options, std::optional<int> threads) {
    const relaxation_model* relaxes = equation_->as_relaxation();
    if (relaxes == nullptr)
      throw input_error(
          "the model has no steady solver (it does not relax to an equilibrium of its moments); march in "
          "time with integrate");
    field u = to_field(u0);
    const library_call own(threads.value_or(threads_for(u)));
    const auto problem = implicit_.take();
    std::vector<double> residuals, changes;
    {
      const py::gil_scoped_release others;
      steady_solver solver(*relaxes, builder_, *problem, u, options);
      solver.solve(u, [&](const steady_iteration& now) {
        residuals.push_back(now.residual);
        changes.push_back(now.change);
        raise_pending_signals();
      });
    }
    return py::make_tuple(from_field(u), to_array(std::move(residuals)), to_array(std::move(changes)));
  }

 private:
  /// The problems with the collisions that methods of a kind need.
  problem_pool& problems_for(method_kind kind) {
    if (kind == method_kind::explicit_only) return explicit_;
    return solves_exactly(kind) ? exact_ : implicit_;
  }

  /// Runs body(problem) with a problem of its own. Its threads call functions of the user, which need the
  /// GIL.
  template <class Body>
  void call(const field& u, const Body& body) {
    const library_call own(threads_for(u));
    const auto problem = implicit_.take();
    const py::gil_scoped_release others;
    body(*problem);
  }

  static py::tuple coordinates(const position& x, int dimensions) {
    py::tuple all(static_cast<std::size_t>(dimensions));
    for (int k = 0; k < dimensions; ++k) all[static_cast<std::size_t>(k)] = x[static_cast<std::size_t>(k)];
    return all;
  }

  /// Small problems gain little by more threads than one.
  static int threads_for(const field& u) {
    if (const int requested = requested_threads(); requested > 0) return requested;
    return static_cast<double>(u.cells()) * u.components() < 32768.0 ? 1 : default_threads();
  }

  /// max |u − v|, or NaN if one is.
  static double largest_difference(const field& u, const field& v) {
    double largest = 0.0;
    for (int cell = 0; cell < u.cells(); ++cell)
      for (int k = 0; k < u.components(); ++k) {
        const double difference = std::abs(u.row(cell)[k] - v.row(cell)[k]);
        if (!(difference <= largest)) largest = difference;
        if (std::isnan(difference)) return difference;
      }
    return largest;
  }

  static void append(const field& u, std::vector<double>& all) {
    for (int cell = 0; cell < u.cells(); ++cell)
      all.insert(all.end(), u.row(cell), u.row(cell) + u.components());
  }

  field to_field(const array& u) const {
    if (std::vector<py::ssize_t>(u.shape(), u.shape() + u.ndim()) != shape())
      throw input_error(
          fmt::format("a state has the shape ({}) (that of the problem is ({}, {})); give [cells, "
                      "components]",
                      fmt::join(u.shape(), u.shape() + u.ndim(), ", "), shape()[0], shape()[1]));
    field state(builder_.mesh().size(), components());
    for (int cell = 0; cell < state.cells(); ++cell)
      std::copy_n(u.data() + static_cast<std::ptrdiff_t>(cell) * components(), components(), state.row(cell));
    return state;
  }

  py::array_t<double> from_field(const field& u) const {
    std::vector<double> all;
    append(u, all);
    return to_array(std::move(all), shape());
  }

  /// The state, where the discrete model supports it.
  py::array_t<double> checked(const field& u) const {
    for (int cell = 0; cell < u.cells(); ++cell)
      if (const auto found = equation_->check_supported(u.row(cell)); !found.problem.empty())
        throw input_error(fmt::format("{} [cell {}]", found.problem, cell));
    warn_of_velocities(u);
    return from_field(u);
  }

  /// Warns of the cell whose Maxwellian the velocities of a gas miss most, if they miss too much.
  void warn_of_velocities(const field& u) const {
    const auto support = support_of(*equation_);
    if (!support) return;
    const gas& molecules = support->molecules();
    std::vector<double> omega(static_cast<std::size_t>(molecules.moment_count()));
    velocity_fit worst;
    fluid_state state, of_worst;
    int worst_cell = -1;
    for (int cell = 0; cell < u.cells(); ++cell) {
      molecules.moments(u.row(cell), 0, 1, omega.data());
      const auto fit = support->fit_of_moments(omega.data(), state);
      if (!fit || !(fit->missed > std::max(worst.missed, velocity_limits::good))) continue;
      worst = *fit;
      of_worst = state;
      worst_cell = cell;
    }
    if (worst_cell < 0) return;
    const auto found = velocity_problem(molecules, of_worst, worst, {.subject = "the data"});
    log::warning(fmt::format("{} [cell {}]", found.problem, worst_cell));
  }

  std::unique_ptr<model> equation_;
  problem_builder builder_;
  std::unique_ptr<reconstruction> scheme_;  ///< null without space
  problem_pool implicit_{[this] { return builder_.build(); }},
      explicit_{[this] { return problem_builder(builder_).with_explicit_collision().build(); }},
      exact_{[this] { return problem_builder(builder_).with_exact_collision().build(); }};
};

}  // namespace

void bind_kinetic(py::module_& m) {
  py::class_<kinetic_problem>(m, "KineticProblem")
      .def(py::init([](std::string model, std::map<std::string, double> parameters,
                       std::map<std::string, std::string> options,
                       std::map<std::string, std::vector<std::string>> lists, double velocity_max,
                       std::vector<int> velocity_points, std::vector<std::string> velocity_sets,
                       std::vector<given_line> velocity_lines, std::string equilibrium,
                       std::vector<int> cells, std::vector<std::array<double, 2>> domain,
                       std::vector<std::array<given_face, 2>> boundary, std::vector<py::object> acceleration,
                       std::vector<double> largest_acceleration, std::string reconstruction,
                       std::string discretization, std::string collisions, bool positivity,
                       const py::object& epsilon) {
        return std::make_unique<kinetic_problem>(
            kinetic_description{std::move(model), std::move(parameters), std::move(options), std::move(lists),
                                velocity_max, std::move(velocity_points), std::move(velocity_sets),
                                std::move(velocity_lines), std::move(equilibrium), std::move(cells),
                                std::move(domain), std::move(boundary), std::move(acceleration),
                                std::move(largest_acceleration), std::move(reconstruction),
                                std::move(discretization), std::move(collisions), positivity},
            epsilon);
      }))
      .def("shape", &kinetic_problem::shape)
      .def("centres", &kinetic_problem::centres)
      .def("velocities", &kinetic_problem::velocities)
      .def("epsilon", &kinetic_problem::epsilon)
      .def("sample_named", &kinetic_problem::sample_named)
      .def("sample_function", &kinetic_problem::sample_function)
      .def("state", &kinetic_problem::state)
      .def("fields", &kinetic_problem::fields)
      .def("velocity_missed", &kinetic_problem::velocity_missed)
      .def("transport", &kinetic_problem::transport)
      .def("collision", &kinetic_problem::collision)
      .def("solve_collision", &kinetic_problem::solve_collision)
      .def("project_to_equilibrium", &kinetic_problem::project_to_equilibrium)
      .def("forward_euler_step", &kinetic_problem::forward_euler_step)
      .def("solve_steady",
           [](kinetic_problem& problem, const array& u0, double tolerance, int iterations, int images,
              std::optional<int> threads) {
             return problem.solve_steady(u0, {tolerance, iterations, images}, threads);
           })
      .def("integrate",
           [](kinetic_problem& problem, const array& u0, const std::vector<double>& t,
              const apsis::method& by, std::optional<double> dt, double safety, std::optional<int> growth,
              std::optional<double> tolerance, const std::string& controller, std::optional<int> threads) {
             return problem.integrate(u0, t, by, {dt, safety, growth, tolerance, controller}, threads);
           });
}

}  // namespace apsis::python
