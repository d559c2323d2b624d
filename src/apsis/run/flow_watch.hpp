#pragma once

#include <apsis/boundary/limited_flow.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace apsis {

/// Warns once for each side that does not reach its flow, such as an outlet at which too little gas arrives.
class flow_watch {
 public:
  /// `setup` must outlive the object, and its problem must have been made. Collective.
  explicit flow_watch(const run_setup& setup);

  /// Warns about the stages since the last call. Collective.
  void update(const step_record& at);

 private:
  const run_setup& setup_;
  std::vector<std::pair<std::size_t, const limited_flow*>> ends_;  ///< limited boundaries with side numbers
  std::vector<bool> warned_;  ///< for each side; empty without such boundaries
};

}  // namespace apsis
