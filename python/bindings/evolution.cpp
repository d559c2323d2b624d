#include <apsis/integrate/evolution.hpp>

#include "arrays.hpp"
#include "callback.hpp"
#include "preconditioner.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/end_error.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

namespace apsis::python {
namespace {

using state = std::vector<double>;

/// The functions of u' = T(t, u) + Q(t, u): attributes of an object of Python (ivp.py), None where one is
/// missing.
struct equations {
  explicit equations(const py::object& of)
      : transport(optional_of(of, "transport")),
        collision(optional_of(of, "collision")),
        forward_euler_step(optional_of(of, "forward_euler_step")),
        admissible(optional_of(of, "admissible")),
        events(optional_of(of, "events")),
        preconditioner(optional_of(of, "preconditioner")),
        product(of.attr("product"), "jac"),
        curvature(of.attr("curvature"), "jac"),
        time_derivative(of.attr("time_derivative"), "collision") {}

  static std::optional<callback> optional_of(const py::object& of, const char* name) {
    return optional_callback(of.attr(name).cast<std::optional<py::function>>(), name);
  }

  std::optional<callback> transport, collision, forward_euler_step, admissible, events, preconditioner;
  callback product, curvature, time_derivative;
};

py::array_t<double> look(std::span<const double> u) {
  return to_fixed_array(u, {static_cast<py::ssize_t>(u.size())});
}

/// out ← what the function returns for the arguments.
template <class... Arguments>
void call(const callback& function, std::span<double> out, const Arguments&... arguments) {
  function.numbers(function(arguments...), {static_cast<py::ssize_t>(out.size())}, out);
}

/// Q and its derivatives (`differentiated_in_time`); 0 without Q.
class timed_field {
 public:
  explicit timed_field(const equations& of) : of_(&of) {}

  void set_time(double t) { t_ = t; }
  void value(std::span<const double> u, std::span<double> out) {
    if (of_->collision)
      call(*of_->collision, out, t_, look(u));
    else
      std::fill(out.begin(), out.end(), 0.0);
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) {
    call(of_->product, jx, t_, look(u), look(x));
  }
  void curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx) {
    call(of_->curvature, hx, t_, look(u), look(k), look(x));
  }
  void time_derivative(std::span<const double> u, std::span<double> out) {
    call(of_->time_derivative, out, t_, look(u));
  }

 private:
  const equations* of_;
  double t_ = 0.0;
};

/// T; 0 without one.
struct transport {
  const equations* of;

  void operator()(double t, const state& u, state& out) const {
    if (of->transport)
      call(*of->transport, out, t, look(u));
    else
      std::fill(out.begin(), out.end(), 0.0);
  }
};

/// The problem, with the number of matrices that were factorized.
class counted_problem : public newton_problem<transport, timed_field> {
 public:
  using parent = newton_problem<transport, timed_field>;
  counted_problem(const equations& of, linear_solver solver)
      : parent({&of}, timed_field(of), newton_options{.solver = solver, .warns_of_cost = false}) {}

  void solve_collision(double t, double a, double b, state& u) {
    parent::solve_collision(t, a, b, u);
    count(a, b);
  }
  void solve_timed_collision(double t, double a, double b, state& u) {
    parent::solve_timed_collision(t, a, b, u);
    count(a, b);
  }
  long systems() const { return systems_; }

 private:
  void count(double a, double b) {
    if (a != 0.0 || b != 0.0) systems_ += report().factorizations;
  }

