#pragma once

#include <apsis/boundary/limited_flow.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/run/setup.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace apsis {

/// Warns once for each side whose flow is not reached, such as an outlet to which too little gas comes.
class flow_watch {
 public:
  /// `setup`, whose problem has been made, must outlive the object. Collective.
  explicit flow_watch(const run_setup& setup);

  /// Warns of the stages since the last call. Collective.
  void update(const step_record& at);

 private:
  const run_setup& setup_;
  std::vector<std::pair<std::size_t, const limited_flow*>> ends_;  ///< with the numbers of their sides
  std::vector<bool> warned_;                                       ///< of each side; empty without such ends
};

}  // namespace apsis
