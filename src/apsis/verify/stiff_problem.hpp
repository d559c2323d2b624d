#pragma once

#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// G(t, u) of a stiff problem for the scalar types of automatic differentiation.
class stiff_rate {
 public:
  virtual ~stiff_rate() = default;
  /// out ← G(t, u).
  virtual void evaluate(double t, std::span<const double> u, std::span<double> out) const = 0;
  /// out ← G(t, u) with first derivatives.
  virtual void evaluate(const dual<double>& t, std::span<const dual<double>> u,
                        std::span<dual<double>> out) const = 0;
  /// out ← G(t, u) with second derivatives.
  virtual void evaluate(const nested_dual<double>& t, std::span<const nested_dual<double>> u,
                        std::span<nested_dual<double>> out) const = 0;
};

/// Makes a stiff_rate from formula(t, u, out), a template on the scalar type.
template <class Formula>
std::unique_ptr<stiff_rate> make_stiff_rate(Formula formula) {
  class rate final : public stiff_rate {
   public:
    explicit rate(Formula of) : formula_(std::move(of)) {}
    void evaluate(double t, std::span<const double> u, std::span<double> out) const override {
      formula_(t, u, out);
    }
    void evaluate(const dual<double>& t, std::span<const dual<double>> u,
                  std::span<dual<double>> out) const override {
      formula_(t, u, out);
    }
    void evaluate(const nested_dual<double>& t, std::span<const nested_dual<double>> u,
                  std::span<nested_dual<double>> out) const override {
      formula_(t, u, out);
    }

   private:
    Formula formula_;
  };
  return std::make_unique<rate>(std::move(formula));
}

/// A component of a reference solution.
struct reference_component {
  std::size_t unknown;  ///< index from 0
  double value;         ///< its value at the end
};

/// A stiff initial value problem u' = G(t, u) of the literature with a reference solution. A file
/// of verify/stiff/ defines `extern const stiff_problem_entry stiff_problem_<file>`. Units are
/// those of the source.
struct stiff_problem_entry {
  std::string name;           ///< for example "robertson"
  std::string description;    ///< one line
  std::string source;         ///< citation of the problem
  std::string origin;         ///< origin of the reference solution
  std::vector<double> times;  ///< start and end; between them times where G jumps
  std::vector<double> sizes;  ///< size of every unknown below which digits do not count, or one for all
  bool slow = false;          ///< whether an integration takes more than seconds
  std::vector<double> (*start)() = nullptr;  ///< initial values
  /// Makes G between times[piece] and times[piece + 1].
  std::unique_ptr<stiff_rate> (*rate)(std::size_t piece) = nullptr;
  std::vector<reference_component> reference;  ///< all unknowns, or those that the origin states
  sparsity_pattern (*pattern)() = nullptr;     ///< sparsity of G'; nullptr for problems of few unknowns
};

/// Returns every problem, sorted by file name (generated).
std::vector<const stiff_problem_entry*> stiff_problem_entries();

/// Returns the problem of this name. Throws input_error with the nearest name for an unknown one.
const stiff_problem_entry& find_stiff_problem(const std::string& name);

/// A solution of a stiff problem.
struct stiff_solution {
  std::vector<double> u;  ///< solution at the end
  double digits = 0;      ///< see correct_digits()
  long steps = 0;         ///< accepted steps
  long rejected = 0;      ///< steps rejected for their error or a stage without a solution
  long evaluations = 0;   ///< calls of G, those for derivatives included
  long products = 0;      ///< calls of G for derivatives, each along one direction
};

/// Returns the correct digits of u at the end, −log₁₀ max_i |u_i − r_i|/(|r_i| + size_i) over the reference
/// values r_i. Returns −infinity if a number is not finite. Source: Mazzia & Magherini, Test Set for IVP
/// Solvers 2.4 (2008), "mixed error significant correct digits".
double correct_digits(const stiff_problem_entry& problem, std::span<const double> u);

/// Returns atol_i = rtol · size_i, for all unknowns.
std::vector<double> absolute_tolerances(const stiff_problem_entry& problem, double rtol);

/// Solves a problem to its end with an implicit method of one step. rtol is the same for all unknowns, and
/// atol_i = rtol · size_i (component_tolerances). Stages are solved by Newton's method with exact
/// derivatives, by sparse factorizations if the problem has a pattern. Throws input_error as stepper does.
/// Throws numerical_error if no step is short enough, after `most_steps` steps, or after `most_seconds` of
/// CPU time of the process.
stiff_solution solve_stiff_problem(const stiff_problem_entry& problem, const std::string& method, double rtol,
                                   long most_steps = 1000000,
                                   double most_seconds = std::numeric_limits<double>::infinity());

/// Solves a problem like solve_stiff_problem(), with smaller and smaller tolerances until the estimated error
/// at the end is within rtol (refine_until_accurate). The counts are those of all runs. Throws
/// numerical_error also if no tolerance suffices.
stiff_solution solve_stiff_problem_to_end(const stiff_problem_entry& problem, const std::string& method,
                                          double rtol,
                                          double most_seconds = std::numeric_limits<double>::infinity());

}  // namespace apsis
