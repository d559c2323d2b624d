#include <apsis/core/errors.hpp>
#include <apsis/integrate/newton_problem.hpp>
#include <apsis/model/general_model.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace apsis {
namespace {

using number = general_model::number;

number widen(double x) {
  return number(x);
}
number widen(const dual<double>& x) {
  return number(x);  // the dual becomes the outer variable
}
const number& widen(const number& x) {
  return x;
}

void narrow(const number& x, double& out) {
  out = x.derivative(0, 0);
}
void narrow(const number& x, dual<double>& out) {
  out = dual<double>(0.0, true) * x.derivative(1, 0) + x.derivative(0, 0);
}
void narrow(const number& x, number& out) {
  out = x;
}

/// Evaluates the model's Q for every scalar type of Newton's method, by means of the widest type.
struct collision_callable {
  const general_model* equation;

  template <class In, class Out>
  void operator()(const In& u, Out& out) const {
    std::vector<number> wide(u.size()), q(u.size());
    for (std::size_t k = 0; k < u.size(); ++k) wide[k] = widen(u[k]);
    equation->collision(wide.data(), q.data());
    for (std::size_t k = 0; k < u.size(); ++k) narrow(q[k], out[k]);
  }
};

struct no_source {
  void operator()(double, const std::vector<double>&, std::vector<double>&) const {}
};

/// Solves stages and evaluates Q/ε point by point.
class newton_collision final : public point_collision {
 public:
  explicit newton_collision(const general_model& equation)
      : components_(equation.components()),
        local_({}, collision_callable{&equation},
               newton_options{.dense_limit = std::numeric_limits<std::size_t>::max()}) {
    local_.with_admissible([&equation](std::span<const double> u) { return equation.admissible(u.data()); });
  }

  void solve_stage(double a, double b, const point_batch& at, double* u) override {
    for (int p = 0; p < at.count; ++p)
      at_point(p, at, [&](double over_epsilon) {
        double* row = u + p * at.pitch;
        load(row);
        // Avoids 0·∞ if a or b is 0.
        const double first = a == 0.0 ? 0.0 : a * over_epsilon;
        const double second = b == 0.0 ? 0.0 : b * over_epsilon * over_epsilon;
        if (!std::isfinite(first) || !std::isfinite(second))
          throw numerical_error(
              "the stage has no Newton equation (dt/epsilon or its square is not a finite number); use a "
              "larger epsilon");
        local_.solve_collision(0.0, first, second, row_);
        std::copy(row_.begin(), row_.end(), row);
      });
  }

  void evaluate(const point_batch& at, const double* u, double* q) override {
    const target<std::vector<double>, double> to{&change_, 0.0, 1.0, true};
    for (int p = 0; p < at.count; ++p)
      at_point(p, at, [&](double over_epsilon) {
        if (!std::isfinite(over_epsilon))
          throw numerical_error(
              "Q/epsilon is not a finite number (the method evaluates it explicitly); choose an implicit or "
              "IMEX method");
        load(u + p * at.pitch);
        change_.resize(row_.size());
        local_.add_collision(0.0, row_, {&to, 1});
        double* row = q + p * at.pitch;
        for (std::size_t k = 0; k < row_.size(); ++k) row[k] = over_epsilon * change_[k];
      });
  }

 private:
  void load(const double* u) { row_.assign(u, u + components_); }

  /// Calls body(1/ε) and adds the cell of the point to its errors.
  template <class Body>
  static void at_point(int p, const point_batch& at, const Body& body) {
    try {
      body(1.0 / at.epsilon[p]);
    } catch (const numerical_error& failure) {
      failure_site site = failure.site();
      site.cell = at.first_cell + p / at.points_per_cell;
      throw numerical_error(failure.problem(), site);
    }
  }

  int components_;
  newton_problem<no_source, collision_callable> local_;
  std::vector<double> row_, change_;
};

}  // namespace

std::unique_ptr<point_collision> general_model::make_collision(const batch_limits&) const {
  return std::make_unique<newton_collision>(*this);
}

}  // namespace apsis
