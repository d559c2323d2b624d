#pragma once

#include <apsis/method/time_integrator.hpp>

namespace apsis {

/// A method of one step as an integrator. Kinds whose stages solve the collision in another way derive from
/// it.
class one_step_integrator : public time_integrator {
 public:
  /// Copies the method.
  explicit one_step_integrator(method m);
  const method& starter() const override { return method_; }
  const method* file() const override { return &method_; }
  amplification growth() const override { return amplification(method_); }
  rate_errors errors_at(double z) const override { return rate_errors_at(method_, z); }
  /// Returns the facts of certificate.hpp that every integrator has.
  integrator_certificate certify() const override;

 private:
  method method_;
};

}  // namespace apsis
