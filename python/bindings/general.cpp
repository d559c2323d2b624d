#include "arrays.hpp"
#include "callback.hpp"
#include "march.hpp"
#include "preconditioner.hpp"
#include "side_by_side.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include <pybind11/stl.h>

namespace apsis::python {
namespace {

using state = std::vector<double>;
using extents = std::vector<py::ssize_t>;

struct transport_functions {
  std::optional<callback> transport, forward_euler_step;
};

/// Q and its derivatives at one point, an array of the given shape (`differentiated`).
class python_field {
 public:
  python_field(const collision_functions& of, extents shape) : of_(&of), shape_(std::move(shape)) {}

  void value(std::span<const double> u, std::span<double> out) {
    of_->collision.numbers(of_->collision(look(u)), shape_, out);
  }
  void jacobian_product(std::span<const double> u, std::span<const double> x, std::span<double> jx) {
    of_->product.numbers(of_->product(look(u), look(x)), shape_, jx);
  }
  void curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                 std::span<double> hx) {
    of_->curvature.numbers(of_->curvature(look(u), look(k), look(x)), shape_, hx);
  }

 private:
  py::array_t<double> look(std::span<const double> u) const { return to_fixed_array(u, shape_); }

  const collision_functions* of_;
  extents shape_;
};

/// Collisions that couple the numbers of a cell only, which are contiguous. Cells are solved one after
/// another.
class collisions_alone {
 public:
  collisions_alone(const collision_functions& of, const extents& cell, linear_solver solver)
      : of_(of),
        shape_(cell),
        local_({}, python_field(of, cell), newton_options{.solver = solver, .warns_of_cost = false}) {
    for (const auto n : cell) length_ *= static_cast<std::size_t>(n);
    cell_.resize(length_);
    if (of.preconditioner)
      local_.with_preconditioner([this](double, std::span<const double> v, double gamma) {
        return solver_of((*of_.preconditioner)(to_fixed_array(v, shape_), gamma));
      });
    if (of.admissible)
      local_.with_admissible([this](std::span<const double> v) {
        return of_.admissible->truth((*of_.admissible)(to_fixed_array(v, shape_)));
      });
  }

  void evaluate(const state& u, state& rate) {
    rate = u;
    const target<state, double> to{&rate_, 0.0, 1.0, true};
    rate_.resize(length_);
    for_each_cell(rate, [&](state& cell) {
      local_.add_collision(0.0, cell, {&to, 1});
      cell = rate_;
    });
  }
  void solve(double t, double a, double b, state& u) {
    state solved = u;
    for_each_cell(solved, [&](state& cell) { local_.solve_collision(t, a, b, cell); });
    u.swap(solved);
  }
  void begin_step(double t, const state& u) {
    if (of_.preconditioner) local_.begin_step(t, u);
  }
  bool are_admissible(const state& u) {
    if (!of_.admissible) return true;
    state copy = u;
    bool all = true;
    for_each_cell(copy, [&](const state& cell) { all = all && local_.is_admissible(cell); });
    return all;
  }

 private:
  /// Calls body(cell) for every cell, which it may change. Failures get the number of the cell.
  template <class Body>
  void for_each_cell(state& u, const Body& body) {
    const std::size_t cells = u.size() / length_;
    for (std::size_t i = 0; i < cells; ++i) {
      const auto begin = u.begin() + static_cast<std::ptrdiff_t>(i * length_);
      std::copy_n(begin, length_, cell_.begin());
      try {
        body(cell_);
      } catch (const numerical_error& failure) {
        failure_site site = failure.site();
        if (cells > 1) site.cell = static_cast<int>(i);
        throw numerical_error(failure.problem(), site);
      }
      std::copy_n(cell_.begin(), length_, begin);
    }
  }

  const collision_functions& of_;
  extents shape_;
  std::size_t length_ = 1;
  newton_problem<no_transport, python_field> local_;
  state cell_, rate_;
};

/// u' = T(t, u) + Q(u)
template <class Collisions>
class general_problem {
 public:
  using state = python::state;
  using real = double;

  general_problem(const transport_functions& of, extents shape, Collisions& collisions)
      : of_(of), shape_(std::move(shape)), collisions_(collisions) {}

