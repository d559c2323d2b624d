#pragma once

#include <string>
#include <vector>

namespace apsis {

/// A key of a case and the values that it takes in a study, each written as on the command line.
struct varied_key {
  std::string key;                  ///< "space.cells"
  std::vector<std::string> values;  ///< {"20", "40", "80"}
};

/// From "key=v1,v2,…": commas inside brackets, braces and quotes do not separate. "a..b" stands for a and
/// what is made of it by doubling or halving until b: space.cells=20..160, time.dt=1/16..1/4096. Throws
/// input_error: no key, no value, an empty or repeated value, a range that doubling does not close.
varied_key parse_vary(const std::string& text);

/// What errors are measured against.
struct convergence_reference {
  /// The ways to measure an error.
  enum class kind {
    automatic,   ///< exact where every run has an exact solution, next otherwise
    exact,       ///< the exact solution that the model knows
    next,        ///< the next finer run of the study; the finest is compared with one more run
    time,        ///< the same mesh and method, a step of 1/8 of the smallest of these runs
    space_time,  ///< one run with three times the cells of the finest and a third of its step
    given        ///< each run again with `overrides`
  };
  kind how = kind::automatic;               ///< the way that is taken
  std::vector<std::string> overrides = {};  ///< "key=value", of kind::given
};

/// "exact", "next", "time", "space+time", "METHOD@STEP" (the method and dt of the reference) or
/// "key=value,key=value,…". Throws input_error with what is valid.
convergence_reference parse_reference(const std::string& text);

}  // namespace apsis
