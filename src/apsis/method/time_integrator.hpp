#pragma once

#include <apsis/method/amplification.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/rate_errors.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace apsis {

/// Requirements of an integrator on a problem and on its steps.
struct integrator_needs {
  bool explicit_collision = false;  ///< evaluates Q(u) at stages (problem_with_explicit_collision)
  bool exact_collision = false;     ///< solves u' = Q(u) exactly (problem_with_exact_collision)
  bool equal_steps = false;         ///< the coefficients are those of steps of equal length
};

/// Certificate of an integrator as facts for a program and lines for a reader, in the order of a report.
struct integrator_certificate {
  /// A number, a flag or a text; nothing where the reporting program computes it (cfl_limits, buffers).
  using value = std::variant<std::monostate, bool, int, double, std::string>;
  /// A fact; a key "a.b" belongs to a group a.
  struct fact {
    std::string key;  ///< as in `apsis check --json`
    value is;         ///< its value
  };
  /// A line "label  text" of `apsis check`.
  struct line {
    std::string label;                ///< the property
    std::optional<std::string> text;  ///< nothing for the limits of linear stability
  };
  std::vector<fact> facts;            ///< all facts
  std::vector<line> lines;            ///< the same in words
  std::vector<std::string> failures;  ///< one line per failed claim
  /// Whether `failures` is empty.
  bool claims_hold() const { return failures.empty(); }
};

/// A time integrator of any kind, with the properties known before a step. `apsis list`, `check` and `run`
/// use this type. make_stepper() (integrate/any_stepper.hpp) makes the stepper that takes its steps. Kinds
/// are the entries of integrator_kind_registry.hpp. Dimensionless.
class time_integrator {
 public:
  virtual ~time_integrator() = default;

  std::string name,            ///< "imex-bdf-3", or the name in a method file
      title,                   ///< one line
      kind;                    ///< name of its kind: integrator_kind_entry::name
  int order = 0,               ///< p, as claimed
      steps = 1;               ///< k: u^{n+1} depends on u^{n+1−k}, …, u^n
  std::size_t stages = 1;      ///< number of stages of a step
  double ssp_coefficient = 0;  ///< r, the smaller of its own and its starter's; 0 if one is not convex
  integrator_needs needs;      ///< requirements
  int kept_states = 0;         ///< states that it stores in addition to those of starter()
  std::vector<double> weights = {1.0};  ///< of u^n, u^{n−1}, … in u^{n+1} for T = Q = 0
  /// Weights of values and solves of a step, from which bounds of rounding follow. The first k − 1 rows stand
  /// for u^{n−k+1} … u^{n−1}.
  shu_osher_form<double> form;

  /// Returns the method of the first steps; the method itself if it takes one step.
  virtual const method& starter() const = 0;
  /// Returns the method of its file or family; nullptr for a formula.
  virtual const method* file() const { return nullptr; }
  /// Returns the method, if the integrator is a method of one step with a file or family; otherwise nullptr.
  const method* one_step() const { return file() != nullptr && file()->steps == 1 ? file() : nullptr; }
  /// Returns its amplification factors for linear problems.
  virtual amplification growth() const = 0;
  /// Returns the errors of its O(ε) terms at z = CΔt/ε > 0.
  virtual rate_errors errors_at(double z) const = 0;
  /// Returns its certificate; a claim that does not hold is a failure of the certificate.
  virtual integrator_certificate certify() const = 0;
};

/// Returns the certified integrator called `name`. It is a method of the catalogue (methods/*.toml) or of a
/// family, a formula such as "imex-bdf-3", or a method file given by its path, FILE.toml. A file is certified
/// again when its contents have changed; references returned earlier stay valid. Throws like find_method().
const time_integrator& find_integrator(const std::string& name);

/// Returns the names of the catalogue, then those of integrators that are not methods of one step; members of
/// families are not listed.
std::vector<std::string> integrator_names();

/// Returns those of integrator_names() that are of this kind.
std::vector<std::string> integrator_names(const std::string& kind);

/// Returns those of integrator_names() that are not methods of one step.
std::vector<std::string> names_of_several_steps();

}  // namespace apsis
