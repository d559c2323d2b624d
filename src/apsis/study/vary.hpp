#pragma once

#include <string>
#include <vector>

namespace apsis {

/// A key of a case and its values in a study, each written as on the command line.
struct varied_key {
  std::string key;                  ///< "space.cells"
  std::vector<std::string> values;  ///< {"20", "40", "80"}
};

/// Reads "key=v1,v2,…". Commas inside brackets, braces and quotes do not separate values. "a..b" doubles or
/// halves a until b: space.cells=20..160, time.dt=1/16..1/4096. Throws input_error if there is no key or no
/// value, a value is empty or repeated, or doubling misses the end of a range.
varied_key parse_vary(const std::string& text);

/// The reference of the errors.
struct convergence_reference {
  /// Kinds of references.
  enum class kind {
    automatic,   ///< exact if every run has an exact solution, otherwise next
    exact,       ///< the exact solution of the model
    next,        ///< the next finer run of the study; the finest run has an additional one
    time,        ///< the same mesh and method with 1/8 of the smallest step of these runs
    space_time,  ///< one run with three times the cells of the finest run and a third of its step
    given        ///< each run again with `overrides`
  };
  kind type = kind::automatic;              ///< the kind in use
  std::vector<std::string> overrides = {};  ///< "key=value", for kind::given
};

/// Reads "exact", "next", "time", "space+time", "METHOD@STEP" (method and dt of the reference) or
/// "key=value,key=value,…". Throws input_error with the valid references for any other text.
convergence_reference parse_reference(const std::string& text);

}  // namespace apsis
