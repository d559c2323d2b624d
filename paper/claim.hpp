#pragma once

#include <apsis/output/picture.hpp>
#include <apsis/study/report_table.hpp>
#include <apsis/study/study_control.hpp>

#include <string>
#include <vector>

namespace apsis::paper {

/// One measured figure and its required value.
struct finding {
  std::string what;       ///< "slope between dt = 1/512 and 1/1024, eps = 1"
  double value = 0.0;     ///< measured value
  std::string condition;  ///< "at least 2.85", "3 ± 0.15", "at most 1e-13"
  bool holds = false;     ///< whether the value satisfies the condition
};

/// Returns the finding value ≤ bound. Here and in the following functions NaN never satisfies the condition.
finding at_most(std::string what, double value, double bound);
/// Returns the finding value ≥ bound.
finding at_least(std::string what, double value, double bound);
/// Returns the finding |value − target| ≤ tolerance.
finding close_to(std::string what, double value, double target, double tolerance);
/// Returns the finding value = wanted.
finding exactly(std::string what, long value, long wanted);
/// Returns the finding that a statement is true; its value is 1 or 0.
finding is_true(std::string what, bool value);

/// Result of checking a claim.
struct claim_result {
  std::vector<finding> findings;     ///< short tables show the first that does not hold, otherwise the first
  std::vector<report_table> tables;  ///< details, below the findings
  std::vector<picture> pictures;     ///< drawn by the report
  std::vector<std::string> remarks;  ///< corrections to the paper, deviations and their reasons

  bool all_hold() const;  ///< whether all findings hold, and there is at least one
};

/// A claim of the paper: a file of paper/claims/ defines `extern const claim_entry claim_<file>`.
struct claim_entry {
  std::string id;                               ///< "C7"
  std::string section;                          ///< section of the paper
  std::string statement;                        ///< statement of the paper, or about the paper
  std::string how;                              ///< how the claim is verified
  claim_result (*check)(const study_control&);  ///< computes findings, tables and pictures
  bool slow = false;                            ///< more than about 20 s on two cores
};

}  // namespace apsis::paper