  long systems_ = 0;
};

/// Number of rows, and row, column and value of every entry.
using mass_entries = std::pair<std::size_t, std::vector<std::tuple<std::size_t, std::size_t, double>>>;

std::optional<mass_matrix<double>> matrix_of(const std::optional<mass_entries>& of) {
  if (!of) return std::nullopt;
  std::vector<mass_matrix<double>::entry> entries;
  for (const auto& [row, column, value] : of->second) entries.push_back({row, column, value});
  return mass_matrix<double>(of->first, entries);
}

/// How long steps are.
struct step_lengths {
  std::vector<double> rtol, atol;         ///< one number, or one for each unknown
  std::optional<double> dt, first, most;  ///< dt: of every step, without error control
  std::string controller;                 ///< name of the step_law
};

step_rule<double> rule_of(const step_lengths& steps, bool limited) {
  if (steps.dt) return step_rule<double>::fixed(*steps.dt);
  if (limited) return step_rule<double>::ssp();
  return steps.most ? step_rule<double>::fixed(*steps.most) : step_rule<double>::unlimited();
}

/// An evolution of a system with functions of Python. It holds the interpreter while it advances.
class python_evolution {
 public:
  python_evolution(const py::object& of, const method& m, const step_lengths& steps, bool krylov,
                   const std::optional<std::pair<std::size_t, std::vector<sparsity_pattern::place>>>& places,
                   std::optional<mass_matrix<double>> mass, event_functions<state, double> events)
      : of_(of), problem_(of_, krylov ? linear_solver::krylov : linear_solver::dense) {
    std::optional<step_tolerance<state, double>> tolerance;
    if (!steps.dt) {
      const component_tolerances<double> wanted(steps.rtol, steps.atol);
      problem_.with_tolerances(wanted);
      tolerance = {1.0, wanted, steps.first, steps.controller};
    }
    if (places) problem_.with_sparsity(sparsity_pattern(places->first, places->second));
    if (mass) problem_.with_mass(std::move(*mass));
    if (of_.preconditioner)
      problem_.with_preconditioner([this](double t, std::span<const double> v, double gamma) {
        return solver_of((*of_.preconditioner)(t, look(v), gamma));
      });
    if (of_.admissible)
      problem_.with_admissible(
          [this](std::span<const double> v) { return of_.admissible->truth((*of_.admissible)(look(v))); });
    if (of_.forward_euler_step)
      problem_.with_forward_euler_step([this](double t, const state& u) {
        return of_.forward_euler_step->number((*of_.forward_euler_step)(t, look(u)));
      });
    evolution_.emplace(m, problem_, rule_of(steps, of_.forward_euler_step.has_value()), tolerance);
    events.evaluate = [this](double t, const state& u, std::span<double> g) {
      call(*of_.events, g, t, look(u));
    };
    evolution_->set_events(std::move(events), [this](std::size_t k, double t, const state& u) {
      found_.append(py::make_tuple(k, t, look(u)));
    });
  }
  python_evolution(const python_evolution&) = delete;
  python_evolution& operator=(const python_evolution&) = delete;

  void start(double t, const state& u) { evolution_->start(t, u); }

  /// Returns whether an event ended it.
  bool advance(double t1, const py::function& observe) {
    const auto end = evolution_->advance(t1, [&](long, double, double, const state&) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      observe();
      return true;
    });
    return end == evolution_end::event;
  }

  py::array_t<double> at(double t) { return look(evolution_->at(t)); }
  py::array_t<double> step_from(double t0, const state& u, double t) {
    return look(evolution_->step_from(t0, u, t));
  }
  double t() const { return evolution_->t(); }
  double begin_of_step() const { return evolution_->begin_of_step(); }
  py::array_t<double> u() const { return look(evolution_->u()); }
  const py::list& found() const { return found_; }
  long steps() const { return evolution_->steps(); }
  long rejected() const { return evolution_->rejected(); }
  long systems() const { return problem_.systems(); }

 private:
  equations of_;
  counted_problem problem_;
  std::optional<evolution<counted_problem>> evolution_;
  py::list found_;
};

}  // namespace

void bind_evolution(py::module_& m) {
  m.def("refine_until_accurate", [](const py::function& solve, const py::function& difference) {
    const auto found = refine_until_accurate([&](double factor) -> py::object { return solve(factor); },
                                             [&](const py::object& coarse, const py::object& fine) {
                                               return difference(coarse, fine).cast<double>();
                                             });
    return py::make_tuple(found.solution, found.factor, found.error);
  });
  py::class_<python_evolution>(m, "Evolution")
      .def(py::init(
               [](const py::object& of, const method& by, std::vector<double> rtol, std::vector<double> atol,
                  std::optional<double> dt, std::optional<double> first, std::optional<double> most,
                  std::string controller, bool krylov,
                  const std::optional<std::pair<std::size_t, std::vector<sparsity_pattern::place>>>& places,
                  const std::optional<mass_entries>& mass, const std::vector<int>& directions,
                  std::vector<bool> ends) {
                 return std::make_unique<python_evolution>(
                     of, by,
                     step_lengths{std::move(rtol), std::move(atol), dt, first, most, std::move(controller)},
                     krylov, places, matrix_of(mass),
                     event_functions<state, double>{directions.size(), {}, directions, std::move(ends)});
               }),
           py::keep_alive<1, 3>())
      .def("start", &python_evolution::start)
      .def("advance", &python_evolution::advance)
      .def("at", &python_evolution::at)
      .def("step_from", &python_evolution::step_from)
      .def_property_readonly("t", &python_evolution::t)
      .def_property_readonly("begin_of_step", &python_evolution::begin_of_step)
      .def_property_readonly("u", &python_evolution::u)
      .def_property_readonly("found", &python_evolution::found)
      .def_property_readonly("steps", &python_evolution::steps)
      .def_property_readonly("rejected", &python_evolution::rejected)
      .def_property_readonly("systems", &python_evolution::systems);
}

}  // namespace apsis::python
