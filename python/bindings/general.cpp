#include "arrays.hpp"
#include "callback.hpp"
#include "march.hpp"

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

struct general_functions {
  callback collision, product, curvature;
  std::optional<callback> transport, forward_euler_step, admissible;
};

/// Q and its derivatives at one point, an array of the given shape (`differentiated`).
class python_field {
 public:
  python_field(const general_functions& of, extents shape) : of_(&of), shape_(std::move(shape)) {}

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

  const general_functions* of_;
  extents shape_;
};

/// u' = T(t, u) + Q(u), where Q couples the numbers of a cell only, which are contiguous.
class general_problem {
 public:
  using state = python::state;
  using real = double;

  general_problem(const general_functions& of, extents shape, const extents& cell, linear_solver solver)
      : of_(of), shape_(std::move(shape)), local_({}, python_field(of, cell), newton_options{solver}) {
    for (const auto n : cell) length_ *= static_cast<std::size_t>(n);
    cell_.resize(length_);
    if (of.admissible)
      local_.with_admissible([this, cell](std::span<const double> v) {
        return of_.admissible->truth((*of_.admissible)(to_fixed_array(v, cell)));
      });
  }

  void add_transport(double t, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& { return transport(t, u); });
  }
  void add_collision(double, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& {
      work_ = u;
      const target<state, double> to{&rate_, 0.0, 1.0, true};
      rate_.resize(length_);
      for_each_cell(work_, [&](state& cell) {
        local_.add_collision(0.0, cell, {&to, 1});
        cell = rate_;
      });
      return work_;
    });
  }
  void solve_collision(double t, double a, double b, state& u) {
    state solved = u;
    for_each_cell(solved, [&](state& cell) { local_.solve_collision(t, a, b, cell); });
    u.swap(solved);
  }
  bool is_admissible(const state& u) {
    if (!of_.admissible) return true;
    state copy = u;
    bool all = true;
    for_each_cell(copy, [&](const state& cell) { all = all && local_.is_admissible(cell); });
    return all;
  }
  bool has_transport(double t, const state& u) { return of_.transport && !is_zero(transport(t, u)); }
  double forward_euler_step(double t, const state& u) const {
    if (!of_.forward_euler_step) return std::numeric_limits<double>::infinity();
    return of_.forward_euler_step->number((*of_.forward_euler_step)(t, to_fixed_array(u, shape_)));
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

  const state& transport(double t, const state& u) {
    work_.assign(u.size(), 0.0);
    if (of_.transport) of_.transport->numbers((*of_.transport)(t, to_fixed_array(u, shape_)), shape_, work_);
    return work_;
  }

  const general_functions& of_;
  extents shape_;
  std::size_t length_ = 1;
  newton_problem<no_transport, python_field> local_;
  state cell_, work_, rate_;
};

py::tuple integrate_general(const general_functions& of, bool local, bool krylov, const array& u0,
                            const std::vector<double>& t, const method& m, const step_choice& choice) {
  const extents shape(u0.shape(), u0.shape() + u0.ndim());
  state u(u0.data(), u0.data() + u0.size());
  if (u.empty()) throw input_error("u0 has no numbers; give an initial state");
  general_problem problem(of, shape, local ? extents{shape.back()} : shape,
                          krylov ? linear_solver::krylov : linear_solver::dense);
  state all = u;
  const auto count = march_through(
      problem, u, t, m, choice, of.forward_euler_step.has_value(), largest_difference,
      [&all](const state& now) { all.insert(all.end(), now.begin(), now.end()); },
      [] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      });
  extents shape_of_all = {static_cast<py::ssize_t>(t.size())};
  shape_of_all.insert(shape_of_all.end(), shape.begin(), shape.end());
  return py::make_tuple(to_array(std::vector<double>(t)), to_array(std::move(all), shape_of_all), count.steps,
                        count.rejected);
}

}  // namespace

void bind_general(py::module_& m) {
  m.def("integrate_general", [](const py::function& collision, const py::function& product,
                                const py::function& curvature, const std::optional<py::function>& transport,
                                const std::optional<py::function>& forward_euler_step,
                                const std::optional<py::function>& admissible, bool local, bool krylov,
                                const array& u0, const std::vector<double>& t, const apsis::method& method,
                                std::optional<double> dt, double safety, std::optional<int> growth,
                                std::optional<double> tolerance, const std::string& controller) {
    return integrate_general(
        {callback(collision, "collision"), callback(product, "the derivative of collision"),
         callback(curvature, "the second derivative of collision"), optional_callback(transport, "transport"),
         optional_callback(forward_euler_step, "forward_euler_step"),
         optional_callback(admissible, "admissible")},
        local, krylov, u0, t, method, {dt, safety, growth, tolerance, controller});
  });
}

}  // namespace apsis::python
