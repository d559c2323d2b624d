#pragma once

#include <apsis/body/rotation.hpp>
#include <apsis/body/shape.hpp>

#include <memory>
#include <utility>

namespace apsis {

/// A shape that is rotated about the origin, then shifted: φ(x) = φ₀(Rᵀ(x − s)).
class placed_shape final : public shape {
 public:
  /// Rotates `of` by R, and shifts the result by s.
  placed_shape(std::shared_ptr<const shape> of, const rotation& turn, const position& shift)
      : of_(std::move(of)), turn_(turn), shift_(shift) {}

  double outside(const position& x) const override {
    return of_->outside(turn_.apply_inverse({x[0] - shift_[0], x[1] - shift_[1], x[2] - shift_[2]}));
  }

 private:
  std::shared_ptr<const shape> of_;
  rotation turn_;
  position shift_;
};

}  // namespace apsis
