#include <apsis/semidiscrete/newton_collision.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/integrate/newton_problem.hpp>

#include <limits>
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
  return number(x);  // a dual becomes the outer variable
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

/// The model's Q for every scalar type that Newton's method asks for, through the widest of them.
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

class newton_collision final : public collision {
 public:
  explicit newton_collision(const general_model& equation) : local_({}, collision_callable{&equation}) {
    local_.with_admissible([&equation](std::span<const double> u) { return equation.admissible(u.data()); });
  }

  void solve(double, double a, double b, field& u) override {
    for (int cell = 0; cell < u.cells(); ++cell) {
      load(u, cell);
      local_.solve_collision(0.0, a, b, row_);
      std::copy(row_.begin(), row_.end(), u.row(cell));
    }
  }

  void add_collision(double, const field& u, std::span<const target<field, double>> targets) override {
    for (int cell = 0; cell < u.cells(); ++cell) {
      load(u, cell);
      change_.resize(row_.size());
      const target<std::vector<double>, double> to{&change_, 0.0, 1.0, true};
      local_.add_collision(0.0, row_, {&to, 1});
      for (const auto& wanted : targets) {
        double* acc = wanted.acc->row(cell);
        for (std::size_t k = 0; k < row_.size(); ++k) acc[k] = wanted.combine(acc[k], row_[k], change_[k]);
      }
    }
  }

  /// Unknown for a general Q; 0 promises nothing.
  double forward_euler_step(const field&) const override { return 0.0; }
  /// Unknown as well.
  double relaxation_time(const field&) const override { return std::numeric_limits<double>::infinity(); }

 private:
  void load(const field& u, int cell) { row_.assign(u.row(cell), u.row(cell) + u.components()); }

  newton_problem<no_source, collision_callable> local_;
  std::vector<double> row_, change_;
};

}  // namespace

std::unique_ptr<collision> make_newton_collision(const general_model& equation) {
  return std::make_unique<newton_collision>(equation);
}

}  // namespace apsis
