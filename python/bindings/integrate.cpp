#include "arrays.hpp"
#include "callback.hpp"
#include "march.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include <pybind11/stl.h>

namespace apsis::python {
namespace {

using state = std::vector<double>;

struct functions {
  callback transport, moments, equilibrium, rate;
  std::optional<callback> forward_euler_step, admissible;
};

/// ω as the user's `moments` returned it. Where it is an array of numbers it is also a range of them, so that
/// ℛE = ω is checked; of anything else the range is empty.
class moments_value {
 public:
  explicit moments_value(py::object value) : value_(std::move(value)) {}
  const py::object& get() const { return value_; }
  const double* begin() const {
    // Classes of the user may run code of their own when they are converted.
    const bool plain = py::isinstance<py::array>(value_) || py::isinstance<py::float_>(value_) ||
                       py::isinstance<py::int_>(value_) || py::isinstance<py::list>(value_) ||
                       py::isinstance<py::tuple>(value_);
    if (!numbers_) numbers_ = plain ? array::ensure(value_) : array();
    return *numbers_ ? numbers_->data() : nullptr;
  }
  const double* end() const { return begin() + (*numbers_ ? numbers_->size() : 0); }

 private:
  py::object value_;
  mutable std::optional<array> numbers_;
};

struct result {
  py::array_t<double> t, u;
  long steps, rejected;
};

/// States at the times t[0] < t[1] < …, beginning with u0 itself.
result integrate_python(const functions& of, double epsilon, const array& u0, const std::vector<double>& t,
                        const method& m, const step_choice& choice) {
  const std::vector<py::ssize_t> shape(u0.shape(), u0.shape() + u0.ndim());
  state u(u0.data(), u0.data() + u0.size());
  if (u.empty()) throw input_error("u0 has no numbers; give an initial state");
  const auto look = [&shape](const state& v) { return to_fixed_array(v, shape); };
  auto problem = make_relaxation_problem<state>(
      [&](double time, const state& v, state& out) {
        of.transport.numbers(of.transport(time, look(v)), shape, out);
      },
      [&](const state& v) { return moments_value(of.moments.something(of.moments(look(v)))); },
      [&](const moments_value& omega, state& out) {
        of.equilibrium.numbers(of.equilibrium(omega.get()), shape, out);
      },
      [&](const moments_value& omega, state& out) { of.rate.broadcast(of.rate(omega.get()), shape, out); },
      epsilon);
  if (of.forward_euler_step)
    problem.with_forward_euler_step([&](double time, const state& v) {
      return of.forward_euler_step->number((*of.forward_euler_step)(time, look(v)));
    });
  if (of.admissible)
    problem.with_admissible([&](const state& v) { return of.admissible->truth((*of.admissible)(look(v))); });
  state all = u;
  const auto march = [&](auto& of_method) {
    return march_through(
        of_method, u, t, m, choice, of.forward_euler_step.has_value(), largest_difference,
        [&all](const state& now) { all.insert(all.end(), now.begin(), now.end()); },
        [] {
          if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        });
  };
  exact_collisions exact(problem);
  const auto count = solves_exactly(m.kind) ? march(exact) : march(problem);
  std::vector<py::ssize_t> shape_of_all = {static_cast<py::ssize_t>(t.size())};
  shape_of_all.insert(shape_of_all.end(), shape.begin(), shape.end());
  return {to_array(std::vector<double>(t)), to_array(std::move(all), shape_of_all), count.steps,
          count.rejected};
}

}  // namespace

void bind_integrate(py::module_& m) {
  m.def("integrate",
        [](const py::function& transport, const py::function& moments, const py::function& equilibrium,
           const py::function& rate, const std::optional<py::function>& forward_euler_step,
           const std::optional<py::function>& admissible, double epsilon, const array& u0,
           const std::vector<double>& t, const apsis::method& method, std::optional<double> dt, double safety,
           std::optional<int> growth, std::optional<double> tolerance, const std::string& controller) {
          auto [times, states, steps, rejected] =
              integrate_python({callback(transport, "transport"), callback(moments, "moments"),
                                callback(equilibrium, "equilibrium"), callback(rate, "rate"),
                                optional_callback(forward_euler_step, "forward_euler_step"),
                                optional_callback(admissible, "admissible")},
                               epsilon, u0, t, method, {dt, safety, growth, tolerance, controller});
          return py::make_tuple(times, states, steps, rejected);
        });
}

}  // namespace apsis::python
