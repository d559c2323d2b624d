#pragma once

namespace apsis {

/// A boundary condition with a flow that it may be unable to reach.
class limited_flow {
 public:
  virtual ~limited_flow() = default;
  /// Returns true if less than the required flow crossed a face in any stage since the
  /// last call. Thread-safe.
  virtual bool take_shortfall() const = 0;
};

}  // namespace apsis