  void add_transport(double t, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& { return transport(t, u); });
  }
  void add_collision(double, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& {
      collisions_.evaluate(u, work_);
      return work_;
    });
  }
  void solve_collision(double t, double a, double b, state& u) { collisions_.solve(t, a, b, u); }
  void begin_step(double t, const state& u) { collisions_.begin_step(t, u); }
  void end_step() {}
  bool is_admissible(const state& u) { return collisions_.are_admissible(u); }
  bool has_transport(double t, const state& u) { return of_.transport && !is_zero(transport(t, u)); }
  double forward_euler_step(double t, const state& u) const {
    if (!of_.forward_euler_step) return std::numeric_limits<double>::infinity();
    return of_.forward_euler_step->number((*of_.forward_euler_step)(t, to_fixed_array(u, shape_)));
  }

 private:
  const state& transport(double t, const state& u) {
    work_.assign(u.size(), 0.0);
    if (of_.transport) of_.transport->numbers((*of_.transport)(t, to_fixed_array(u, shape_)), shape_, work_);
    return work_;
  }

  const transport_functions& of_;
  extents shape_;
  Collisions& collisions_;
  state work_;
};

/// Where an integration begins, its times, its method and its steps.
struct march_plan {
  const array& u0;
  const std::vector<double>& t;
  const method& by;
  const step_choice& steps;
};

template <class Collisions>
py::tuple integrate_general(const transport_functions& of, Collisions& collisions, const march_plan& plan) {
  const extents shape(plan.u0.shape(), plan.u0.shape() + plan.u0.ndim());
  state u(plan.u0.data(), plan.u0.data() + plan.u0.size());
  general_problem<Collisions> problem(of, shape, collisions);
  state all = u;
  const auto count = march_through(
      problem, u, plan.t, plan.by, plan.steps, of.forward_euler_step.has_value(), largest_difference,
      [&all](const state& now) { all.insert(all.end(), now.begin(), now.end()); },
      [] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      });
  extents shape_of_all = {static_cast<py::ssize_t>(plan.t.size())};
  shape_of_all.insert(shape_of_all.end(), shape.begin(), shape.end());
  return py::make_tuple(to_array(std::vector<double>(plan.t)), to_array(std::move(all), shape_of_all),
                        count.steps, count.rejected);
}

/// The numbers that a collision couples, and with which its functions are called.
enum class coupling { all, cell, cells };

}  // namespace

void bind_general(py::module_& m) {
  py::enum_<coupling>(m, "Coupling")
      .value("all", coupling::all)
      .value("cell", coupling::cell)
      .value("cells", coupling::cells);
  m.def(
      "integrate_general",
      [](const py::function& collision, const py::function& product, const py::function& curvature,
         const std::optional<py::function>& transport, const std::optional<py::function>& forward_euler_step,
         const std::optional<py::function>& admissible, const std::optional<py::function>& preconditioner,
         coupling coupled, bool krylov, const array& u0, const std::vector<double>& t,
         const apsis::method& method, std::optional<double> dt, double safety, std::optional<int> growth,
         std::optional<double> tolerance, const std::string& controller) {
        if (u0.size() == 0) throw input_error("u0 has no numbers; give an initial state");
        const collision_functions q{
            callback(collision, "collision"), callback(product, "the derivative of collision"),
            callback(curvature, "the second derivative of collision"),
            optional_callback(admissible, "admissible"), optional_callback(preconditioner, "preconditioner")};
        const transport_functions of{optional_callback(transport, "transport"),
                                     optional_callback(forward_euler_step, "forward_euler_step")};
        const auto solver = krylov ? linear_solver::krylov : linear_solver::dense;
        const step_choice steps{dt, safety, growth, tolerance, controller};
        const march_plan plan{u0, t, method, steps};
        if (coupled == coupling::cells) {
          collisions_side_by_side side_by_side(q, static_cast<std::size_t>(u0.shape(u0.ndim() - 1)), solver);
          return integrate_general(of, side_by_side, plan);
        }
        extents cell(u0.shape(), u0.shape() + u0.ndim());
        if (coupled == coupling::cell) cell = {cell.back()};
        collisions_alone alone(q, cell, solver);
        return integrate_general(of, alone, plan);
      });
}

}  // namespace apsis::python
