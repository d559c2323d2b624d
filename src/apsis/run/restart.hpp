#pragma once

#include <apsis/config/case.hpp>
#include <apsis/exec/communicator.hpp>
#include <apsis/output/checkpoint.hpp>
#include <apsis/run/simulation.hpp>

#include <optional>
#include <string>
#include <utility>

namespace apsis {

/// Throws input_error if the path is missing, a folder, or a file of another kind than HDF5. It does not look
/// for damage.
void check_is_checkpoint(const std::string& path);

/// Returns the first line of each text that differs from the same line of the other. Both lines are
/// empty for equal texts.
std::pair<std::string, std::string> first_difference(const std::string& a, const std::string& b);

/// Returns the case with the method of the checkpoint at `path`, if there is one and the program chose the
/// method. A continued run keeps its method, even if a newer table of choices differs. Collective.
case_config with_method_of(const std::optional<std::string>& path, case_config config,
                           communicator& processes);

/// Reads a checkpoint. The root verifies it before the others read their parts. Collective.
checkpoint read_by_all(const std::string& path, communicator& processes,
                       const std::optional<dataset_part>& part);

/// Returns a source that starts a run from the state of a checkpoint. It throws input_error if the size of
/// the state is not that of the case.
state_source state_of_checkpoint(const std::string& path);

/// Warns if another version wrote the checkpoint. Throws input_error if it belongs to another case.
void check_checkpoint(const checkpoint& saved, const std::string& path, const simulation& run);

}  // namespace apsis
