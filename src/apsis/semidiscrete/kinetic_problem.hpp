#pragma once

#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/transport.hpp>

#include <memory>

namespace apsis {

/// A relaxation model on a mesh, as the integrator sees it (see integrate/problem.hpp).
class kinetic_problem {
 public:
  using state = field;
  using real = double;

  /// Both references must outlive the problem.
  kinetic_problem(const relaxation_model& equation, const grid& mesh, stencil how,
                  std::unique_ptr<collision> q)
      : transport_(equation, mesh, std::move(how)), collision_(std::move(q)) {}

  void scatter(double, const field& u, std::span<const target<field, double>> targets) {
    transport_.scatter(u, targets);
  }
  void collide(double, double a, double b, field& u) { collision_->solve(a, b, u); }
  void scatter_collision(double, const field& u, std::span<const target<field, double>> targets) {
    collision_->scatter(u, targets);
  }
  double forward_euler_step(double, const field&) const { return transport_.forward_euler_step(); }

 private:
  transport transport_;
  std::unique_ptr<collision> collision_;
};

}  // namespace apsis
