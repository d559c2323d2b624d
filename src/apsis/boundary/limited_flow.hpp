#pragma once

namespace apsis {

/// A boundary condition with a flow that it may be unable to reach.
class limited_flow {
 public:
  virtual ~limited_flow() = default;
  /// Returns whether less than its flow crossed a face since the last call, in any stage. Thread-safe.
  virtual bool take_shortfall() const = 0;
};

}  // namespace apsis
